// SPDX-License-Identifier: Apache-2.0
#include "tests/study/buildings/random_trips.hpp"

#include <algorithm>

namespace sidestep {
namespace {

/// Maximum of the random time that a robot stays at a goal.
constexpr Duration kMaxPause{3'000'000'000};
/// Time after which a goal that is reported as blocked is given up.
constexpr Duration kPatience{30'000'000'000};

// Separation of robots at their places, in addition to the margin.
constexpr double kExtraSeparation_m = 0.02;

}  // namespace

RandomTrips::RandomTrips(Bus& bus, const Scenario& scenario, std::uint64_t seed)
    : client_(bus, client_id("random trips")),
      rng_(seed),
      separation_m_(2 * scenario.radius_m + scenario.margin_m + kExtraSeparation_m) {
  for (const RobotSpec& robot : scenario.robots) {
    places_.push_back(robot.start_m);
    for (const Goal& goal : robot.goals) places_.push_back(goal.position_m);
    trips_[robot.id].place_m = robot.start_m;
  }
}

void RandomTrips::update(Time now) {
  for (auto& [robot, trip] : trips_) {
    if (trip.order)
      follow(trip, now);
    else if (!is_finishing_ && now >= trip.next_at)
      begin(robot, trip, now);
  }
}

void RandomTrips::begin(RobotId robot, Trip& trip, Time now) {
  std::vector<Vec2> free;
  for (const Vec2& place : places_) {
    if (std::ranges::all_of(trips_, [&](const auto& entry) {
          return (entry.second.place_m - place).norm() >= separation_m_;
        }))
      free.push_back(place);
  }
  if (free.empty()) return;
  trip.place_m = free[rng_.below(free.size())];
  trip.order = client_.go(robot, {{trip.place_m}});
  trip.begun_at = now;
  ++counts_.orders;
}

void RandomTrips::follow(Trip& trip, Time now) {
  const SentOrder* order = client_.find(*trip.order);
  if (order && order->phase == OrderPhase::kArrived) {
    ++counts_.reached;
    return end(trip, now);
  }
  if (!order || order->phase != OrderPhase::kBlocked)
    trip.blocked_since.reset();
  else if (!trip.blocked_since)
    trip.blocked_since = now;
  if (trip.blocked_since && now - *trip.blocked_since >= kPatience) {
    ++counts_.blocked;
    return end(trip, now);
  }
  if (!trip.blocked_since && now - trip.begun_at >= kStuckAfter) {
    ++counts_.stuck;
    end(trip, now);
  }
}

void RandomTrips::end(Trip& trip, Time now) {
  counts_.longest_s = std::max(counts_.longest_s, to_seconds(now - trip.begun_at));
  trip.order.reset();
  trip.blocked_since.reset();
  trip.next_at = now + from_seconds(rng_.uniform(0, to_seconds(kMaxPause)));
}

bool RandomTrips::is_over() const {
  return std::ranges::none_of(trips_, [](const auto& entry) { return entry.second.order.has_value(); });
}

TripCounts RandomTrips::counts(Time now) const {
  TripCounts counts = counts_;
  for (const auto& [robot, trip] : trips_) {
    if (!trip.order) continue;
    ++(trip.blocked_since ? counts.blocked : counts.stuck);
    counts.longest_s = std::max(counts.longest_s, to_seconds(now - trip.begun_at));
  }
  return counts;
}

}  // namespace sidestep
