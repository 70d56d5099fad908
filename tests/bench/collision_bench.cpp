// SPDX-License-Identifier: Apache-2.0
// Swept discs among obstacles: our structures and peers side by side. Answers have to agree.
#include <algorithm>
#include <fmt/core.h>
#include <functional>
#include <string>
#include <time.h>

#include "common/collision/obstacle_world.hpp"
#include "common/random/rng.hpp"
#include "tests/bench/collision_peers.hpp"

using namespace sidestep;

namespace {

constexpr std::size_t kQueries = 100'000, kRounds = 5;
constexpr double kCovered = 0.2;
constexpr std::uint64_t kSeed = 1;

struct Query {
  Vec2 from_m, to_m;
};

/// A shape about as large as a circle of the radius.
Shape any_shape(Rng& rng, const Vec2& at, double radius_m) {
  const double half_m = 0.88 * radius_m;
  switch (rng.below(4)) {
    case 0:
      return Box{at - Vec2(half_m, half_m), at + Vec2(half_m, half_m)};
    case 1:
      return Segment{at, at + rotated({3 * radius_m, 0}, rng.uniform(0, 6.283))};
    case 2: {
      ConvexPolygon polygon;
      for (int i = 0; i < 5; ++i) polygon.corners_m.push_back(at + rotated({1.1 * radius_m, 0}, i * 1.2566));
      return polygon;
    }
    default:
      return Circle{at, radius_m};
  }
}

/// Obstacles that cover a fifth of the unit square, and short ways of a small robot: sizes go with the
/// distance between obstacles, so the world only becomes larger as their number grows, and hits stay as
/// frequent.
struct Problem {
  Problem(std::size_t count, bool circles_only) {
    Rng rng(kSeed);
    const double spacing_m = 1 / std::sqrt(static_cast<double>(count));
    const double mean_radius_m = spacing_m * std::sqrt(kCovered / 3.14159265 / (13.0 / 12.0));
    radius_m = 0.08 * spacing_m;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec2 at(rng.uniform(), rng.uniform());
      const double size_m = mean_radius_m * rng.uniform(0.5, 1.5);
      shapes.push_back(circles_only ? Circle{at, size_m} : any_shape(rng, at, size_m));
    }
    for (std::size_t i = 0; i < kQueries; ++i) {
      const Vec2 from(rng.uniform(), rng.uniform());
      const Vec2 way = rotated({rng.uniform(0, 0.8) * spacing_m, 0}, rng.uniform(0, 6.283));
      queries.push_back({from, from + way});
    }
  }
  std::vector<Shape> shapes;
  std::vector<Query> queries;
  double radius_m;
};

/// What this thread has had of a processor: others that want it too do not count.
double cpu_time_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

/// Asks all queries and says how long one took. Branching: what is done next depends on the answer, as in
/// planners, so what cannot be foretold is waited for; otherwise answers are counted, and queries overlap.
template <bool kBranching, typename Ask>
double time_ns(const Problem& problem, Ask& ask) {
  std::size_t clear = 0;
  const double begin_ns = cpu_time_ns();
  for (const Query& query : problem.queries) {
    const bool hit = ask(query);
    if constexpr (kBranching) {
      if (hit) {
        asm volatile("nop" ::: "memory");
        continue;
      }
      ++clear;
    } else {
      clear += !hit;
    }
  }
  const double end_ns = cpu_time_ns();
  asm volatile("" : : "r"(clear));
  return (end_ns - begin_ns) / kQueries;
}

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
Side side(std::string name, bool is_ours, const Problem& problem, World& world, double tolerance_m = 1e-9) {
  const auto ask = [&world, radius_m = problem.radius_m](const Query& query) {
    return world.touches(query.from_m, query.to_m, radius_m);
  };
  Side made{std::move(name), is_ours, tolerance_m, {}, {}, {}, {}, {}};
  for (const Query& query : problem.queries) made.answers.push_back(ask(query));
  made.count_ns = [&problem, ask] { return time_ns<false>(problem, ask); };
  made.branch_ns = [&problem, ask] { return time_ns<true>(problem, ask); };
  return made;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Wrong answers where sides do not agree, but for ways that are within the side's tolerance of touching.
std::size_t count_wrong(const Problem& problem, const std::vector<Side>& sides) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < kQueries; ++i) {
    const Query& query = problem.queries[i];
    const auto answers_otherwise = [&](const Side& other) { return other.answers[i] != sides[0].answers[i]; };
    if (std::none_of(sides.begin(), sides.end(), answers_otherwise)) continue;
    double nearest2_m2 = 1;
    for (const Shape& shape : problem.shapes)
      nearest2_m2 = std::min(nearest2_m2, squared_distance(Segment{query.from_m, query.to_m}, shape));
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
  const Problem problem(count, circles_only);
  const ObstacleWorld chosen(problem.shapes), linear(problem.shapes, Structure::kLinear);
  const ObstacleWorld masks(problem.shapes, Structure::kMasks), tree(problem.shapes, Structure::kTree);
  std::vector<Side> sides;
  sides.push_back(side("chosen by size", true, problem, chosen));
  if (count <= 4096) sides.push_back(side("linear", true, problem, linear));
  sides.push_back(side("extent masks", true, problem, masks));
  sides.push_back(side("tree of boxes", true, problem, tree));
  const peers::PlainArray plain(circles_only ? problem.shapes : std::vector<Shape>());
  const peers::BoostRTree boost(problem.shapes);
  peers::FclTree fcl(problem.shapes);
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
      100 * kCovered);
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
