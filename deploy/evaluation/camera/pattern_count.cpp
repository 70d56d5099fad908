// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/camera/pattern_count.hpp"

#include <algorithm>
#include <set>

#include "common/marking/symmetry.hpp"

namespace sidestep {
namespace {

/// The Moebius function: 0 with a square factor, else 1 or -1 as the number of prime factors is even or odd.
int mu(std::size_t n) {
  int sign = 1;
  for (std::size_t p = 2; p <= n; ++p) {
    if (n % p != 0) continue;
    n /= p;
    if (n % p == 0) return 0;
    sign = -sign;
  }
  return sign;
}

std::int64_t power(std::uint64_t base, std::size_t exponent) {
  std::int64_t result = 1;
  for (std::size_t i = 0; i < exponent; ++i) result *= static_cast<std::int64_t>(base);
  return result;
}

}  // namespace

std::uint64_t countable_patterns(const MarkingLayout& layout, std::uint64_t colours) {
  const std::size_t turns = turns_of(layout).size(), dots = layout.dots.size();
  if (turns == 0) return 0;
  std::int64_t sum = 0;
  for (std::size_t d = 1; d <= turns; ++d)
    if (turns % d == 0) sum += mu(d) * power(colours, dots / d);
  return static_cast<std::uint64_t>(sum) / turns;
}

std::uint64_t used_colours(const MarkingLayout& layout) {
  std::set<Colour> used;
  for (const MarkingPattern& pattern : layout.patterns)
    used.insert(pattern.colours.begin(), pattern.colours.end());
  return used.size();
}

std::size_t smallest_difference(const MarkingLayout& layout) {
  std::size_t smallest = layout.dots.size();
  const std::vector<DotTurn> turns = turns_of(layout);
  for (std::size_t i = 0; i < layout.patterns.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      for (std::size_t t = i == j ? 1 : 0; t < turns.size(); ++t)
        smallest =
            std::min(smallest, differences(layout.patterns[i].colours, layout.patterns[j].colours, turns[t]));
    }
  }
  return smallest;
}

}  // namespace sidestep
