// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/exact_numbers.hpp"

#include <nlohmann/json.hpp>
#include <string>

namespace sidestep {

void make_numbers_exact(nlohmann::ordered_json& json) {
  if (json.is_structured()) {
    for (nlohmann::ordered_json& element : json) make_numbers_exact(element);
  } else if (json.is_number_unsigned()) {
    const auto number = json.get<std::uint64_t>();
    if (number > static_cast<std::uint64_t>(kMaxExactNumber)) json = std::to_string(number);
  } else if (json.is_number_integer()) {
    const auto number = json.get<std::int64_t>();
    if (number < -kMaxExactNumber || number > kMaxExactNumber) json = std::to_string(number);
  }
}

}  // namespace sidestep
