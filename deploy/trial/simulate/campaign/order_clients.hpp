// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/client/order_client.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"

namespace sidestep {

/// The clients of a trial, each a separate process, and the judge of their orders. The judge knows when each
/// hold was confirmed, when any client lifted it, and where robots really are. It checks that no robot moves
/// while it is held, and that no confirmed order is forgotten. Like the audit, it does not judge motions once
/// a process has accepted a second simulator (SimSystem::was_second_simulator_accepted()).
class OrderClients {
 public:
  /// How long a robot may still move after a hold is confirmed, because it completes earlier grants: the
  /// braking time plus twice the number of cycles that its agent proposes ahead, which depends on the
  /// network.
  static constexpr Duration kTimeToRest = std::chrono::milliseconds(2500);
  /// A resting robot may correct its position by this much.
  static constexpr double kMaxMovement_m = 0.05;

  /// Ground truth is sampled, so robots that touch may appear this far apart.
  static constexpr double kContactTolerance_m = 0.01;

  /// The system runs the scenario, and must outlive the clients.
  OrderClients(SimSystem& system, const Scenario& scenario);

  void give(const Order& order);
  /// Stops judging a coordinator that can no longer hear some process.
  void stop_judging(const std::string& coordinator);
  /// The failures, in words.
  std::vector<std::string> failures() const;

 private:
  struct Client {
    Client(SimNetwork& network, ClientId id) : bus(network), orders(bus, id) {}
    SimBus bus;
    OrderClient orders;
    std::vector<OrderHandle> given;
  };
  struct Hold {
    ClientId client = 0;
    RobotId robot = 0;  // a robot or kAllRobots
    OrderHandle handle = 0;
    std::optional<Time> confirmed_at{};
    std::set<RobotId> released{};  // robots released from a hold of all robots
  };
  struct Disturbance {
    Time end{};
    bool has_rested = true;  // the robot has come to rest since the disturbance
  };
  struct Memory {
    std::uint32_t pages = 0;  // number of pages received so far
    std::map<std::pair<RobotId, Rank>, std::pair<OrderNumber, ClientId>> drives;
  };
  Client& client_of(ClientId id);
  void lift(const Order& resume);
  void on_change(ClientId client, const SentOrder& sent);
  void on_truth(const msg::GroundTruth& truth);
  /// Whether a disturbance may still move the robot at a time.
  bool is_disturbed(const msg::TrueRobotState& body, const msg::GroundTruth& truth, Time now);
  bool touches_another(const msg::TrueRobotState& body, const msg::GroundTruth& truth) const;
  void on_memory(const msg::OrderMemory& memory);
  /// The confirmed hold of the robot that has lasted longest; null if there is none.
  const Hold* hold_of(RobotId robot) const;
  void check_drives(const Client& sender, std::vector<std::string>& failures) const;

  const double touching_distance_m_;
  const Duration time_to_coast_;  // time in which a robot without power comes to rest
  SimSystem& system_;
  SimBus bus_;  // the observer's bus
  std::map<ClientId, std::unique_ptr<Client>> clients_;
  std::vector<Hold> holds_;  // holds that no client with permission has tried to lift
  std::map<RobotId, Disturbance> disturbances_;
  std::map<RobotId, Vec2> rest_m_;  // positions of robots that must rest
  // Indexed by coordinator: pages of memories that are still arriving, and the last complete memory.
  std::map<std::uint32_t, Memory> arriving_, memories_;
  std::set<std::uint32_t> excused_;  // coordinators that are not judged
  std::vector<std::string> failures_;
};

}  // namespace sidestep
