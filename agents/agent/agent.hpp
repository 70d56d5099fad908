// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "agents/agent/negotiation.hpp"
#include "agents/agent/neighbours.hpp"
#include "agents/agent/seen_obstacles.hpp"
#include "agents/agent/planning_scratch.hpp"
#include "agents/navigation/deadlock_recovery.hpp"
#include "agents/navigation/motion_control.hpp"
#include "agents/navigation/ways.hpp"
#include "agents/safety/escape_search.hpp"
#include "common/config/scenario.hpp"
#include "idl/disturbance.h"
#include "idl/monitor.h"
#include "idl/vision.h"

namespace sidestep {

/// One robot's mind: from what it sees and is told to what it proposes and commands, one decision a cycle.
/// All times are by the robot's clock, as far as the caller knows it.
class Agent {
 public:
  /// `scenario` has to have the robot, and the bench has to be one for it.
  Agent(const Scenario& scenario, RobotId robot, Incarnation incarnation, std::shared_ptr<PlanningScratch> bench);

  void on_feedback(const msg::Feedback& feedback);
  /// `now`: the latest that it can be by the robot's clock.
  void on_world(const msg::WorldState& world, Time now);
  /// `beside` as for Neighbours::on_page().
  void on_ledger(const msg::LedgerPage& page, std::shared_ptr<void>* beside = nullptr);
  /// Somebody's hand: hears where a robot that was lifted shall be put down.
  void on_disturbance(const msg::Disturbance& disturbance);
  void on_coordinator_state(const msg::CoordinatorState& state, Time now);
  /// The command that forwards a granted version.
  std::optional<msg::Command> on_verdict(const msg::Verdict& verdict, Time now);

  /// What to do from `start` on, if anything: nothing when what the robot holds already ends at its goal, or
  /// when vision has lost the robot: then it must not rely on where it believes to be.
  std::optional<SearchQuery> plan(Time now, Time start);
  /// The proposal for what was planned; none when nothing that is clear comes to mind (then the robot
  /// brakes).
  std::optional<msg::Proposal> search(const SearchQuery& query, Time now);

  /// Whether the robot is not on the floor, and may ask for the place where it shall be put down.
  bool wants_stand(Time now) const;
  /// The proposal to stand there. Precondition: wants_stand().
  msg::Proposal propose_stand(Time now, Time start);

  /// Fences the robot, forwards what vision saw of it, and once more a granted version whose start is still
  /// to come.
  msg::Command command(Time now);
  Negotiation& negotiation() { return negotiation_; }

  /// Without the durations, which the caller measures.
  msg::AgentStatus status(Time now) const;

 private:
  const Goal& goal() const { return robot_.goals[goal_index_]; }
  /// Finds the ways to the goal anew when what is in the way, robots that stand and what moves without asking
  /// included, has changed.
  void update_ways(Time now);
  std::vector<Circle> in_the_way(Time now);
  std::vector<Circle> moving_in_the_way(Time now);
  /// How far from the edge of what is in the way a robot's centre stays where it plans.
  double planning_separation_m() const;
  /// What a version on this base has to be taken for larger: as the base, until vision has seen the robot at
  /// rest.
  double inflation_from(const Version& base, Time start) const;
  /// Two robots that begin farther apart than this cannot come near to each other with what they do next.
  double search_horizon_m() const;
  /// Of the others who begin farther away than this, an agent need not know.
  double page_horizon_m() const;
  /// What to make for from where the robot will be at `start`, among what the others mean to do.
  Intent steer(const State& there, Time start, const Route& route);
  AccelerationCommand desired_for(const Intent& intent, const State& there, const Route& route) const;
  /// The way's direction, turned right to get out of a jam as far as obstacles allow.
  Vec2 direction_beside(const Vec2& here_m, const Route& route) const;

  const RobotSpec robot_;
  const std::shared_ptr<PlanningScratch> bench_;
  const FloorRules& rules_;
  const Duration clocks_differ_;  // any two of those that keep the bound, at most
  const Duration cycle_;
  const double tracking_bound_m_;
  const double goal_tolerance_m_;
  Negotiation negotiation_;
  Neighbours neighbours_;
  SeenObstacles obstacles_;
  LastChoice last_choice_;
  Rng rng_;
  std::size_t goal_index_ = 0;
  std::optional<Ways> ways_;        // to the current goal
  std::vector<Circle> in_the_way_;  // that ways_ leads round, besides the scenario's obstacles
  DeadlockRecovery recovery_;
  bool arrived_ = false;
  State estimate_;                   // the robot's own,
  double blind_path_m_ = 0;           // and how far from there it may drive without being seen again
  std::optional<msg::PoseFix> fix_;  // seen, not yet forwarded
  std::int64_t last_fix_ns_ = 0;
  std::size_t in_world_ = 0;  // the robot's place in the last world that it was in
  std::optional<Version> forwarded_;
  std::optional<Vec2> place_m_;      // where the robot shall be put down
  std::uint64_t invalid_ = 0;        // sights that made no sense
  std::uint64_t off_reference_ = 0;  // times the robot made a stop of its own,
  VersionNumber last_stop_ = 0;      // and the newest
  VersionNumber base_ = 0;           // of the query that plan() made,
  Intent intent_;                    // and what is wished for with it
  Time steered_for_{};
};

}  // namespace sidestep
