// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/robot/robot_version.hpp"
#include "common/robot/stable_memory.hpp"

namespace sidestep::robot {

template <typename Real>
struct Settings {
  Real tracking_bound_m = Real(0.005);
  Real drift_bound_m = Real(0.003);    ///< the part of the tracking bound that drift may use: 0.6 of it
  Real deceleration_mps2 = 5;          ///< D, used for the robot's own stops
  std::int64_t actuation_lead_ns = 0;  ///< time from a command to the motors until the body moves
};

/// Number of versions and commands that a robot has received, by outcome.
struct Counts {
  std::uint64_t activated = 0;  ///< since the last restart
  std::uint64_t refused_late = 0;
  std::uint64_t refused_base = 0;  ///< includes versions dropped because the queue was full
  std::uint64_t refused_fenced = 0;
  std::uint64_t refused_malformed = 0;
  std::uint64_t refused_unstored = 0;  ///< refused because they could not be stored in memory
};

/// The reason for an own stop, that is, a stop that the robot itself has decided on.
enum class OwnStopReason : std::uint8_t {
  kOffReference,  ///< the robot is farther from its reference than the tracking bound
  kDrifted,       ///< drift has exceeded its bound for kMaxRecovery_ns
  kDisplaced,     ///< the robot was displaced without its wheels measuring it
  kRestart,       ///< the robot has restarted
  kClockSetBack,  ///< the robot's clock was set back
};

/// The protocol's part of a command. Its numbers and times have been checked: they are finite, and less than
/// an hour ahead of the robot's clock.
struct Command {
  std::uint64_t incarnation = 0;  ///< the agent's incarnation
  std::uint64_t epoch = 0;        ///< highest epoch that the agent knows; 0: none
  std::int64_t sent_at_ns = 0;    ///< by the agent's clock
  const Version* version = nullptr;
};

/// The motion that the motors will still perform during Settings::actuation_lead_ns because of commands
/// already sent to them. It starts at the velocity `from_mps` and has a few parts, in each of which the
/// velocity changes linearly.
template <typename Real>
struct MotionUnderWay {
  static constexpr int kMaxParts = Version::kMaxPhases - 1;
  struct Part {
    std::int64_t duration_ns = 0;
    Vec<Real> end_velocity_mps;
  };
  Vec<Real> from_mps;
  int part_count = 0;
  Part parts[kMaxParts];
  Real error_m = 0;  ///< maximum distance, at any time, from the motion that the commands cause
};

/// The robot's own estimate of its state. A robot whose estimate is not finite has no pose.
template <typename Real>
struct Estimate {
  Vec<Real> position_m, velocity_mps;
  Real position_error_rms_m = 0;   ///< only read if needs_uncertainty() returns true
  Real jump_m = 0;                 ///< displacement that the last fix showed but the wheels did not measure
  MotionUnderWay<Real> under_way;  ///< only read if there is an actuation lead and is_stop_due() returns true
};

/// The protocol's part of a robot's report (see Feedback in idl/robot.idl).
struct RobotReport {
  std::uint64_t obeyed_incarnation = 0;  ///< acknowledged: no version of an earlier agent can still start
  std::uint64_t obeyed_epoch = 0;
  std::int64_t valid_at_ns = 0;
  const Version* executing = nullptr;  ///< valid until the next call
  bool is_off_reference = false, is_lifted = false, has_moved = false;
  bool has_command = false;
  std::int64_t command_sent_at_ns = 0;  ///< send time of the last obeyed command, by the agent's clock
  std::int64_t command_received_at_ns = 0;
  std::uint64_t activated = 0;
  std::int64_t lead_ns = 0;  ///< time before its start by which a version must arrive
};

/// The robot's side of the safety protocol (coordinator/PROTOCOL.md, "What a robot must do"), without control
/// and estimation. It executes one complete version and holds a few pending ones. It switches to a version
/// only at that version's start time, and only from that version's base. Without commands it executes its
/// version to the end and rests. It stores everything that it acknowledges before acknowledging it.
///
/// Once it obeys a new agent, it refuses versions of earlier agents and discards their pending versions, with
/// one exception: if the motors respond with a delay, they have already been sent the beginning of any
/// version that starts within the lead, so the robot executes that version. It acknowledges the new agent and
/// accepts its versions only when no such version can still start. Therefore the fact that acknowledges an
/// agent covers everything that the robot executes for earlier agents.
///
/// It makes an own stop if the robot may be farther from its reference than the tracking bound. It also makes
/// an own stop if the robot may be farther than the drift bound and either does not return within
/// kMaxRecovery_ns or was displaced without its wheels measuring it. An own stop is a version that brakes
/// from the estimated state; the robot executes it immediately. If the motors respond with a delay, the stop
/// begins with the motion already under way.
///
/// A robot without a pose accepts no version, and must not report facts. A lifted robot executes nothing
/// (version 0) and accepts only a granted rest version on base 0.
///
/// All times are by the robot's clock in nanoseconds since 1970, and go back only with set_clock_back().
/// `Real` is float or double. Requires no heap, no exceptions and no operating system.
template <typename Real>
class RobotSide {
 public:
  static constexpr int kMaxPending = 8;
  /// Time within which the control must return to the reference; otherwise the robot makes an own stop.
  static constexpr std::int64_t kMaxRecovery_ns = 25'000'000;
  /// Gap between the highest number that has reached the robot and the number of its own stop: versions that
  /// it has not received yet may already be granted and in transit.
  static constexpr std::uint64_t kOwnNumberGap = std::uint64_t{1} << 20;
  /// The stored bound of numbers exceeds the numbers in use by up to this reserve, so the bound is rarely
  /// stored.
  static constexpr std::uint64_t kStoredNumberReserve = std::uint64_t{1} << 26;

