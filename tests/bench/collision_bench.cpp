// SPDX-License-Identifier: Apache-2.0
// Swept discs against circles: our structures and peers side by side. All answers have to agree.
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

constexpr std::size_t kQueries = 100'000, kRounds = 7;
constexpr double kCovered = 0.2;
constexpr std::uint64_t kSeed = 1;

struct Query {
  Vec2 from_m, to_m;
};

/// Circles that cover a fifth of the unit square, and short ways of a small robot: sizes go with the distance
/// between circles, so the world only becomes larger as their number grows, and hits stay as frequent.
struct Problem {
  explicit Problem(std::size_t count) {
    Rng rng(kSeed);
    const double spacing_m = 1 / std::sqrt(static_cast<double>(count));
    const double mean_radius_m = spacing_m * std::sqrt(kCovered / 3.14159265 / (13.0 / 12.0));
    radius_m = 0.08 * spacing_m;
    for (std::size_t i = 0; i < count; ++i)
      circles.push_back({{rng.uniform(), rng.uniform()}, mean_radius_m * rng.uniform(0.5, 1.5)});
    for (std::size_t i = 0; i < kQueries; ++i) {
      const Vec2 from(rng.uniform(), rng.uniform());
      const Vec2 way = rotated({rng.uniform(0, 0.8) * spacing_m, 0}, rng.uniform(0, 6.283));
      queries.push_back({from, from + way});
    }
  }
  std::vector<Circle> circles;
  std::vector<Query> queries;
  double radius_m;
};

/// One side of the comparison: answers all queries and says how long one took, in ns. `dependent`: which is
/// asked next depends on the answer, so that a query cannot begin before the last one has ended.
struct Side {
  std::string name;
  bool is_ours;
  std::function<double(bool dependent)> pass;
  std::vector<bool> answers;
  std::vector<double> independent_ns, dependent_ns;
};

/// What this thread has had of a processor: others that want it too do not count.
double cpu_time_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

template <bool kDependent, typename Ask>
double time_ns(const Problem& problem, Ask& ask) {
  std::size_t at = 0, hits = 0;
  const double begin_ns = cpu_time_ns();
  for (std::size_t i = 0; i < kQueries; ++i) {
    const bool hit = ask(problem.queries[at]);
    hits += hit;
    at += kDependent ? 1 + static_cast<std::size_t>(hit) : 1;
    at = at < kQueries ? at : 0;
  }
  const double end_ns = cpu_time_ns();
  asm volatile("" : : "r"(hits));
  return (end_ns - begin_ns) / kQueries;
}

template <typename Ask>
Side side(std::string name, bool is_ours, const Problem& problem, Ask ask) {
  Side made{std::move(name), is_ours, {}, {}, {}, {}};
  for (const Query& query : problem.queries) made.answers.push_back(ask(query));
  made.pass = [&problem, ask](bool dependent) mutable {
    return dependent ? time_ns<true>(problem, ask) : time_ns<false>(problem, ask);
  };
  return made;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// Answers that differ although the way is not within 1 nm of a circle.
std::size_t disagreements(const Problem& problem, const std::vector<Side>& sides) {
  std::size_t differ = 0;
  for (std::size_t i = 0; i < kQueries; ++i) {
    const Query& query = problem.queries[i];
    const auto answers_otherwise = [&](const Side& other) { return other.answers[i] != sides[0].answers[i]; };
    if (std::none_of(sides.begin(), sides.end(), answers_otherwise)) continue;
    double gap_m = 1;
    for (const Circle& circle : problem.circles) {
      const double distance_m = std::sqrt(squared_distance(circle.centre_m, {query.from_m, query.to_m}));
      gap_m = std::min(gap_m, std::abs(distance_m - circle.radius_m - problem.radius_m));
    }
    differ += gap_m > 1e-9;
  }
  return differ;
}

bool compare(std::size_t count) {
  const Problem problem(count);
  std::vector<Side> sides;
  const double radius_m = problem.radius_m;
  const std::vector<Shape> shapes(problem.circles.begin(), problem.circles.end());
  const ObstacleWorld linear(shapes, Structure::kLinear), masks(shapes, Structure::kMasks);
  const ObstacleWorld tree(shapes, Structure::kTree);
  const auto add = [&](const char* name, const ObstacleWorld& world) {
    sides.push_back(
        side(name, true, problem, [&](const Query& q) { return world.touches(q.from_m, q.to_m, radius_m); }));
  };
  if (count <= 4096) add("linear", linear);
  add("extent masks", masks);
  add("tree of boxes", tree);
  const peers::PlainArray plain(problem.circles);
  const peers::BoostRTree boost_tree(problem.circles);
  peers::FclTree fcl_tree(problem.circles);
  if (count <= 4096)
    sides.push_back(side("plain vectorised array", false, problem, [&](const Query& q) {
      return plain.touches({q.from_m, q.to_m, radius_m});
    }));
  sides.push_back(side("boost R-tree", false, problem, [&](const Query& q) {
    return boost_tree.touches({q.from_m, q.to_m, radius_m});
  }));
  sides.push_back(side("FCL dynamic AABB tree", false, problem, [&](const Query& q) {
    return fcl_tree.touches({q.from_m, q.to_m, radius_m});
  }));
  for (std::size_t round = 0; round < kRounds; ++round) {
    for (Side& s : sides) {
      s.independent_ns.push_back(s.pass(false));
      s.dependent_ns.push_back(s.pass(true));
    }
  }
  double best_peer = 1e9, best_peer_dependent = 1e9;
  for (const Side& s : sides) {
    if (s.is_ours) continue;
    best_peer = std::min(best_peer, median(s.independent_ns));
    best_peer_dependent = std::min(best_peer_dependent, median(s.dependent_ns));
  }
  const auto hits = static_cast<double>(std::count(sides[0].answers.begin(), sides[0].answers.end(), true));
  for (const Side& s : sides) {
    const double ns = median(s.independent_ns), dependent_ns = median(s.dependent_ns);
    fmt::print("{:>6}  {:4.1f}  {:<24}  {:8.1f}  {:6.2f}  {:8.1f}  {:6.2f}\n", count, 100 * hits / kQueries,
               s.name, ns, best_peer / ns, dependent_ns, best_peer_dependent / dependent_ns);
  }
  const std::size_t differ = disagreements(problem, sides);
  if (differ != 0) fmt::print("{} answers differ\n", differ);
  return differ == 0;
}

}  // namespace

int main() {
  fmt::print("ns per query, medians of {} rounds of {}; times: how often the best peer's time\n", kRounds,
             kQueries);
  fmt::print("                                          independent        dependent\n");
  fmt::print("number hit %  structure                       ns   times        ns   times\n");
  bool agree = true;
  for (const std::size_t count : {16, 64, 256, 1024, 4096, 16384}) agree = compare(count) && agree;
  return agree ? 0 : 1;
}
