// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/impairment.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace sidestep;

namespace {

constexpr Impairment::SenderId kAgent{1}, kVision{2};
constexpr int kMessages = 100'000;

msg::NetworkFault good_order() {
  msg::NetworkFault order;
  order.loss(0.1);
  order.mean_burst(4);
  order.duplicate(0.2);
  order.delay_min_ns(1'000'000);
  order.delay_mean_ns(3'000'000);
  order.delay_max_ns(50'000'000);
  return order;
}

}  // namespace

TEST_CASE("until it is told otherwise, every message arrives once and at once") {
  Impairment impairment;
  for (int i = 0; i < 100; ++i) {
    const Copies copies = impairment.receive(kAgent);
    REQUIRE(copies.count == 1);
    REQUIRE(copies.delays[0] == Duration{0});
  }
}

TEST_CASE("losses, bursts, copies and delays come in the proportions that were ordered") {
  const auto seed = GENERATE(range(std::uint64_t{1}, std::uint64_t{6}));
  CAPTURE(seed);
  Impairment impairment;
  const auto quality = link_quality_from(good_order());
  REQUIRE(quality);
  impairment.set(*quality, seed);
  int lost = 0, bursts = 0, copies_in_all = 0, late = 0;
  bool was_lost = false;
  double sum_s = 0;
  for (int i = 0; i < kMessages; ++i) {
    const Copies copies = impairment.receive(kAgent);
    const bool is_lost = copies.count == 0;
    lost += is_lost;
    bursts += is_lost && !was_lost;
    was_lost = is_lost;
    for (std::size_t k = 0; k < copies.count; ++k) {
      ++copies_in_all;
      REQUIRE(copies.delays[k] >= quality->delay_min);
      REQUIRE(copies.delays[k] <= quality->delay_max);
      late += copies.delays[k] > quality->delay_mean;
      sum_s += to_seconds(copies.delays[k]);
    }
  }
  CHECK(lost == Approx(0.1 * kMessages).epsilon(0.1));
  CHECK(static_cast<double>(lost) / bursts == Approx(4).epsilon(0.1));
  CHECK(copies_in_all == Approx(1.2 * (kMessages - lost)).epsilon(0.02));
  CHECK(sum_s / copies_in_all == Approx(to_seconds(quality->delay_mean)).epsilon(0.03));
  CHECK(late < 0.45 * copies_in_all);  // skewed to the right
}

TEST_CASE("each sender has bursts of its own, and the same seed means the same losses") {
  auto order = good_order();
  order.loss(0.5);
  order.mean_burst(50);
  Impairment one, two;
  one.set(*link_quality_from(order), 3);
  two.set(*link_quality_from(order), 3);
  int differ = 0;
  for (int i = 0; i < 1000; ++i) {
    const bool agents = one.receive(kAgent).count == 0, visions = one.receive(kVision).count == 0;
    REQUIRE((two.receive(kAgent).count == 0) == agents);
    REQUIRE((two.receive(kVision).count == 0) == visions);
    differ += agents != visions;
  }
  CHECK(differ > 100);
}

TEST_CASE("nothing arrives when the link is cut or everything is lost") {
  auto order = good_order();
  SECTION("cut") { order.is_cut(true); }
  SECTION("lost") { order.loss(1); }
  Impairment impairment;
  impairment.set(*link_quality_from(order), 1);
  for (int i = 0; i < 100; ++i) CHECK(impairment.receive(kAgent).count == 0);
}

TEST_CASE("orders that make no sense are refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](auto change) {
    auto order = good_order();
    change(order);
    return !link_quality_from(order);
  };
  CHECK_FALSE(refused([](auto&) {}));
  for (const double wrong : {-0.1, 1.1, nan, std::numeric_limits<double>::infinity()}) {
    CHECK(refused([&](auto& order) { order.loss(wrong); }));
    CHECK(refused([&](auto& order) { order.duplicate(wrong); }));
  }
  for (const double wrong : {0.0, 0.9, nan, 1e9})
    CHECK(refused([&](auto& order) { order.mean_burst(wrong); }));
  CHECK(refused([](auto& order) { order.delay_min_ns(-1); }));
  CHECK(refused([](auto& order) { order.delay_mean_ns(order.delay_min_ns() - 1); }));
  CHECK(refused([](auto& order) { order.delay_max_ns(order.delay_mean_ns() - 1); }));
  CHECK(refused([](auto& order) { order.delay_max_ns(std::numeric_limits<std::int64_t>::max()); }));
}