  /// For a robot that has just been switched on and does not know its pose.
  RobotSide(const Settings<Real>& settings, const DurableState& remembered);

  /// The robot is at rest at this place and executes version 0 there. Only for a robot that has never obeyed
  /// an agent.
  void begin_at_rest(double x_m, double y_m);
  /// The robot knows its pose from now on. The next check_reference() makes an own stop there.
  void find_pose();
  /// The robot no longer knows its pose.
  void lose_pose();
  /// The robot has lost everything except its stored memory, its pose and what it reported. The next
  /// check_reference() at which it may stop makes an own stop.
  void reboot() { is_rebooting_ = true; }
  /// The robot has been without power and has lost its pending versions.
  void switch_on();
  /// The robot's clock was set back. The times of its versions and facts are invalid, so it reports nothing
  /// until the next check_reference() makes an own stop timed by the new clock. From then on, the caller must
  /// give facts a higher robot incarnation.
  void set_clock_back(std::int64_t now_ns);

  /// Obeys a command, or refuses and counts it. Returns whether the sender is an agent that the robot obeys;
  /// if so, the robot may use the rest of the command, such as a fix.
  [[nodiscard]] bool on_command(const Command& command, std::int64_t now_ns, StableMemory& memory);
  /// Counts a command that could not be decoded.
  void on_malformed_command(std::int64_t now_ns);

  /// Switches to the next version that is due; returns false if no version is due. Every other function that
  /// takes a time first makes all switches due by then, so that a reported "executing f at t" remains true.
  bool switch_next(std::int64_t now_ns);

  /// Whether check_reference() would read the estimate's position error, which is costly to compute.
  bool needs_uncertainty(std::int64_t now_ns, const Vec<Real>& position_m) const;
  /// Whether check_reference() would make an own stop, and would read the estimate's motion under way, which
  /// is costly to compute. Precondition: all switches due by then have been made.
  bool is_stop_due(std::int64_t now_ns, const Estimate<Real>& estimate) const;
  /// Call once per control period. Makes an own stop if the estimate demands it. If the estimate is not
  /// finite, the robot loses its pose. No effect on a robot that is lifted or has no pose.
  void check_reference(std::int64_t now_ns, const Estimate<Real>& estimate, StableMemory& memory);

  /// The robot was lifted off the floor: discards the executed version and all pending ones. Facts then
  /// report version 0 and name the last version as its base, so that the agent can number the next version
  /// above it. If called again, it also discards a rest version that was accepted in the meantime.
  void lift(std::int64_t now_ns, double x_m, double y_m);
  /// The robot has been put down; it executes a rest version at that place.
  void put_down() { is_lifted_ = false; }

