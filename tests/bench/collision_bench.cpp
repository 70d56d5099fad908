// SPDX-License-Identifier: Apache-2.0
// Compares our structures for swept discs among obstacles with textbook
// structures and other libraries. Fails if answers differ.
#include <algorithm>
#include <fmt/core.h>
#include <functional>
#include <numeric>
#include <string>

#include "common/collision/baselines/baseline_world.hpp"
#include "common/collision/baselines/partition_tree.hpp"
#include "common/collision/baselines/spatial_hash.hpp"
#include "common/collision/baselines/sweep_and_prune.hpp"
#include "common/random/rng.hpp"
#include "tests/bench/collision_peers.hpp"
#include "tests/study/planning/collision_answers.hpp"
#include "tests/study/planning/collision_problem.hpp"
#include "tests/study/planning/fcl_tree.hpp"

using namespace sidestep;

namespace {

constexpr std::size_t kQueries = 100'000, kRounds = 5;
constexpr std::uint64_t kSeed = 1;

struct MeasuredStructure {
  CollisionAnswers answers;
  bool is_ours;
  std::function<double()> count_ns, branch_ns;
  std::vector<double> counted_ns, branched_ns;
};

template <typename World>
MeasuredStructure measured_structure(std::string name, bool is_ours, const CollisionProblem& problem,
                                     World& world, double tolerance_m = 1e-9) {
  const auto ask = [&world, radius_m = problem.radius_m](const Segment& path) {
    return world.touches(path.from_m, path.to_m, radius_m);
  };
  MeasuredStructure result{{std::move(name), tolerance_m, {}}, is_ours, {}, {}, {}, {}};
  for (const Segment& path : problem.motions) result.answers.touches.push_back(ask(path));
  result.count_ns = [&problem, ask] { return query_ns<AnswerUse::kCounted>(problem, ask); };
  result.branch_ns = [&problem, ask] { return query_ns<AnswerUse::kBranched>(problem, ask); };
  return result;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void print(std::size_t count, const std::vector<MeasuredStructure>& structures) {
  double best_counted = 1e9, best_branched = 1e9;
  for (const MeasuredStructure& structure : structures) {
    if (structure.is_ours) continue;
    best_counted = std::min(best_counted, median(structure.counted_ns));
    best_branched = std::min(best_branched, median(structure.branched_ns));
  }
  const std::vector<bool>& touches = structures[0].answers.touches;
  const auto hits = static_cast<double>(std::count(touches.begin(), touches.end(), true));
  for (const MeasuredStructure& structure : structures) {
    const double counted_ns = median(structure.counted_ns), branched_ns = median(structure.branched_ns);
    fmt::print("{:>6}  {:4.1f}  {:<24}{:10.1f}{:8.2f}{:10.1f}{:8.2f}\n", count, 100 * hits / kQueries,
               structure.answers.structure, counted_ns, best_counted / counted_ns, branched_ns,
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
  const baselines::BaselineWorld<baselines::SpatialHash> hash(problem.shapes);
  const baselines::BaselineWorld<baselines::SweepAndPrune> sweep(problem.shapes);
  const baselines::BaselineWorld<baselines::KdTree> kd_tree(problem.shapes);
  const baselines::BaselineWorld<baselines::BspTree> bsp_tree(problem.shapes);
  structures.push_back(measured_structure("spatial hash", false, problem, hash));
  structures.push_back(measured_structure("sweep and prune", false, problem, sweep));
  structures.push_back(measured_structure("K-D tree", false, problem, kd_tree));
  structures.push_back(measured_structure("BSP tree", false, problem, bsp_tree));
  const peers::PlainArray plain(circles_only ? problem.shapes : std::vector<Shape>());
  const peers::BoostRTree boost(problem.shapes);
  FclTree fcl(problem.shapes);
  if (circles_only && count <= 4096)
    structures.push_back(measured_structure("plain vectorised array", false, problem, plain));
  structures.push_back(measured_structure("Boost R-tree", false, problem, boost));
  // For shapes other than circles FCL iterates to a precision of 1e-6 m, and is slow.
  if (circles_only || count <= 256)
    structures.push_back(
        measured_structure("FCL dynamic AABB tree", false, problem, fcl, circles_only ? 1e-9 : 1e-6));
  Rng order(kSeed);
  std::vector<std::size_t> sequence(structures.size());
  std::iota(sequence.begin(), sequence.end(), 0u);
  for (std::size_t round = 0; round < kRounds; ++round) {
    order.shuffle(sequence);
    for (const std::size_t i : sequence) {
      structures[i].counted_ns.push_back(structures[i].count_ns());
      structures[i].branched_ns.push_back(structures[i].branch_ns());
    }
  }
  print(count, structures);
  std::vector<CollisionAnswers> answers;
  for (const MeasuredStructure& structure : structures) answers.push_back(structure.answers);
  const std::vector<std::string> wrong = wrong_answers(problem, answers);
  for (const std::string& line : wrong) fmt::print("{}\n", line);
  return wrong.empty();
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
