// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/time/time.hpp"

namespace sidestep {

/// A received message for the page's inspector: {"at_s":…, "message":…}, see make_numbers_exact().
[[nodiscard]] std::string inspected_message(Time at, nlohmann::ordered_json message);

}  // namespace sidestep
