// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/impairment.hpp"

#include <limits>

#include "common/protocol/senders.hpp"
#include "tests/catch.hpp"

namespace sidestep::impairment_test {

constexpr Impairment::SenderId kAgent{1}, kVision{2};
constexpr int kMessages = 100'000;

msg::NetworkFault valid_fault() {
  msg::NetworkFault fault;
  fault.header().sender(static_cast<std::uint32_t>(Sender::kOperator));
  fault.loss(0.1);
  fault.mean_burst(4);
  fault.duplicate(0.2);
  fault.delay_min_ns(1'000'000);
  fault.delay_mean_ns(3'000'000);
  fault.delay_max_ns(50'000'000);
  return fault;
}

TEST_CASE("without a fault every message arrives once without delay") {
  Impairment impairment;
  for (int i = 0; i < 100; ++i) {
    const MessageCopies copies = impairment.receive(kAgent);
    REQUIRE(copies.count == 1);
    REQUIRE(copies.delays[0] == Duration{0});
  }
}

TEST_CASE("losses, bursts, duplicates and delays have the statistics that the fault specifies") {
  const auto seed = GENERATE(range(std::uint64_t{1}, std::uint64_t{6}));
  CAPTURE(seed);
  Impairment impairment;
  const auto quality = link_quality_from(valid_fault());
  REQUIRE(quality);
  impairment.set(*quality, seed);
  int lost = 0, bursts = 0, total_copies = 0, late = 0;
  bool was_lost = false;
  double sum_s = 0;
  for (int i = 0; i < kMessages; ++i) {
    const MessageCopies copies = impairment.receive(kAgent);
    const bool is_lost = copies.count == 0;
    lost += is_lost;
    bursts += is_lost && !was_lost;
    was_lost = is_lost;
    for (std::size_t k = 0; k < copies.count; ++k) {
      ++total_copies;
      REQUIRE(copies.delays[k] >= quality->delay_min);
      REQUIRE(copies.delays[k] <= quality->delay_max);
      late += copies.delays[k] > quality->delay_mean;
      sum_s += to_seconds(copies.delays[k]);
    }
  }
  CHECK(lost == Approx(0.1 * kMessages).epsilon(0.1));
  CHECK(static_cast<double>(lost) / bursts == Approx(4).epsilon(0.1));
  CHECK(total_copies == Approx(1.2 * (kMessages - lost)).epsilon(0.02));
  CHECK(sum_s / total_copies == Approx(to_seconds(quality->delay_mean)).epsilon(0.03));
  CHECK(late < 0.45 * total_copies);  // skewed to the right
}

TEST_CASE("each sender has its own loss bursts, and the same seed gives the same losses") {
  auto fault = valid_fault();
  fault.loss(0.5);
  fault.mean_burst(50);
  Impairment one, two;
  one.set(*link_quality_from(fault), 3);
  two.set(*link_quality_from(fault), 3);
  int differ = 0;
  for (int i = 0; i < 1000; ++i) {
    const bool agents = one.receive(kAgent).count == 0, visions = one.receive(kVision).count == 0;
    REQUIRE((two.receive(kAgent).count == 0) == agents);
    REQUIRE((two.receive(kVision).count == 0) == visions);
    differ += agents != visions;
  }
  CHECK(differ > 100);
}

TEST_CASE("no message arrives if the link is cut or the loss is 1") {
  auto fault = valid_fault();
  SECTION("the link is cut") { fault.is_cut(true); }
  SECTION("the loss is 1") { fault.loss(1); }
  Impairment impairment;
  impairment.set(*link_quality_from(fault), 1);
  for (int i = 0; i < 100; ++i) CHECK(impairment.receive(kAgent).count == 0);
}

TEST_CASE("faults with values out of range are refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](auto change) {
    auto fault = valid_fault();
    change(fault);
    return !link_quality_from(fault);
  };
  CHECK_FALSE(refused([](auto&) {}));
  for (const double wrong : {-0.1, 1.1, nan, std::numeric_limits<double>::infinity()}) {
    CHECK(refused([&](auto& fault) { fault.loss(wrong); }));
    CHECK(refused([&](auto& fault) { fault.duplicate(wrong); }));
  }
  for (const double wrong : {0.0, 0.9, nan, 1e9})
    CHECK(refused([&](auto& fault) { fault.mean_burst(wrong); }));
  CHECK(refused([](auto& fault) { fault.delay_min_ns(-1); }));
  CHECK(refused([](auto& fault) { fault.delay_mean_ns(fault.delay_min_ns() - 1); }));
  CHECK(refused([](auto& fault) { fault.delay_max_ns(fault.delay_mean_ns() - 1); }));
  CHECK(refused([](auto& fault) { fault.delay_max_ns(std::numeric_limits<std::int64_t>::max()); }));
}

}  // namespace sidestep::impairment_test
