// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/camera/pattern_count.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "common/marking/butterfly.hpp"
#include "common/marking/symmetry.hpp"
#include "tests/unit/common/marking/random_layout.hpp"

using namespace sidestep;

namespace {

/// What a pattern looks like after a turn: the colours by place, as pictures are compared.
using Picture = std::map<std::pair<long, long>, std::uint64_t>;

Picture picture(const MarkingLayout& layout, const std::vector<std::uint64_t>& colours, double angle_rad) {
  Picture result;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const Vec2 p = rotated(layout.dots[i].position_m - layout.centre.position_m, angle_rad) * 1e3;
    result[{std::lround(p.x()), std::lround(p.y())}] = colours[i];
  }
  return result;
}

bool is_near(const Picture& a, const Picture& b) {
  for (const auto& [place, colour] : a) {
    bool is_there = false;
    for (long dx = -1; dx <= 1; ++dx)
      for (long dy = -1; dy <= 1; ++dy) {
        const auto found = b.find({place.first + dx, place.second + dy});
        is_there = is_there || (found != b.end() && found->second == colour);
      }
    if (!is_there) return false;
  }
  return true;
}

/// Tries every colouring against all accepted ones under every turn by which a dot could fall on another.
std::uint64_t slow_count(const MarkingLayout& layout, std::uint64_t colours) {
  const std::size_t dots = layout.dots.size();
  std::set<double> angles;
  const auto angle = [&](std::size_t i) {
    const Vec2 p = layout.dots[i].position_m - layout.centre.position_m;
    return std::atan2(p.y(), p.x());
  };
  for (std::size_t i = 0; i < dots; ++i)
    for (std::size_t j = 0; j < dots; ++j)
      if (i != j) angles.insert(angle(j) - angle(i));
  std::vector<Picture> accepted;
  std::uint64_t all = 1;
  for (std::size_t i = 0; i < dots; ++i) all *= colours;
  for (std::uint64_t number = 0; number < all; ++number) {
    std::vector<std::uint64_t> pattern;
    for (std::uint64_t rest = number, i = 0; i < dots; ++i, rest /= colours)
      pattern.push_back(rest % colours);
    const Picture plain = picture(layout, pattern, 0);
    bool is_unique = true;
    for (const double a : angles) {
      const Picture turned = picture(layout, pattern, a);
      // A full turn more or less, or next to nothing, is no turn.
      const bool is_turn = std::abs(std::remainder(a, 6.283185307179586)) > 1e-3;
      if (is_turn && is_near(turned, plain)) is_unique = false;
      for (const Picture& other : accepted)
        if (is_near(turned, other)) is_unique = false;
    }
    if (is_unique) accepted.push_back(plain);
  }
  return accepted.size();
}

}  // namespace

TEST_CASE("patterns are counted as trying all of them counts them") {
  const std::uint64_t seed = 21;
  CAPTURE(seed);
  Rng rng(seed);
  const std::vector<std::pair<std::size_t, std::size_t>> shapes{{1, 1}, {1, 2}, {1, 3}, {2, 1}, {2, 2},
                                                                {3, 1}, {3, 2}, {4, 1}, {5, 1}, {6, 1}};
  for (const auto& [turns, rings] : shapes) {
    for (std::uint64_t colours = 1; colours <= 3; ++colours) {
      CAPTURE(turns, rings, colours);
      MarkingLayout layout = random_rings(turns, rings, rng);
      if (turns > 1) REQUIRE(turns_of(layout).size() == turns);
      CHECK(countable_patterns(layout, colours) == slow_count(layout, colours));
    }
  }
}

TEST_CASE("known counts come out") {
  Rng rng(22);
  CHECK(countable_patterns(butterfly(), 2) == 16);
  CHECK(countable_patterns(butterfly(), 3) == 81);
  // Aperiodic necklaces of two colours: 1, 2, 3, 6, 9, 18, 30 for 2 to 8 beads.
  const std::vector<std::uint64_t> necklaces{1, 2, 3, 6, 9, 18, 30};
  for (std::size_t beads = 2; beads <= 8; ++beads)
    CHECK(countable_patterns(random_rings(beads, 1, rng), 2) == necklaces[beads - 2]);
}

TEST_CASE("a dot of another size or out of place ends a symmetry") {
  Rng rng(23);
  MarkingLayout layout = random_rings(4, 1, rng);
  CHECK(turns_of(layout).size() == 4);
  layout.dots[2].radius_m = 0.013;
  CHECK(turns_of(layout).size() == 1);
  layout.dots[0].radius_m = 0.013;
  CHECK(turns_of(layout).size() == 2);
  CHECK(turns_of(layout)[1].angle_rad == Approx(3.14159265));
  layout.dots[1].position_m += Vec2(0.005, 0);
  CHECK(turns_of(layout).size() == 1);
}

TEST_CASE("the butterfly uses all it has") {
  CHECK(turns_of(butterfly()).size() == 1);
  CHECK(used_colours(butterfly()) == 2);
  CHECK(butterfly().patterns.size() == 16);
  CHECK(smallest_difference(butterfly()) == 1);
}
