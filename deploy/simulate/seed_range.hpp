// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "common/process/command_line.hpp"

namespace sidestep {

struct SeedRange {
  std::uint64_t first = 1, last = 1;
};

/// Reads "FIRST..LAST". Throws UsageError.
[[nodiscard]] inline SeedRange parse_seed_range(const std::string& text) {
  std::size_t first = 0, last = 0;
  int end = 0;
  const bool is_range = std::sscanf(text.c_str(), "%zu..%zu%n", &first, &last, &end) == 2;
  if (!is_range || static_cast<std::size_t>(end) != text.size() || last < first)
    throw UsageError("expected FIRST..LAST, got \"" + text + "\"");
  return {first, last};
}

}  // namespace sidestep
