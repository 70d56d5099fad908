// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/fault/attest_command.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <string>

#include "common/file/console.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/messaging/robot_notices.hpp"
#include "common/motion/version.hpp"
#include "common/process/command_line.hpp"
#include "common/process/network_text.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/trial/fault/attestation_exchange.hpp"
#include "deploy/trial/fault/operator_messages.hpp"

namespace sidestep {
namespace {

struct AttestOptions {
  RobotId robot = 0;
  DdsSettings dds;
};

/// Attests until the active coordinator no longer waits for the robot.
class Attestation {
 public:
  Attestation(DdsBus& bus, RobotId robot)
      : bus_(bus), exchange_(robot, bus.now()), writer_(bus.advertise(topics::kAttestation)) {
    bus_.subscribe(topics::kCoordinator, [this](const msg::CoordinatorState& state) { on_state(state); });
  }

  const AttestationExchange& exchange() const { return exchange_; }
  /// The epoch of the last state heard from an active coordinator; nullopt: none was heard.
  std::optional<Epoch> epoch() const { return epoch_; }

 private:
  void on_state(const msg::CoordinatorState& state) {
    if (state.coordinator_mode() == msg::CoordinatorMode::COORDINATOR_STANDBY) return;
    epoch_ = state.epoch();
    const bool is_missing = std::ranges::count(missing_robots(state), exchange_.robot()) > 0;
    if (exchange_.update(is_missing, bus_.now())) send();
    if (!is_missing) bus_.stop();
  }

  void send() {
    msg::AbsenceAttestation attestation;
    attestation.robot(exchange_.robot());
    attestation.header(operator_header());
    writer_.publish(attestation, bus_.now());
  }

  DdsBus& bus_;
  AttestationExchange exchange_;
  Writer<msg::AbsenceAttestation> writer_;
  std::optional<Epoch> epoch_;
};

int attest(const AttestOptions& options) {
  DdsBus bus(options.dds);
  const StopSignals stop_signals([&bus] { bus.stop(); });
  const Attestation attestation(bus, options.robot);
  bus.run_until(bus.now() + AttestationExchange::kTimeout);
  const AttestationExchange& exchange = attestation.exchange();
  if (exchange.state() == AttestationExchange::State::kAccepted) {
    print_output("robot {} counts as absent in epoch {}, until it registers\n", options.robot,
                 *attestation.epoch());
    return 0;
  }
  const std::string reason =
      attestation.epoch() ? exchange.reason() : "no active coordinator answers " + network_text(options.dds);
  fmt::print(stderr, "sidestep: could not attest the absence of robot {}: {}\n", options.robot, reason);
  return kExitFailure;
}

}  // namespace

void add_attest_command(const CliCommand& root, std::function<int()>& action) {
  const CliCommand robot = root.add_subcommand("robot", "Reports facts about a robot as the operator");
  robot.require_subcommand();
  const auto options = std::make_shared<AttestOptions>();
  options->dds.participant = "sidestep-robot";
  options->dds.identity = {Role::kOperator};
  options->dds.is_operator = true;
  const CliCommand absent = robot.add_subcommand(
      "absent", "Attests that a silent robot, for which all others wait, is not on the floor");
  absent.add_option("ROBOT", options->robot, "robot id").required().check(in_range(0U, kMaxRobots - 1));
  add_dds_options(absent, options->dds);
  absent.on_parsed([options, &action] { action = [options] { return attest(*options); }; });
}

}  // namespace sidestep
