// SPDX-License-Identifier: Apache-2.0
// Swept discs among obstacles: our structures and peers side by side. Answers have to agree.
#include <algorithm>
#include <fmt/core.h>
#include <functional>
#include <string>

#include "common/collision/obstacle_world.hpp"
#include "deploy/evaluation/study/planning/collision_problem.hpp"
#include "deploy/evaluation/study/planning/fcl_tree.hpp"
#include "tests/bench/collision_peers.hpp"

using namespace sidestep;

namespace {

constexpr std::size_t kQueries = 100'000, kRounds = 5;
constexpr std::uint64_t kSeed = 1;

/// One side of the comparison.
struct Side {
  std::string name;
  bool is_ours;
  double tolerance_m;
  std::vector<bool> answers;
  std::function<double()> count_ns, branch_ns;
  std::vector<double> counted_ns, branched_ns;
};

template <typename World>
Side side(std::string name, bool is_ours, const CollisionProblem& problem, World& world,
          double tolerance_m = 1e-9) {
  const auto ask = [&world, radius_m = problem.radius_m](const Segment& way) {
    return world.touches(way.from_m, way.to_m, radius_m);
  };
  Side made{std::move(name), is_ours, tolerance_m, {}, {}, {}, {}, {}};
  for (const Segment& way : problem.ways) made.answers.push_back(ask(way));
  made.count_ns = [&problem, ask] { return query_ns<AnswerUse::kCounted>(problem, ask); };
  made.branch_ns = [&problem, ask] { return query_ns<AnswerUse::kBranched>(problem, ask); };
  return made;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Wrong answers where sides do not agree, but for ways that are within the side's tolerance of touching.
std::size_t count_wrong(const CollisionProblem& problem, const std::vector<Side>& sides) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < kQueries; ++i) {
    const auto answers_otherwise = [&](const Side& other) { return other.answers[i] != sides[0].answers[i]; };
    if (std::none_of(sides.begin(), sides.end(), answers_otherwise)) continue;
    double nearest2_m2 = 1;
    for (const Shape& shape : problem.shapes)
      nearest2_m2 = std::min(nearest2_m2, squared_distance(problem.ways[i], shape));
    const double gap_m = std::sqrt(nearest2_m2) - problem.radius_m;
    for (const Side& s : sides) {
      if (std::abs(gap_m) <= s.tolerance_m || s.answers[i] == (gap_m < 0)) continue;
      fmt::print("{} is wrong about a way {:.3g} m from touching\n", s.name, gap_m);
      ++wrong;
    }
  }
  return wrong;
}

void print(std::size_t count, const std::vector<Side>& sides) {
  double best_counted = 1e9, best_branched = 1e9;
  for (const Side& s : sides) {
    if (s.is_ours) continue;
    best_counted = std::min(best_counted, median(s.counted_ns));
    best_branched = std::min(best_branched, median(s.branched_ns));
  }
  const auto hits = static_cast<double>(std::count(sides[0].answers.begin(), sides[0].answers.end(), true));
  for (const Side& s : sides) {
    const double counted_ns = median(s.counted_ns), branched_ns = median(s.branched_ns);
    fmt::print("{:>6}  {:4.1f}  {:<24}{:10.1f}{:8.2f}{:10.1f}{:8.2f}\n", count, 100 * hits / kQueries, s.name,
               counted_ns, best_counted / counted_ns, branched_ns, best_branched / branched_ns);
  }
}

bool compare(std::size_t count, bool circles_only) {
  const CollisionProblem problem(count, kQueries, circles_only, kSeed);
  const ObstacleWorld chosen(problem.shapes), linear(problem.shapes, Structure::kLinear);
  const ObstacleWorld masks(problem.shapes, Structure::kMasks), tree(problem.shapes, Structure::kTree);
  std::vector<Side> sides;
  sides.push_back(side("chosen by size", true, problem, chosen));
  if (count <= 4096) sides.push_back(side("linear", true, problem, linear));
  sides.push_back(side("extent masks", true, problem, masks));
  sides.push_back(side("tree of boxes", true, problem, tree));
  const peers::PlainArray plain(circles_only ? problem.shapes : std::vector<Shape>());
  const peers::BoostRTree boost(problem.shapes);
  FclTree fcl(problem.shapes);
  if (circles_only && count <= 4096) sides.push_back(side("plain vectorised array", false, problem, plain));
  sides.push_back(side("Boost R-tree", false, problem, boost));
  // FCL iterates up to 1e-6 for shapes other than circles, and takes its time.
  if (circles_only || count <= 256)
    sides.push_back(side("FCL dynamic AABB tree", false, problem, fcl, circles_only ? 1e-9 : 1e-6));
  for (std::size_t round = 0; round < kRounds; ++round) {
    for (Side& s : sides) {
      s.counted_ns.push_back(s.count_ns());
      s.branched_ns.push_back(s.branch_ns());
    }
  }
  print(count, sides);
  return count_wrong(problem, sides) == 0;
}

}  // namespace

int main() {
  fmt::print(
      "Swept discs against obstacles that cover {:.0f} % of the unit square: ns of processor time per "
      "query,\n",
      100 * CollisionProblem::kCovered);
  fmt::print(
      "medians of {} rounds of {} random queries; gain: how often that goes into the best peer's time.\n",
      kRounds, kQueries);
  bool agree = true;
  for (const bool circles_only : {true, false}) {
    fmt::print("\n{}\n", circles_only ? "Circles" : "Circles, boxes, segments and pentagons");
    fmt::print("                                     answers counted   branching on each\n");
    fmt::print("number  hit%  structure                       ns    gain        ns    gain\n");
    for (const std::size_t count : {16, 64, 256, 1024, 4096, 16384})
      agree = compare(count, circles_only) && agree;
  }
  return agree ? 0 : 1;
}
