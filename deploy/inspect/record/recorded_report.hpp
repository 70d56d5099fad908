// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace sidestep {

/// The report that is attached to a recording; nullopt if there is none. Throws std::invalid_argument if the
/// file cannot be read or is no recording.
[[nodiscard]] std::optional<std::string> recorded_report(const std::string& path);

}  // namespace sidestep
