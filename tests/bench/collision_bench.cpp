// SPDX-License-Identifier: Apache-2.0
// Compares our structures with their peers for swept discs among obstacles. Answers have to agree.
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

/// A structure under comparison.
struct MeasuredStructure {
  std::string name;
  bool is_ours;
  double tolerance_m;
  std::vector<bool> answers;
  std::function<double()> count_ns, branch_ns;
  std::vector<double> counted_ns, branched_ns;
};

template <typename World>
MeasuredStructure measured_structure(std::string name, bool is_ours, const CollisionProblem& problem,
                                     World& world, double tolerance_m = 1e-9) {
  const auto ask = [&world, radius_m = problem.radius_m](const Segment& path) {
    return world.touches(path.from_m, path.to_m, radius_m);
  };
  MeasuredStructure result{std::move(name), is_ours, tolerance_m, {}, {}, {}, {}, {}};
  for (const Segment& path : problem.motions) result.answers.push_back(ask(path));
  result.count_ns = [&problem, ask] { return query_ns<AnswerUse::kCounted>(problem, ask); };
  result.branch_ns = [&problem, ask] { return query_ns<AnswerUse::kBranched>(problem, ask); };
  return result;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Counts wrong answers where structures disagree, except for paths within a structure's tolerance of
/// contact.
std::size_t count_wrong(const CollisionProblem& problem, const std::vector<MeasuredStructure>& structures) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < kQueries; ++i) {
    const auto disagrees = [&](const MeasuredStructure& other) {
      return other.answers[i] != structures[0].answers[i];
    };
    if (std::none_of(structures.begin(), structures.end(), disagrees)) continue;
    double nearest2_m2 = 1;
    for (const Shape& shape : problem.shapes)
      nearest2_m2 = std::min(nearest2_m2, squared_distance(problem.motions[i], shape));
    const double gap_m = std::sqrt(nearest2_m2) - problem.radius_m;
    for (const MeasuredStructure& structure : structures) {
      if (std::abs(gap_m) <= structure.tolerance_m || structure.answers[i] == (gap_m < 0)) continue;
      fmt::print("{}: wrong answer for a path {:.3g} m from contact\n", structure.name, gap_m);
      ++wrong;
    }
  }
  return wrong;
}

void print(std::size_t count, const std::vector<MeasuredStructure>& structures) {
  double best_counted = 1e9, best_branched = 1e9;
  for (const MeasuredStructure& structure : structures) {
    if (structure.is_ours) continue;
    best_counted = std::min(best_counted, median(structure.counted_ns));
    best_branched = std::min(best_branched, median(structure.branched_ns));
  }
  const auto hits =
      static_cast<double>(std::count(structures[0].answers.begin(), structures[0].answers.end(), true));
  for (const MeasuredStructure& structure : structures) {
    const double counted_ns = median(structure.counted_ns), branched_ns = median(structure.branched_ns);
    fmt::print("{:>6}  {:4.1f}  {:<24}{:10.1f}{:8.2f}{:10.1f}{:8.2f}\n", count, 100 * hits / kQueries,
               structure.name, counted_ns, best_counted / counted_ns, branched_ns,
               best_branched / branched_ns);
  }
}

bool compare(std::size_t count, bool circles_only) {
  const CollisionProblem problem(count, kQueries, circles_only, kSeed);
  const ObstacleWorld chosen(problem.shapes), linear(problem.shapes, Structure::kLinear);
  const ObstacleWorld masks(problem.shapes, Structure::kMasks), tree(problem.shapes, Structure::kTree);
  std::vector<MeasuredStructure> structures;
  structures.push_back(measured_structure("chosen by size", true, problem, chosen));
  if (count <= 4096) structures.push_back(measured_structure("linear", true, problem, linear));
  structures.push_back(measured_structure("extent masks", true, problem, masks));
  structures.push_back(measured_structure("tree of boxes", true, problem, tree));
  const peers::PlainArray plain(circles_only ? problem.shapes : std::vector<Shape>());
  const peers::BoostRTree boost(problem.shapes);
  FclTree fcl(problem.shapes);
  if (circles_only && count <= 4096)
    structures.push_back(measured_structure("plain vectorised array", false, problem, plain));
  structures.push_back(measured_structure("Boost R-tree", false, problem, boost));
  // For shapes other than circles FCL iterates to 1e-6 m and is slow.
  if (circles_only || count <= 256)
    structures.push_back(
        measured_structure("FCL dynamic AABB tree", false, problem, fcl, circles_only ? 1e-9 : 1e-6));
  for (std::size_t round = 0; round < kRounds; ++round) {
    for (MeasuredStructure& structure : structures) {
      structure.counted_ns.push_back(structure.count_ns());
      structure.branched_ns.push_back(structure.branch_ns());
    }
  }
  print(count, structures);
  return count_wrong(problem, structures) == 0;
}

}  // namespace

int main() {
  fmt::print(
      "Swept discs against obstacles that cover {:.0f} % of the unit square: ns of processor time per "
      "query,\n",
      100 * CollisionProblem::kCovered);
  fmt::print(
      "medians of {} rounds of {} random queries; gain: time of the best peer over that of the structure.\n",
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
