// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/client/order_client.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/run/order/robot_watch.hpp"

namespace sidestep {

/// The options of the commands that give orders.
struct OrderOptions {
  DdsSettings dds;
  std::string client;  ///< empty: acts as the operator
  RobotId robot = 0;
  std::vector<std::string> goals;
  std::string file;
  double speed_limit_mps = 0, tolerance_m = 0;
  std::uint32_t zone = 0;
  std::vector<std::string> corners;
  double radius_m = 0;
  bool removes = false;
  bool waits = false;
  std::optional<double> timeout_s;  ///< nullopt: waits for any time
  bool once = false;
};

/// The client in whose name the command acts.
[[nodiscard]] ClientId client_of(const OrderOptions& options);
/// Settings with the client's identity, because a client sends with its own keys.
[[nodiscard]] DdsSettings dds_of(const OrderOptions& options);

/// Sends the orders of a command, and prints what becomes of them.
class OrderSession {
 public:
  /// The options must outlive this object. Throws as DdsBus does.
  explicit OrderSession(const OrderOptions& options);

  OrderClient& client() { return client_; }

  /// Waits until these orders are accepted or, with `waits`, over. While it waits for robots that do not
  /// drive, it says what hinders them. Returns the exit code.
  int finish(const std::vector<OrderHandle>& handles);

  /// Like finish(), for a resume; also says which of its robots others still hold.
  int finish_resume(OrderHandle handle);

  /// Listens until a coordinator's memory lists this zone of the client; then, or if no coordinator tells its
  /// memory, returns nullopt. Returns the zones in force as soon as the memory of the coordinator that grants
  /// lacks the zone.
  std::optional<std::vector<Order>> zones_without(std::uint32_t number);

 private:
  /// What was printed about the hindrances of an order's robot, and what would be printed now.
  struct Shown {
    std::string printed, latest;
    Time latest_since{};
  };
  template <typename Condition>
  bool are_all(Condition condition) const;
  /// Whether nothing remains to be waited for.
  bool is_done() const;
  void stop_if_done();
  void on_change(const SentOrder& sent);
  /// Prints the hindrances that have changed and then lasted for a moment.
  void print_hindrances();
  void print_remaining_holds(const SentOrder& resume) const;
  /// Says which orders are not over, and that they stay in force.
  void print_timeout() const;
  /// What becomes of the orders that were accepted and are not over; empty if there are none.
  std::string open_text() const;
  std::string unconfirmed_text() const;

  const OrderOptions& options_;
  DdsBus bus_;
  std::atomic<bool> is_interrupted_{false};  // set by a signal handler
  StopSignals stop_signals_;
  OrderClient client_;
  std::optional<RobotWatch> watch_;  // only for finish() that waits for robots
  std::vector<OrderHandle> handles_;
  std::map<OrderHandle, Shown> shown_;
  bool names_holders_ = false;                // finish() also waits until the holds in force are known
  std::optional<std::uint32_t> coordinator_;  // the one that grants
};

}  // namespace sidestep
