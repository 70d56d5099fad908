// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/camera/pattern_count.hpp"

#include <algorithm>
#include <set>

#include "common/marking/symmetry.hpp"

namespace sidestep {
namespace {

/// The Möbius function: 0 for a number with a square factor, otherwise 1 or -1 for an even or odd number of
/// prime factors.
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

std::uint64_t countable_patterns(const MarkerLayout& layout, std::uint64_t colours) {
  const std::size_t symmetries = rotational_symmetries(layout).size(), dots = layout.dots.size();
  if (symmetries == 0) return 0;
  std::int64_t sum = 0;
  for (std::size_t d = 1; d <= symmetries; ++d)
    if (symmetries % d == 0) sum += mu(d) * power(colours, dots / d);
  return static_cast<std::uint64_t>(sum) / symmetries;
}

std::uint64_t used_colour_count(const MarkerLayout& layout) {
  std::set<Colour> used;
  for (const MarkerPattern& pattern : layout.patterns)
    used.insert(pattern.colours.begin(), pattern.colours.end());
  return used.size();
}

std::size_t min_pattern_distance(const MarkerLayout& layout) {
  std::size_t min_distance = layout.dots.size();
  const std::vector<RotationalSymmetry> symmetries = rotational_symmetries(layout);
  for (std::size_t i = 0; i < layout.patterns.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      for (std::size_t t = i == j ? 1 : 0; t < symmetries.size(); ++t)
        min_distance = std::min(min_distance, hamming_distance(layout.patterns[i].colours,
                                                               layout.patterns[j].colours, symmetries[t]));
    }
  }
  return min_distance;
}

}  // namespace sidestep
