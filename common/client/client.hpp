// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Client library: sends orders to the robots of a running Sidestep. This header is installed, so it includes
/// only the standard library.
namespace sidestep::client {

/// The version of this library, for example "0.1.0"; programs and package of Sidestep have the same.
[[gnu::visibility("default")]] const char* version();

struct Settings {
  std::string name;          ///< the client's name; clients with different names have separate holds
  bool is_operator = false;  ///< the client's orders take precedence, and its resume ends all holds
  int domain = 0;            ///< DDS domain of the run, 0 .. 232
  std::string interface = "127.0.0.1";  ///< address of the network interface to use, or "all"
  /// Addresses of all hosts that run processes, for networks without multicast. Empty: use multicast.
  std::vector<std::string> peers{};
  /// Folder with this program's keys ("client NAME" or "operator"), or a folder made by `sidestep keys init`.
  /// Empty: no keys.
  std::string keys{};
  bool insecure = false;  ///< allows running without keys on networks that other machines can reach
};

/// Robots are numbered from 0, as in the scenario.
using RobotId = std::uint32_t;
/// Identifies an order of one client.
using OrderId = std::uint64_t;

struct Goal {
  double x_m = 0, y_m = 0;
  std::optional<double> heading_rad{};      ///< nullopt: any heading
  std::optional<double> speed_limit_mps{};  ///< limit on the way to this goal; nullopt: the robots' own limit
  std::optional<double> tolerance_m{};      ///< arrival distance; nullopt: the scenario's value
};

struct Point {
  double x_m = 0, y_m = 0;
};

/// A part of the floor: the convex hull of up to 16 corners, extended by a radius.
struct Zone {
  std::vector<Point> corners;
  double radius_m = 0;
  std::optional<double> speed_limit_mps{};  ///< nullopt: robots must keep out
};

/// The state of an order.
enum class OrderPhase {
  kSent,      ///< no coordinator has answered yet; the order is repeated until one does
  kAccepted,  ///< a coordinator and another process remember it; every order except `go` is then complete
  kDriving,
  kBlocked,   ///< the goal cannot be reached now; the robot waits as near as it can
  kArrived,   ///< the robot is at its last goal
  kReplaced,  ///< a later order has replaced it
  kRefused
};

/// Why an order was refused.
enum class Refusal {
  kNone,
  kMalformed,     ///< no goals or corners, too many of them, or a number that is NaN or out of bounds
  kUnknownRobot,  ///< the scenario has no such robot
  kOutsideField,  ///< a goal lies outside the field
  kTooMany,       ///< the coordinator cannot remember more holds or zones
  kUnknownZone    ///< this client has no zone of this number that could be removed
};

/// The reason in words, for example "a goal is outside the field"; empty for kNone.
[[gnu::visibility("default")]] const char* text(Refusal refusal);

struct OrderState {
  OrderPhase phase = OrderPhase::kSent;
  Refusal refusal = Refusal::kNone;  ///< text() says it in words
  std::size_t goal_index = 0;        ///< index of the goal that the robot is driving to
  bool is_over = false;              ///< complete, replaced or refused; for zones: coordinators remember it

  bool operator==(const OrderState& other) const {
    return phase == other.phase && refusal == other.refusal && goal_index == other.goal_index &&
           is_over == other.is_over;
  }
};

/// A robot's progress with its current order.
enum class TaskState {
  kNone,     ///< no order
  kWaiting,  ///< the robot has not started yet
  kDriving,
  kBlocked,
  kArrived
};

struct Pose {
  double x_m = 0, y_m = 0, heading_rad = 0;
};

struct Robot {
  RobotId id = 0;
  bool is_heard = false;                ///< the robot's agent has reported within the last three seconds
  bool is_held = false;                 ///< held by any client
  bool has_own_order = false;           ///< the robot's order comes from this client
  TaskState task = TaskState::kNone;    ///< as last reported by the robot's agent
  std::size_t goal_index = 0;           ///< index of the goal that the robot is driving to
  std::optional<double> remaining_s{};  ///< estimated time to the last goal; nullopt: unknown
  std::optional<Pose> pose{};           ///< pose last seen by vision; nullopt: not within the last second

  /// Whether the robot can start an order immediately.
  bool is_free() const {
    return is_heard && !is_held && pose && (task == TaskState::kNone || task == TaskState::kArrived);
  }
};

/// Sends orders and tracks their state in its own thread. An order is repeated until a coordinator has
/// answered, and whenever all coordinators have forgotten it. Orders outlive the client: robots still carry
/// them out after it has exited.
///
/// All functions are thread-safe; those that send return immediately. An invalid order is refused; its state
/// says why.
class [[gnu::visibility("default")]] Client {
 public:
  /// Throws std::invalid_argument if a client other than an operator has no name, and std::runtime_error if
  /// DDS cannot use the domain or the interface.
  explicit Client(const Settings& settings);
  /// Must not be called from a callback or while another call is in progress.
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Sends a robot to up to 64 goals, one after another. Replaces the previous `go` from clients of the same
  /// rank (operators, or all other clients).
  OrderId go(RobotId robot, const std::vector<Goal>& goals);
  /// Cancels the robot's current order from clients of this rank. The robot continues with an order of
  /// another rank if it has one; otherwise it brakes and stays where it comes to rest.
  OrderId cancel(RobotId robot);
  /// Stops a robot until it is resumed. This is not a certified emergency stop: it takes effect when a
  /// coordinator receives it.
  OrderId hold(RobotId robot);
  OrderId hold_all();
  /// Ends this client's hold on the robot. An operator's resume ends every client's hold.
  OrderId resume(RobotId robot);
  OrderId resume_all();

  /// Sets this client's zone with this number, for all robots. Setting it again replaces the zone, so a zone
  /// can move. It remains in force after the client exits.
  OrderId set_zone(std::uint32_t number, const Zone& zone);
  /// Refused if coordinators do not remember such a zone of this client. Until one has told what it
  /// remembers, which takes about a second after the start, every removal is accepted.
  OrderId remove_zone(std::uint32_t number);

  /// nullopt if the order is unknown or forgotten. The client remembers the last 1000 orders that are over.
  std::optional<OrderState> state(OrderId order) const;
  /// Waits until the order is over or `timeout` has passed, and returns its state. Returns immediately if
  /// called from a callback.
  std::optional<OrderState> wait(OrderId order, std::chrono::nanoseconds timeout) const;
  /// All robots that an agent or vision has reported.
  std::vector<Robot> robots() const;
  /// Calls back in the client's thread whenever the state of an order has changed. The callback may call the
  /// client, and must not throw.
  void on_change(std::function<void(OrderId, const OrderState&)> callback);

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sidestep::client
