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

/// Tells the robots of a running Sidestep where to go. This header is installed, so it includes only the
/// standard library.
namespace sidestep::client {

struct Settings {
  std::string name;                     ///< of this program; clients of different names have their own holds
  bool is_operator = false;             ///< its orders come before all others, and its resume ends all holds
  int domain = 0;                       ///< DDS domain of the run, 0 .. 232
  std::string interface = "127.0.0.1";  ///< address of the network interface to use, or "all"
  /// Addresses of the hosts of all processes, on networks without multicast; empty: multicast.
  std::vector<std::string> peers{};
  /// Folder with this program's keys ("client NAME" or "operator"), or one that `sidestep keys init` has
  /// made; empty: no keys.
  std::string keys{};
  bool insecure = false;  ///< may work without keys on networks that other machines can reach
};

/// Robots are numbered from 0, as in the scenario.
using RobotId = std::uint32_t;
/// Identifies an order for the client that has given it.
using OrderId = std::uint64_t;

struct Goal {
  double x_m = 0, y_m = 0;
  std::optional<double> heading_rad{};      ///< nullopt: any
  std::optional<double> speed_limit_mps{};  ///< on the way there; nullopt: that of the robots
  std::optional<double> tolerance_m{};      ///< distance that counts as arrival; nullopt: the scenario's
};

struct Point {
  double x_m = 0, y_m = 0;
};

/// A part of the floor: the convex hull of up to 16 corners, extended by a radius.
struct Zone {
  std::vector<Point> corners;
  double radius_m = 0;
  std::optional<double> speed_limit_mps{};  ///< nullopt: robots keep out
};

/// What has become of an order.
enum class OrderPhase {
  kSent,      ///< no coordinator has answered yet; the order is repeated until one does
  kAccepted,  ///< a coordinator and another process remember it; all orders but those to go are complete
  kDriving,
  kBlocked,   ///< the goal cannot be reached now; the robot goes as near as it can, and on when it can
  kArrived,   ///< at the last goal
  kReplaced,  ///< by a later order
  kRefused
};

/// Why an order was refused.
enum class Refusal {
  kNone,
  kMalformed,     ///< no goal or corner, or too many, or a number that is out of bounds or not a number
  kUnknownRobot,  ///< the scenario has no such robot
  kOutsideField,  ///< a goal
  kTooMany        ///< the coordinator cannot remember more holds or zones
};

struct OrderState {
  OrderPhase phase = OrderPhase::kSent;
  Refusal refusal = Refusal::kNone;
  std::size_t goal_index = 0;  ///< of the goal that the robot drives to
  bool is_over = false;        ///< complete, replaced or refused; of zones, coordinators remember it now

  bool operator==(const OrderState& other) const {
    return phase == other.phase && refusal == other.refusal && goal_index == other.goal_index &&
           is_over == other.is_over;
  }
};

/// What a robot does with the order that it carries out.
enum class Task {
  kNone,     ///< no order
  kWaiting,  ///< has not begun
  kDriving,
  kBlocked,
  kArrived
};

struct Pose {
  double x_m = 0, y_m = 0, heading_rad = 0;
};

struct Robot {
  RobotId id = 0;
  bool is_heard = false;                ///< its agent has reported within the last three seconds
  bool is_held = false;                 ///< by any client
  bool has_own_order = false;           ///< this client has given the order
  Task task = Task::kNone;              ///< as its agent has reported last
  std::size_t goal_index = 0;           ///< of the goal that it drives to
  std::optional<double> remaining_s{};  ///< estimate until the last goal; nullopt: unknown
  std::optional<Pose> pose{};           ///< as vision has seen it last; nullopt: not within the last second

  /// Whether it can begin an order at once.
  bool is_free() const {
    return is_heard && !is_held && pose && (task == Task::kNone || task == Task::kArrived);
  }
};

/// Sends orders, and follows what becomes of them, in a thread of its own. An order is repeated until a
/// coordinator has answered, and whenever all coordinators have forgotten it. Orders outlive the client:
/// robots carry them out also when it has ended.
///
/// All functions may be called by any thread; those that send return at once. An order that is wrong is
/// refused, which its state shows.
class [[gnu::visibility("default")]] Client {
 public:
  /// Throws std::invalid_argument without a name (an operator needs none), and std::runtime_error if DDS
  /// cannot use the domain or the interface.
  explicit Client(const Settings& settings);
  /// Not from a callback. No other call may be in progress.
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Sends a robot to up to 64 goals, one after another, instead of what this rank of client has ordered it
  /// before.
  OrderId go(RobotId robot, const std::vector<Goal>& goals);
  /// Ends what this rank of client has ordered the robot. It goes on with an order of another rank, if there
  /// is one, else it brakes and stays where it comes to rest.
  OrderId cancel(RobotId robot);
  /// Stops a robot until it is resumed. This is not a certified emergency stop: it takes effect when a
  /// coordinator hears it.
  OrderId hold(RobotId robot);
  OrderId hold_all();
  /// Ends this client's hold of the robot; an operator ends those of all clients.
  OrderId resume(RobotId robot);
  OrderId resume_all();

  /// Sets this client's zone of this number, for all robots; an earlier one is replaced, so a zone can move.
  /// It stays when the client ends.
  OrderId set_zone(std::uint32_t number, const Zone& zone);
  OrderId remove_zone(std::uint32_t number);

  /// nullopt: unknown, or over and so are 1000 later ones.
  std::optional<OrderState> state(OrderId order) const;
  /// Waits until the order is over, and returns its state at the end or after `timeout`. In a callback it
  /// does not wait.
  std::optional<OrderState> wait(OrderId order, std::chrono::nanoseconds timeout) const;
  /// All robots of which an agent or vision has been heard.
  std::vector<Robot> robots() const;
  /// Calls back in the client's thread whenever the state of an order has changed. The callback may call the
  /// client, and must not throw.
  void on_change(std::function<void(OrderId, const OrderState&)> callback);

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sidestep::client
