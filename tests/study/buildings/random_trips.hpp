// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "common/client/order_client.hpp"
#include "common/config/scenario.hpp"
#include "common/messaging/sim/bus.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// The outcome of all orders.
struct TripCounts {
  int orders = 0, reached = 0;
  int blocked = 0;  ///< orders given up after being reported as blocked, or blocked at the end
  int stuck = 0;    ///< orders neither completed nor reported as blocked in time
  double longest_s = 0;
};

/// A client that sends each robot to random places, one after another. The places are the starts and goals of
/// the scenario. Places of different robots never overlap.
class RandomTrips {
 public:
  /// Time after which an unfinished order that is not blocked is given up.
  static constexpr Duration kStuckAfter{180'000'000'000};

  /// `bus` must outlive this object.
  RandomTrips(Bus& bus, const Scenario& scenario, std::uint64_t seed);

  /// Tracks the orders, and sends robots without an order to their next places. Call it several times a
  /// second.
  void update(Time now);
  /// From now on, robots get no new orders.
  void finish() { is_finishing_ = true; }
  /// Whether all orders are over.
  bool is_over() const;
  /// The counts, in which unfinished orders count as blocked or stuck.
  TripCounts counts(Time now) const;

 private:
  struct Trip {
    std::optional<OrderHandle> order;  ///< nullopt: the robot pauses
    Vec2 place_m{0, 0};
    Time begun_at{}, next_at{};
    std::optional<Time> blocked_since{};
  };
  void follow(Trip& trip, Time now);
  void begin(RobotId robot, Trip& trip, Time now);
  void end(Trip& trip, Time now);

  OrderClient client_;
  Rng rng_;
  double separation_m_;  // minimum distance between places
  std::vector<Vec2> places_;
  std::map<RobotId, Trip> trips_;
  TripCounts counts_;
  bool is_finishing_ = false;
};

}  // namespace sidestep
