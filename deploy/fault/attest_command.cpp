// SPDX-License-Identifier: Apache-2.0
#include "deploy/fault/attest_command.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <optional>

#include "common/messaging/dds/bus.hpp"
#include "common/messaging/robot_notices.hpp"
#include "common/motion/version.hpp"
#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/fault/operator_messages.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

constexpr Duration kTimeout = 5s;  ///< longer than the period of participant announcements
constexpr Duration kRepeat = 200ms;

struct AttestOptions {
  RobotId robot = 0;
  DdsSettings dds;
};

/// Attests until no coordinator misses the robot any more.
class Attestation {
 public:
  Attestation(DdsBus& bus, RobotId robot)
      : bus_(bus), robot_(robot), writer_(bus.advertise(topics::kAttestation)) {
    bus_.subscribe(topics::kCoordinator, [this](const msg::CoordinatorState& state) { on_state(state); });
    repeat();
  }

  /// The epoch for which the absence is attested; nullopt: no coordinator has accepted it.
  std::optional<std::uint64_t> accepted_epoch() const { return accepted_epoch_; }
  bool was_missing() const { return was_missing_; }
  bool has_coordinator() const { return has_coordinator_; }

 private:
  void on_state(const msg::CoordinatorState& state) {
    if (state.coordinator_mode() == msg::CoordinatorMode::COORDINATOR_STANDBY) return;
    has_coordinator_ = true;
    const std::vector<RobotId> missing = missing_robots(state);
    if (std::ranges::count(missing, robot_) > 0) {
      was_missing_ = true;
    } else {
      if (was_missing_) accepted_epoch_ = state.epoch();
      bus_.stop();
    }
  }

  void repeat() {
    bus_.at(bus_.now() + kRepeat, [this] { repeat(); });
    if (!was_missing_) return;
    msg::AbsenceAttestation attestation;
    attestation.robot(robot_);
    attestation.header(operator_header());
    writer_.publish(attestation, bus_.now());
  }

  DdsBus& bus_;
  RobotId robot_;
  Writer<msg::AbsenceAttestation> writer_;
  bool has_coordinator_ = false, was_missing_ = false;
  std::optional<std::uint64_t> accepted_epoch_;
};

int attest(const AttestOptions& options) {
  DdsBus bus(options.dds);
  const StopSignals stop_signals([&bus] { bus.stop(); });
  const Attestation attestation(bus, options.robot);
  bus.run_until(bus.now() + kTimeout);
  if (const auto epoch = attestation.accepted_epoch()) {
    fmt::print("robot {} counts as absent in epoch {}, until it registers\n", options.robot, *epoch);
    return 0;
  }
  fmt::print(
      stderr, "sidestep: {}\n",
      !attestation.has_coordinator() ? "no active coordinator on this domain and interface"
      : attestation.was_missing()
          ? fmt::format("the coordinator still waits for robot {}: it hears facts of it", options.robot)
          : fmt::format("robot {} is not missing: the coordinator does not wait for it", options.robot));
  return kExitFailure;
}

}  // namespace

void add_attest_command(const CliCommand& root, std::function<int()>& action) {
  const CliCommand robot = root.add_subcommand("robot", "What an operator knows of a robot");
  robot.require_subcommand();
  const auto options = std::make_shared<AttestOptions>();
  options->dds.participant = "sidestep-robot";
  options->dds.is_operator = true;
  const CliCommand absent = robot.add_subcommand(
      "absent", "Attests that a silent robot, for which all others wait, is not on the floor");
  absent.add_option("ROBOT", options->robot, "robot id").required().check(in_range(0U, kMaxRobots - 1));
  add_dds_options(absent, options->dds);
  absent.on_parsed([options, &action] { action = [options] { return attest(*options); }; });
}

}  // namespace sidestep