  /// The facts at this time. Precondition: may_report().
  RobotReport robot_report(std::int64_t now_ns);
  /// Whether the robot executes a version that begins where it is, and has stored everything that its facts
  /// would acknowledge.
  bool may_report() const {
    return has_pose_ && !has_found_pose_ && !is_memory_broken_ && !is_clock_set_back_;
  }

  const Version& executing() const { return executing_; }
  /// The version that the robot will execute at a later time, according to the pending versions.
  const Version& planned(std::int64_t t_ns) const;
  /// Whether the robot executes an own stop.
  bool is_off_reference() const { return is_off_reference_; }
  /// Reason for the last own stop.
  OwnStopReason own_stop_reason() const { return own_stop_reason_; }
  bool is_lifted() const { return is_lifted_; }
  bool has_pose() const { return has_pose_; }
  /// Incarnation of the agent whose versions the robot accepts.
  std::uint64_t obeyed_incarnation() const { return durable_.incarnation; }
  /// Incarnation of the agent that the robot's facts acknowledge.
  std::uint64_t acknowledged_incarnation() const { return acknowledged_incarnation_; }
  std::uint64_t obeyed_epoch() const { return durable_.epoch; }
  const Counts& counts() const { return counts_; }
  /// Number of own stops since the last restart.
  std::uint64_t own_stops() const { return own_stops_; }
  bool has_pending() const { return pending_count_ > 0; }
  /// The start of the next pending version. Precondition: has_pending().
  std::int64_t next_start_ns() const { return pending_[0].start_ns; }

 private:
  void discard_fenced(std::int64_t now_ns);
  void acknowledge();
  bool is_irrevocable(const Version& version, std::int64_t now_ns) const {
    return version.start_ns - settings_.actuation_lead_ns <= now_ns;
  }
  void take(const Version& version, std::int64_t now_ns, StableMemory& memory);
  bool holds(std::uint64_t number) const;
  bool may_take(const Version& version) const;
  void insert(const Version& version);
  void remove_pending(int index);
  bool store(const DurableState& next, StableMemory& memory);
  bool is_within(Real bound_m, Real error_m, const Estimate<Real>& estimate) const;
  Real error_m(std::int64_t now_ns, const Vec<Real>& position_m) const;
  bool may_stop(std::int64_t now_ns) const {
    const bool is_new = now_ns > last_report_ns_ && now_ns > executing_.start_ns;
    return !is_lifted_ && has_pose_ && (is_clock_set_back_ || is_new);
  }
  std::int64_t drifted_since_ns(std::int64_t now_ns, const Estimate<Real>& estimate) const;
  bool must_stop(std::int64_t now_ns, const Estimate<Real>& estimate, OwnStopReason& reason) const;
  void start_own_stop(OwnStopReason reason, const Estimate<Real>& estimate, std::int64_t now_ns,
                      StableMemory& memory);
  bool begin_with_commanded_motion(Version& stop, const Estimate<Real>& estimate) const;
  void restart();

  static constexpr std::int64_t kNever_ns = INT64_MAX;

  Settings<Real> settings_;
  DurableState durable_;            ///< the state as stored
  std::uint64_t highest_seen_ = 0;  ///< highest version number or incarnation received
  std::uint64_t highest_executed_ = 0;
  std::uint64_t acknowledged_incarnation_ = 0;
  Version executing_;
  bool has_moved_ = false;
  bool is_off_reference_ = false;
  OwnStopReason own_stop_reason_ = OwnStopReason::kOffReference;
  bool is_lifted_ = false;
  bool is_rebooting_ = false;
  bool has_pose_ = false;
  bool has_found_pose_ = false;     ///< the own stop at the found pose has not been made yet
  bool is_clock_set_back_ = false;  ///< the own stop due to the set clock has not been made yet
  bool is_memory_broken_ = false;
  bool has_command_ = false;
  std::int64_t command_sent_at_ns_ = 0, command_received_at_ns_ = 0;
  std::int64_t last_report_ns_ = INT64_MIN;
  std::int64_t drifted_since_ns_ = kNever_ns;  ///< kNever_ns while the robot is within the drift bound
  Version pending_[kMaxPending];               ///< sorted by start, then number, ascending
  int pending_count_ = 0;
  Counts counts_;
  std::uint64_t own_stops_ = 0;
};

extern template class RobotSide<float>;
extern template class RobotSide<double>;

}  // namespace sidestep::robot
