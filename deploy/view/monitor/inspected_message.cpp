// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/inspected_message.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "common/json/json_text.hpp"
#include "deploy/view/monitor/exact_numbers.hpp"
#include "deploy/view/monitor/unix_time.hpp"

namespace sidestep {

std::string inspected_message(Time at, nlohmann::ordered_json message) {
  make_numbers_exact(message);
  const nlohmann::ordered_json entry{{"at_s", unix_seconds(at)}, {"message", std::move(message)}};
  return json_text(entry);
}

}  // namespace sidestep
