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
#include "deploy/simulate/system/sim_system.hpp"

namespace sidestep {

/// The clients of a trial, each a process of its own, and the judge of what becomes of their orders. The
/// judge knows when each hold was confirmed and when somebody lifted it, and where robots really are: no
/// robot moves while it is held, and no confirmed order is forgotten.
class OrderClients {
 public:
  /// After a hold is confirmed, a robot may complete what was granted before: it moves at most for the time
  /// to brake and twice the cycles that its agent proposes ahead, which depend on the network.
  static constexpr Duration kTimeToRest = std::chrono::milliseconds(2500);
  /// A resting robot may correct its place.
  static constexpr double kMaxMovement_m = 0.05;

  /// Ground truth is sampled, so robots that touch may appear this far apart.
  static constexpr double kContactTolerance_m = 0.01;

  /// `radius_m`: of robots. The system must outlive the clients.
  OrderClients(SimSystem& system, double radius_m);

  void give(const Order& order);
  /// Of a coordinator that hears somebody no more, nothing is expected.
  void expect_nothing_of(const std::string& coordinator);
  /// What was wrong, in words.
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
    RobotId robot = 0;  // or kAllRobots
    OrderHandle handle = 0;
    std::optional<Time> confirmed_at{};
    std::set<RobotId> released{};  // of all robots
  };
  struct Memory {
    std::uint32_t pages = 0;  // so far
    std::map<std::pair<RobotId, Rank>, std::pair<OrderNumber, ClientId>> drives;
  };
  Client& client_of(ClientId id);
  void lift(const Order& resume);
  void on_change(ClientId client, const SentOrder& sent);
  void on_truth(const msg::GroundTruth& truth);
  bool touches_another(const msg::TrueRobotState& body, const msg::GroundTruth& truth) const;
  void on_memory(const msg::OrderMemory& memory);
  /// The confirmed hold of the robot that has lasted longest; null: none.
  const Hold* hold_of(RobotId robot) const;
  void check_drives(const Client& client, std::vector<std::string>& failures) const;

  const double touching_distance_m_;
  SimSystem& system_;
  SimBus bus_;  // observes
  std::map<ClientId, std::unique_ptr<Client>> clients_;
  std::vector<Hold> holds_;  // that nobody has tried to lift who may
  std::map<RobotId, Time> disturbed_until_;
  std::map<RobotId, Vec2> rest_m_;                       // where robots that must rest are
  std::map<std::uint32_t, Memory> arriving_, memories_;  // by coordinator; the last whole ones
  std::set<std::uint32_t> excused_;                      // coordinators
  std::vector<std::string> failures_;
};

}  // namespace sidestep
