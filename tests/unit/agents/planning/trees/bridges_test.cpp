// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/trees/bridges.hpp"

#include "tests/catch.hpp"
#include "tests/unit/agents/planning/ball_domain.hpp"

namespace sidestep::bridges_test {

using Tree = SearchTree<BallDomain>;
constexpr double kFar = std::numeric_limits<double>::infinity();

Tree random_tree(const BallDomain& domain, const BallDomain::State& root, int nodes, Rng& rng) {
  Tree tree;
  tree.start(domain, root);
  for (int i = 1; i < nodes; ++i) {
    const auto parent = static_cast<Tree::Node>(rng.below(tree.size()));
    tree.add(domain, domain.sample(rng), parent);
  }
  return tree;
}

/// Slow reference: Floyd-Warshall over all nodes of both trees.
double shortest_by_brute_force(const Tree& a, const Tree& b,
                               const std::vector<std::pair<std::uint32_t, std::uint32_t>>& bridges) {
  const std::size_t n = a.size() + b.size();
  std::vector<std::vector<double>> d(n, std::vector<double>(n, kFar));
  const auto join = [&](std::size_t i, std::size_t j, double length) { d[i][j] = d[j][i] = length; };
  for (std::size_t i = 0; i < n; ++i) d[i][i] = 0;
  for (std::uint32_t i = 1; i < a.size(); ++i) join(i, a.parent(i), a.cost(i) - a.cost(a.parent(i)));
  for (std::uint32_t i = 1; i < b.size(); ++i)
    join(a.size() + i, a.size() + b.parent(i), b.cost(i) - b.cost(b.parent(i)));
  for (const auto& [i, j] : bridges) join(i, a.size() + j, 0);
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) d[i][j] = std::min(d[i][j], d[i][k] + d[k][j]);
  return d[0][a.size()];
}

TEST_CASE("the path over bridges is the shortest in the union of the trees") {
  const auto seed = GENERATE(range<std::uint64_t>(1, 60));
  CAPTURE(seed);
  Rng rng(seed);
  const BallDomain domain({}, {0.9, 0.9, 0.9});
  const Tree from_start = random_tree(domain, {-0.9, -0.9, -0.9}, 20, rng);
  Tree from_goal = random_tree(domain, {0.9, 0.9, 0.9}, 15, rng);
  Bridges<BallDomain> bridges;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  const std::uint64_t count = 1 + rng.below(6);
  while (pairs.size() < count) {
    const auto first = static_cast<Tree::Node>(rng.below(from_start.size()));
    const auto second =
        from_goal.add(domain, from_start[first], static_cast<Tree::Node>(rng.below(from_goal.size())));
    bridges.add(first, second);
    pairs.emplace_back(first, second);
  }
  std::vector<BallDomain::State> path;
  const double length = bridges.shortest(from_start, from_goal, path);
  CHECK(length == Approx(shortest_by_brute_force(from_start, from_goal, pairs)));
  CHECK(length_of(domain, path) == Approx(length));
  CHECK(path.front() == from_start[0]);
  CHECK(path.back() == from_goal[0]);
}

}  // namespace sidestep::bridges_test
