// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/laser_scan_decoder.hpp"

#include <cmath>
#include <limits>

#include "common/messaging/topics.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::laser_scan_decoder_test {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr RobotId kRobot = 3;
const Time kNow = time_from_ns(1'700'000'000'000'000'000);
const LaserSettings kLaser{8, 2, 0.1, 6};

msg::LaserScan valid_scan() {
  msg::LaserScan scan;
  scan.robot(kRobot);
  scan.header().sender(kRobot);
  scan.captured_at_ns(to_ns(kNow));
  scan.x_m(1), scan.y_m(-2), scan.heading_rad(0.5);
  scan.field_of_view_rad(2), scan.min_range_m(0.1), scan.max_range_m(6);
  scan.ranges_m() = {1, 2, kInfinity, -kInfinity, static_cast<float>(kNan), 3, 4, 5};
  return scan;
}

TEST_CASE("a scan is decoded unchanged, including beams that hit nothing, end too near or are lost") {
  LaserScanDecoder decoder(kRobot, kLaser);
  const msg::LaserScan message = valid_scan();
  const auto scan = decoder.decode(message, kNow);
  REQUIRE(scan);
  CHECK(scan->at_m == Vec2(1, -2));
  CHECK(scan->heading_rad == 0.5);
  CHECK(scan->captured_at == kNow);
  REQUIRE(scan->ranges_m.size() == 8);
  CHECK(scan->ranges_m[1] == 2);
  CHECK(scan->ranges_m[2] == kInfinity);
  CHECK(scan->ranges_m[3] == -kInfinity);
  CHECK(std::isnan(scan->ranges_m[4]));
}

TEST_CASE("scans from another robot or laser, at an invalid time, or without a valid pose are refused") {
  LaserScanDecoder decoder(kRobot, kLaser);
  const auto accepts = [&](auto spoil) {
    msg::LaserScan scan = valid_scan();
    spoil(scan);
    return decoder.decode(scan, kNow).has_value();
  };
  using Scan = msg::LaserScan;
  CHECK(accepts([](Scan&) {}));
  CHECK_FALSE(accepts([](Scan& s) { s.robot(4); }));
  CHECK_FALSE(accepts([](Scan& s) { s.header().sender(4); }));
  CHECK_FALSE(accepts([](Scan& s) { s.ranges_m().pop_back(); }));
  CHECK_FALSE(accepts([](Scan& s) { s.ranges_m().push_back(1); }));
  CHECK_FALSE(accepts([](Scan& s) { s.field_of_view_rad(2.1); }));
  CHECK_FALSE(accepts([](Scan& s) { s.min_range_m(0); }));
  CHECK_FALSE(accepts([](Scan& s) { s.max_range_m(60); }));
  for (const double bad : {kNan, 1e5, -1e5, std::numeric_limits<double>::infinity()}) {
    CHECK_FALSE(accepts([=](Scan& s) { s.x_m(bad); }));
    CHECK_FALSE(accepts([=](Scan& s) { s.y_m(bad); }));
  }
  CHECK_FALSE(accepts([](Scan& s) { s.heading_rad(kNan); }));
  CHECK_FALSE(accepts([](Scan& s) { s.captured_at_ns(std::numeric_limits<std::int64_t>::max()); }));
  CHECK_FALSE(accepts([](Scan& s) { s.captured_at_ns(std::numeric_limits<std::int64_t>::min()); }));
}

TEST_CASE("a scan with random bytes is unreadable, refused or within bounds") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  LaserScanDecoder decoder(kRobot, kLaser);
  const msg::LaserScan original = valid_scan();
  std::vector<std::uint8_t> bytes;
  append_cdr(topics::kScan, &original, bytes);
  int readable = 0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::uint8_t> hostile = bytes;
    for (std::uint64_t n = 1 + rng.below(4); n > 0; --n)
      hostile[rng.below(hostile.size())] = static_cast<std::uint8_t>(rng.below(256));
    (void)read_cdr(topics::kScan, hostile, [&](const void* message) {
      ++readable;
      const auto scan = decoder.decode(*static_cast<const msg::LaserScan*>(message), kNow);
      if (!scan) return;
      CHECK(scan->at_m.allFinite());
      CHECK(scan->ranges_m.size() == 8);
    });
  }
  CHECK(readable > 100);
}

}  // namespace sidestep::laser_scan_decoder_test
