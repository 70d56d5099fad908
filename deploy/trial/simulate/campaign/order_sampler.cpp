// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/order_sampler.hpp"

#include <algorithm>

#include "deploy/trial/simulate/campaign/position_sampler.hpp"

namespace sidestep {
namespace {

constexpr auto kFloorOperator = static_cast<ClientId>(Sender::kOperator);
constexpr auto kFirstClient = static_cast<ClientId>(Sender::kClient) + 1;
constexpr std::uint32_t kZones = 3;

class OrderSampler {
 public:
  OrderSampler(const Scenario& scenario, const FaultTimes& times, FaultPlan& plan, Rng& rng)
      : scenario_(scenario), times_(times), plan_(plan), rng_(rng), positions_(scenario, rng) {}

  void sample() {
    if (!rng_.chance(0.5)) return;
    if (rng_.chance(0.7)) repeat(8, [&] { sample_hold(); });
    if (rng_.chance(0.7)) repeat(6, [&] { sample_go(); });
    if (rng_.chance(0.3)) repeat(3, [&] { sample_zone(); });
    for (const ClientId client : {kFloorOperator, kFirstClient, kFirstClient + 1})
      add(plan_.healed_at - Duration{1}, {msg::OrderKind::ORDER_RESUME, kAllRobots, client});
  }

 private:
  template <typename Do>
  void repeat(std::uint64_t max_count, Do sample_one) {
    for (std::uint64_t left = 1 + rng_.below(max_count); left > 0; --left) sample_one();
  }
  void add(Duration at, Order order) { plan_.add(at, GiveOrder{std::move(order)}); }
  RobotId random_robot() { return scenario_.robots[rng_.below(scenario_.robots.size())].id; }
  ClientId random_client() {
    const double u = rng_.uniform();
    return u < 0.2 ? kFloorOperator : u < 0.6 ? kFirstClient : kFirstClient + 1;
  }

  /// Usually the client that gave the hold lifts it, sometimes an operator. Sometimes a client without
  /// permission tries to lift it.
  void sample_hold() {
    const ClientId client = random_client();
    const RobotId robot = rng_.chance(0.3) ? kAllRobots : random_robot();
    const Duration at = times_.sample(rng_);
    add(at, {msg::OrderKind::ORDER_HOLD, robot, client});
    const Duration end = times_.after(at, sample_log_uniform(0.5, 20, rng_));
    const double u = rng_.uniform();
    const ClientId lifts = u < 0.6 ? client : u < 0.8 ? kFloorOperator : random_client();
    const bool resumes_single_robot = robot == kAllRobots && rng_.chance(0.3);
    add(end, {msg::OrderKind::ORDER_RESUME, resumes_single_robot ? random_robot() : robot, lifts});
  }

  void sample_go() {
    Order order{msg::OrderKind::ORDER_GO, random_robot(), random_client()};
    order.goals.push_back({positions_.sample()});
    const Duration at = times_.sample(rng_);
    const Order cancel{msg::OrderKind::ORDER_CANCEL, order.robot, order.client};
    add(at, std::move(order));
    if (rng_.chance(0.3)) add(times_.after(at, sample_log_uniform(0.1, 10, rng_)), cancel);
  }

  void sample_zone() {
    Order order{msg::OrderKind::ORDER_ZONE, kAllRobots, random_client()};
    order.zone_number = static_cast<std::uint32_t>(rng_.below(kZones));
    order.zone.corners_m = {positions_.sample()};
    order.zone.radius_m = rng_.uniform(0.05, 0.4);
    if (rng_.chance(0.5)) order.zone.speed_limit_mps = rng_.uniform(0.1, 1);
    Order removal{msg::OrderKind::ORDER_REMOVE_ZONE, kAllRobots, order.client};
    removal.zone_number = order.zone_number;
    const Duration at = times_.sample(rng_);
    add(at, std::move(order));
    add(times_.after(at, sample_log_uniform(0.5, 20, rng_)), removal);
    add(plan_.healed_at - Duration{1}, std::move(removal));
  }

  const Scenario& scenario_;
  const FaultTimes& times_;
  FaultPlan& plan_;
  Rng& rng_;
  PositionSampler positions_;
};

}  // namespace

void sample_orders(const Scenario& scenario, const FaultTimes& times, FaultPlan& plan, Rng& rng) {
  OrderSampler(scenario, times, plan, rng).sample();
}

}  // namespace sidestep
