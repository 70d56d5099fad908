// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <list>
#include <optional>

#include "common/messaging/bus.hpp"
#include "idl/disturbance.hpp"

namespace sidestep {

/// Sends disturbances of robots as the operator, and reports whether the simulator has applied them. Repeats
/// each until it is answered; the simulator applies it once.
class DisturbanceClient {
 public:
  static constexpr Duration kRepetitionPeriod = std::chrono::milliseconds(500);
  /// A disturbance that is not answered within this time is given up.
  static constexpr Duration kTimeout = std::chrono::seconds(5);

  /// nullopt: no simulator has answered.
  using OnResult = std::function<void(const std::optional<msg::DisturbanceResult>&)>;

  /// `bus` receives the answers; `writer` sends disturbances and leaves their headers unchanged. Both must
  /// outlive this object, and the bus must make no callback after its destruction.
  DisturbanceClient(Bus& bus, RawWriter& writer);
  DisturbanceClient(const DisturbanceClient&) = delete;
  DisturbanceClient& operator=(const DisturbanceClient&) = delete;

  /// Sends a disturbance, whose header is set here. Calls back once, later.
  void send(msg::Disturbance disturbance, OnResult on_result);
  /// Stops waiting for answers: calls back with nullopt for each disturbance that is not answered yet.
  void give_up();

 private:
  struct Sent {
    msg::Disturbance disturbance;
    Time sent_at;
    OnResult on_result;
  };

  void repeat();
  void on_answer(const msg::DisturbanceAnswer& answer);
  /// Calls back for these disturbances, which must no longer be in sent_, because callbacks may send others.
  static void report(std::list<Sent>& finished, const std::optional<msg::DisturbanceResult>& result);

  Bus& bus_;
  RawWriter& writer_;
  Time begun_;
  std::uint64_t count_ = 0;
  std::list<Sent> sent_;
};

}  // namespace sidestep
