// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "agents/planning/robust.hpp"
#include "deploy/evaluation/planning/numbers.hpp"

namespace sidestep {

/// What some plans were like.
struct PlanMeasures {
  std::size_t asked = 0, solved = 0;
  Numbers plan_us{}, nodes{};
  Numbers length{};  ///< over the shortest, where solved

  /// `shortest_m`: the length of the shortest way, 0 when that is not known.
  void add(const Plan<Vec2>& plan, double us, double shortest_m);
  void add(const PlanMeasures& more);
  double solved_percent() const { return 100.0 * static_cast<double>(solved) / static_cast<double>(asked); }
};

/// The columns of a table of plans, after those that say which.
std::vector<std::string> plan_columns(std::vector<std::string> key);
/// A row of it.
std::vector<std::string> plan_cells(std::vector<std::string> key, const PlanMeasures& measures);

/// A planner that is measured beside others.
class Contestant {
 public:
  using Ask = std::function<const Plan<Vec2>&(const DiscDomain&, const Vec2& start_m, const Budget&, Rng&)>;

  Contestant(std::string name, Ask ask, std::uint64_t seed)
      : name_(std::move(name)), ask_(std::move(ask)), rng_(seed) {}

  void plan(const DiscDomain& domain, const Vec2& start_m, const Budget& budget, double shortest_m);

  const std::string& name() const { return name_; }
  const PlanMeasures& measures() const { return measures_; }

 private:
  std::string name_;
  Ask ask_;
  Rng rng_;
  PlanMeasures measures_;
};

/// A planner of this type with these settings.
template <typename Planner, typename... Settings>
Contestant contestant(std::string name, std::uint64_t seed, const Settings&... settings) {
  const auto planner = std::make_shared<Planner>(settings...);
  const auto ask = [planner](const DiscDomain& domain, const Vec2& start_m, const Budget& budget,
                             Rng& rng) -> const Plan<Vec2>& {
    return plan_robustly(*planner, domain, start_m, budget, rng);
  };
  return {std::move(name), ask, seed};
}

/// Asks all of them the same, each turn beginning with the next: who comes first finds the processor's caches
/// cold.
void ask_all(std::vector<Contestant>& contestants, std::size_t turn, const DiscDomain& domain,
             const Vec2& start_m, const Budget& budget, double shortest_m);

/// Asks all of them the questions of a ReplanCourse.
void replan_all(std::vector<Contestant>& contestants, std::size_t cycles, std::uint64_t seed,
                const std::function<void()>& after_cycle);

}  // namespace sidestep
