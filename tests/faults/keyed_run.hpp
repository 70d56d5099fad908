// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <signal.h>
#include <string>
#include <vector>

#include "common/client/order_client.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/file/write_file.hpp"
#include "common/messaging/dds/admission.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "common/protocol/senders.hpp"
#include "tests/catch.hpp"
#include "tests/faults/attacker.hpp"
#include "tests/faults/launched_run.hpp"
#include "tests/test_keys.hpp"

namespace sidestep {

/// Keys for all processes of a scenario.
inline std::unique_ptr<TestKeys> keys_for(const std::string& scenario) {
  auto keys = std::make_unique<TestKeys>(std::vector<std::string>{});
  const TemporaryFolder folder;
  write_file(folder.file("scenario.yaml"), scenario);
  for (const Identity& identity : identities_of(load_scenario(folder.file("scenario.yaml"))))
    keys->issue(identity, std::chrono::hours(12));
  return keys;
}

/// Three robots that stay at rest until they get an order.
inline constexpr const char* kThreeWaitingRobots =
    "name: waiting\nfield: {length_m: 6, width_m: 5}\ntime_limit_s: 3600\nrobots:\n"
    "  - {id: 0, start_m: [-2, -1]}\n  - {id: 1, start_m: [-2, 0]}\n  - {id: 2, start_m: [-2, 1]}\n";

inline std::vector<std::string> all_identities() {
  return {"agent", "0-2",    "coordinator", "0",      "vision",  "simulator",
          "judge", "viewer", "operator",    "client", "forklift"};
}

/// A run with keys whose robots are at rest.
struct KeyedRun {
  explicit KeyedRun(const std::vector<std::string>& extra_arguments = {})
      : keys(all_identities()), run(kThreeWaitingRobots, arguments(extra_arguments)) {
    INFO(run.output());
    REQUIRE(run.wait_until([&] { return run.truth().robots().size() == 3; }));
    // Repeats the command, because agents may not answer yet.
    REQUIRE(run.wait_until([&] { return command({"status", "--once"}) == "exit code 0"; }));
  }

  /// Runs `sidestep` with the keys of the run.
  std::string command(std::vector<std::string> arguments) {
    const auto dds = run.dds_arguments();
    arguments.insert(arguments.end(), dds.begin(), dds.end());
    if (std::ranges::find(arguments, "--keys") == arguments.end())
      arguments.insert(arguments.end(), {"--keys", keys.folder()});
    return run.command(arguments);
  }
  /// Settings of an attacker that has these keys, announces them like a Sidestep process, and states that it
  /// started `age` ago.
  AttackerSettings with_keys(const std::string& folder, Duration age = {}) const {
    const auto announced = [folder, age](const ParticipantId& id) {
      return credentials(Certificate::load(folder + "/" + key_files::kCertificate),
                         load_private_key(folder + "/" + key_files::kPrivateKey), fast_dds_version(), id,
                         EventLoop::now() - age);
    };
    return {domain(), AttackerKeys::of(folder), announced};
  }
  int domain() const { return std::stoi(run.dds_arguments()[1]); }

  /// Checks that the operator's own orders still take effect, and that there was no contact.
  void check_operator_orders() {
    CHECK(command({"go", "0", "0,-1", "--wait"}) == "exit code 0");
    check_safe();
  }
  void check_safe() {
    REQUIRE(kill(run.pid(), SIGINT) == 0);
    CHECK(run.wait_for_end() != "");
    INFO(run.output());
    CHECK(run.report()["contacts"] == 0);
    CHECK(run.report()["audit"]["violations"] == 0);
    CHECK_FALSE(run.printed("did not stop in time"));
  }

  TestKeys keys;
  LaunchedRun run;

 private:
  std::vector<std::string> arguments(std::vector<std::string> result) const {
    result.insert(result.end(), {"--keys", keys.folder()});
    return result;
  }
};

/// An operator who sends the robots back and forth.
class Shuttle {
 public:
  explicit Shuttle(const KeyedRun& keyed)
      : bus_(settings(keyed)), client_(bus_, static_cast<ClientId>(Sender::kOperator)) {}

  /// Runs for 1 ms. Returns the number of orders carried out so far.
  int drive() {
    bus_.run_until(bus_.now() + std::chrono::milliseconds(1));
    for (RobotId robot = 0; robot < handles_.size(); ++robot) {
      auto& handle = handles_[robot];
      if (handle && client_.find(*handle)->phase != OrderPhase::kArrived) continue;
      arrived_ += handle.has_value();
      sign_[robot] = -sign_[robot];
      handle = client_.go(robot, {{{2.0 * sign_[robot], -1.0 + robot}}});
    }
    return arrived_;
  }

 private:
  static DdsSettings settings(const KeyedRun& keyed) {
    DdsSettings result{keyed.domain(), "127.0.0.1", "shuttle"};
    result.keys = keyed.keys.folder();
    result.identity = {Role::kOperator};
    return result;
  }

  DdsBus bus_;
  OrderClient client_;
  std::array<std::optional<OrderHandle>, 3> handles_{};
  std::array<double, 3> sign_{-1, -1, -1};
  int arrived_ = 0;
};

}  // namespace sidestep
