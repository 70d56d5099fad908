// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/camera/pattern_count.hpp"

#include <map>
#include <numbers>
#include <set>

#include "common/marking/butterfly.hpp"
#include "common/marking/layout_file.hpp"
#include "common/marking/symmetry.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/marking/random_layout.hpp"

namespace sidestep::pattern_count_test {

/// A rotated pattern: colours by position in millimetres.
using ColourMap = std::map<std::pair<long, long>, std::uint64_t>;

ColourMap colour_map(const MarkerLayout& layout, const std::vector<std::uint64_t>& colours,
                     double angle_rad) {
  ColourMap result;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const Vec2 p = rotated(layout.dots[i].position_m - layout.centre.position_m, angle_rad) * 1e3;
    result[{std::lround(p.x()), std::lround(p.y())}] = colours[i];
  }
  return result;
}

bool are_similar(const ColourMap& a, const ColourMap& b) {
  for (const auto& [position, colour] : a) {
    bool has_match = false;
    for (long dx = -1; dx <= 1; ++dx)
      for (long dy = -1; dy <= 1; ++dy) {
        const auto found = b.find({position.first + dx, position.second + dy});
        has_match = has_match || (found != b.end() && found->second == colour);
      }
    if (!has_match) return false;
  }
  return true;
}

/// Counts colourings that differ from all counted ones under every rotation that could map a dot to another.
std::uint64_t brute_force_pattern_count(const MarkerLayout& layout, std::uint64_t colours) {
  const std::size_t dots = layout.dots.size();
  std::set<double> angles;
  const auto angle = [&](std::size_t i) {
    const Vec2 p = layout.dots[i].position_m - layout.centre.position_m;
    return std::atan2(p.y(), p.x());
  };
  for (std::size_t i = 0; i < dots; ++i)
    for (std::size_t j = 0; j < dots; ++j)
      if (i != j) angles.insert(angle(j) - angle(i));
  std::vector<ColourMap> accepted;
  std::uint64_t all = 1;
  for (std::size_t i = 0; i < dots; ++i) all *= colours;
  for (std::uint64_t number = 0; number < all; ++number) {
    std::vector<std::uint64_t> pattern;
    for (std::uint64_t rest = number, i = 0; i < dots; ++i, rest /= colours)
      pattern.push_back(rest % colours);
    const ColourMap unrotated = colour_map(layout, pattern, 0);
    bool is_unique = true;
    for (const double a : angles) {
      const ColourMap rotated_map = colour_map(layout, pattern, a);
      // A rotation by nearly a multiple of a full turn is the identity.
      const bool is_rotation = std::abs(std::remainder(a, 2 * std::numbers::pi)) > 1e-3;
      if (is_rotation && are_similar(rotated_map, unrotated)) is_unique = false;
      for (const ColourMap& other : accepted)
        if (are_similar(rotated_map, other)) is_unique = false;
    }
    if (is_unique) accepted.push_back(unrotated);
  }
  return accepted.size();
}

TEST_CASE("the number of patterns agrees with an exhaustive search") {
  const std::uint64_t seed = 21;
  CAPTURE(seed);
  Rng rng(seed);
  const std::vector<std::pair<std::size_t, std::size_t>> shapes{{1, 1}, {1, 2}, {1, 3}, {2, 1}, {2, 2},
                                                                {3, 1}, {3, 2}, {4, 1}, {5, 1}, {6, 1}};
  for (const auto& [symmetries, rings] : shapes) {
    for (std::uint64_t colours = 1; colours <= 3; ++colours) {
      CAPTURE(symmetries, rings, colours);
      MarkerLayout layout = random_rings(symmetries, rings, rng);
      if (symmetries > 1) REQUIRE(rotational_symmetries(layout).size() == symmetries);
      CHECK(countable_patterns(layout, colours) == brute_force_pattern_count(layout, colours));
    }
  }
}

TEST_CASE("known numbers of patterns are reproduced") {
  Rng rng(22);
  CHECK(countable_patterns(butterfly(), 2) == 16);
  CHECK(countable_patterns(butterfly(), 3) == 81);
  // Aperiodic necklaces in two colours: 1, 2, 3, 6, 9, 18, 30 for 2 to 8 beads.
  const std::vector<std::uint64_t> necklaces{1, 2, 3, 6, 9, 18, 30};
  for (std::size_t beads = 2; beads <= 8; ++beads)
    CHECK(countable_patterns(random_rings(beads, 1, rng), 2) == necklaces[beads - 2]);
}

TEST_CASE("a dot of a different size or position breaks a symmetry") {
  Rng rng(23);
  MarkerLayout layout = random_rings(4, 1, rng);
  CHECK(rotational_symmetries(layout).size() == 4);
  layout.dots[2].radius_m = 0.013;
  CHECK(rotational_symmetries(layout).size() == 1);
  layout.dots[0].radius_m = 0.013;
  CHECK(rotational_symmetries(layout).size() == 2);
  CHECK(rotational_symmetries(layout)[1].angle_rad == Approx(std::numbers::pi));
  layout.dots[1].position_m += Vec2(0.005, 0);
  CHECK(rotational_symmetries(layout).size() == 1);
}

TEST_CASE("the butterfly uses all patterns of its two colours") {
  CHECK(rotational_symmetries(butterfly()).size() == 1);
  CHECK(used_colour_count(butterfly()) == 2);
  CHECK(butterfly().patterns.size() == 16);
  CHECK(min_pattern_distance(butterfly()) == 1);
}

TEST_CASE("the patterns of the square differ in at least two dots") {
  const MarkerLayout layout = load_layout(SIDESTEP_SOURCE_DIR "/deploy/scenarios/markings/square.yaml");
  CHECK(min_pattern_distance(layout) == 2);
  CHECK(countable_patterns(layout, used_colour_count(layout)) == 60);
}

}  // namespace sidestep::pattern_count_test
