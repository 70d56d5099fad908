// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace sidestep {

struct Url {
  std::string path;
  std::map<std::string, std::string> query;
};

/// Decodes the target of a request, for example "/api/events?since=3". nullopt if it is invalid.
[[nodiscard]] std::optional<Url> parse_target(std::string_view target);

}  // namespace sidestep
