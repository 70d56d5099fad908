// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <system_error>

#include "common/process/command_line.hpp"

namespace sidestep {

struct SeedRange {
  std::uint64_t first = 1, last = 1;
};

/// Parses "FIRST..LAST", with at most a million seeds. Throws UsageError.
[[nodiscard]] inline SeedRange parse_seed_range(const std::string& text) {
  constexpr std::uint64_t kMaxSeeds = 1'000'000;
  SeedRange seeds;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, seeds.first);
  const bool has_dots = end - first.ptr > 2 && first.ptr[0] == '.' && first.ptr[1] == '.';
  const auto last = std::from_chars(has_dots ? first.ptr + 2 : end, end, seeds.last);
  if (first.ec != std::errc() || last.ec != std::errc() || last.ptr != end || seeds.last < seeds.first)
    throw UsageError("expected FIRST..LAST, got \"" + text + "\"");
  if (seeds.last - seeds.first >= kMaxSeeds)
    throw UsageError(fmt::format("expected at most {} seeds at once, got \"{}\"", kMaxSeeds, text));
  return seeds;
}

}  // namespace sidestep
