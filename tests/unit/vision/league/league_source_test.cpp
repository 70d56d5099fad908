// SPDX-License-Identifier: Apache-2.0
#include "vision/league/league_source.hpp"

#include <stdexcept>

#include "common/protocol/obstacle_bounds.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/league/random_packets.hpp"
#include "vision/tracking/frame.hpp"

namespace sidestep::league_source_test {

using std::chrono::milliseconds;

constexpr Time kNow = time_from_ns(1'700'000'000'000'000'000);
constexpr league::Endpoint kSender{0x7f000001, 5000}, kOther{0x7f000001, 5001};

Scenario two_teams() {
  Scenario scenario;
  for (const auto& [id, team] :
       {std::pair{RobotId{3}, Team::kBlue}, {RobotId{16}, Team::kYellow}, {RobotId{19}, Team::kYellow}}) {
    RobotSpec robot;
    robot.id = id;
    robot.team = team;
    scenario.robots.push_back(robot);
  }
  return scenario;
}

league::DetectedRobot robot(std::optional<std::uint32_t> number, const Vec2& position_m, double heading_rad) {
  league::DetectedRobot detected;
  detected.number = number;
  detected.position_m = position_m;
  detected.heading_rad = heading_rad;
  detected.confidence = 0.9;
  return detected;
}

league::DetectionFrame detection_at(Duration captured, std::uint32_t number) {
  league::DetectionFrame detection;
  detection.frame_number = number;
  detection.camera = 1;
  detection.captured = captured;
  detection.sent = captured + milliseconds(5);
  return detection;
}

std::vector<std::byte> datagram(const league::DetectionFrame& detection) {
  return encode(league::VisionPacket{detection, std::nullopt, std::nullopt});
}

/// Synchronises with the sender's clock, which shows `captured` five milliseconds before kNow.
void synchronise(LeagueSource& source, Duration captured, const league::Endpoint& from = kSender) {
  for (int ms = 200; ms >= 90; ms -= 10) {
    const auto number = static_cast<std::uint32_t>(100'000 + ms);
    (void)source.decode(datagram(detection_at(captured - milliseconds(ms), number)), from,
                        kNow - milliseconds(ms));
  }
}

constexpr Duration kCaptured = std::chrono::seconds(10);

TEST_CASE("robots of both teams are identified, and unknown robots become obstacles") {
  LeagueSource source(two_teams());
  synchronise(source, kCaptured);
  league::DetectionFrame detection = detection_at(kCaptured, 1);
  detection.yellow = {robot(0, {1, 2}, 0.5), robot(3, {-1, 2}, -0.5), robot(7, {2, 2}, 0)};
  detection.blue = {robot(3, {0, -1}, 3), robot(std::nullopt, {2, -2}, 0)};
  const auto* frame = source.decode(datagram(detection), kSender, kNow);
  REQUIRE(frame);
  CHECK(frame->camera() == 1);
  CHECK(frame->captured_at_ns() == Approx(to_ns(kNow - milliseconds(5))).margin(1000));
  REQUIRE(frame->robots().size() == 3);
  CHECK(frame->robots()[0].robot() == 16);
  CHECK(frame->robots()[1].robot() == 19);
  CHECK(frame->robots()[2].robot() == 3);
  CHECK(frame->robots()[2].x_m() == 0);
  CHECK(frame->robots()[2].y_m() == Approx(-1));
  CHECK(frame->robots()[2].heading_rad() == Approx(3));
  CHECK(frame->robots()[2].confidence() == Approx(0.9));
  REQUIRE(frame->obstacle_count() == 2);
  CHECK(frame->obstacles()[0].x_m() == Approx(2));
  CHECK(frame->obstacles()[0].y_m() == Approx(2));
  CHECK(frame->obstacles()[0].radius_m() == 0.09);
  CHECK(frame->obstacles()[1].y_m() == Approx(-2));
  CHECK(source.counts().dropped == 0);
}

TEST_CASE("a scenario in which two robots have the same team and number is refused") {
  Scenario scenario = two_teams();
  scenario.robots.push_back(scenario.robots.back());
  scenario.robots.back().id = 35;
  CHECK_THROWS_AS(LeagueSource(scenario), std::invalid_argument);
}

TEST_CASE("robots without a heading are dropped") {
  LeagueSource source(two_teams());
  synchronise(source, kCaptured);
  league::DetectionFrame detection = detection_at(kCaptured, 1);
  detection.blue = {robot(3, {0, 0}, 0)};
  detection.blue[0].heading_rad.reset();
  detection.yellow = {robot(0, {0, 0}, 0)};
  for (int i = 0; i < 63; ++i) detection.yellow.push_back(robot(std::nullopt, {0.02 * i, 0}, 0));
  const auto* frame = source.decode(datagram(detection), kSender, kNow);
  REQUIRE(frame);
  CHECK(frame->robots().size() == 1);
  CHECK(frame->obstacle_count() == 63);
  CHECK(frame->obstacles_complete_within_m() == kCompleteEverywhere_m);
  CHECK(source.counts().dropped == 1);
}

TEST_CASE("if there are too many balls, those with the highest confidence are kept") {
  LeagueSource source(two_teams());
  synchronise(source, kCaptured);
  league::DetectionFrame detection = detection_at(kCaptured, 1);
  for (const double confidence : {0.1, 0.9, 0.3, 0.8, 0.2, 0.7}) {
    league::DetectedBall ball;
    ball.position_m = {confidence, 0};
    ball.confidence = confidence;
    detection.balls.push_back(ball);
  }
  const auto* frame = source.decode(datagram(detection), kSender, kNow);
  REQUIRE(frame);
  REQUIRE(frame->ball_count() == 4);
  for (const auto& [index, x_m] : {std::pair{0u, 0.9}, {1u, 0.8}, {2u, 0.7}, {3u, 0.3}}) {
    CHECK(frame->balls()[index].x_m() == Approx(x_m));
  }
  CHECK(source.counts().dropped == 2);
}

TEST_CASE("two senders that are not listed are never mixed") {
  LeagueSource source(two_teams());
  synchronise(source, kCaptured);
  CHECK(source.decode(datagram(detection_at(kCaptured, 1)), kSender, kNow));
  const std::uint64_t refused = source.choice().refused_packets();
  league::VisionPacket packet{detection_at(kCaptured, 1), std::nullopt, std::nullopt};
  Rng rng(1);
  packet.geometry = league::test::random_geometry(rng);
  CHECK_FALSE(source.decode(encode(packet), kOther, kNow + milliseconds(1)));
  CHECK_FALSE(source.field());
  CHECK(source.choice().refused_packets() == refused + 1);
  CHECK(source.choice().refused() == kOther);
  CHECK(source.choice().used() == kSender);
  CHECK(source.detecting_sender() == kSender);
}

TEST_CASE("a duplicate frame is dropped, and each listed sender's clock is estimated separately") {
  LeagueSource source(two_teams(), {kSender, kOther});
  synchronise(source, kCaptured);
  synchronise(source, std::chrono::milliseconds(1'009'999), kOther);
  const std::uint64_t unsynchronised = source.counts().unsynchronised;
  const auto is_accepted = [&](const league::DetectionFrame& d, const league::Endpoint& from, Time now) {
    return source.decode(datagram(d), from, now) != nullptr;
  };
  CHECK(is_accepted(detection_at(kCaptured, 1), kSender, kNow));
  CHECK_FALSE(is_accepted(detection_at(kCaptured, 1), kSender, kNow + milliseconds(1)));
  CHECK(source.counts().duplicates == 1);
  // The other sender's clock is a thousand seconds ahead.
  CHECK(is_accepted(detection_at(std::chrono::seconds(1010), 1), kOther, kNow + milliseconds(1)));
  CHECK(is_accepted(detection_at(std::chrono::milliseconds(10'017), 2), kSender, kNow + milliseconds(17)));
  CHECK(source.counts().unsynchronised == unsynchronised);
  // A jump of a thousand seconds by the same sender is not accepted immediately.
  CHECK_FALSE(is_accepted(detection_at(std::chrono::seconds(1011), 3), kSender, kNow + milliseconds(18)));
  CHECK(source.counts().unsynchronised == unsynchronised + 1);
  CHECK(source.clock_jumps() == 0);
}

TEST_CASE("a restarted sender is accepted soon because it sends from another port") {
  LeagueSource source(two_teams());
  for (std::uint16_t incarnation = 0; incarnation < 40; ++incarnation) {
    int frames = 0;
    for (std::uint32_t i = 0; i < 10; ++i) {
      const Time now = kNow + std::chrono::seconds(incarnation) + milliseconds(17) * i;
      const auto* frame = source.decode(datagram(detection_at(milliseconds(100 + 17 * i), i)),
                                        {0x7f000001, static_cast<std::uint16_t>(6000 + incarnation)}, now);
      if (!frame) continue;
      REQUIRE(frame->captured_at_ns() == Approx(to_ns(now - milliseconds(5))).margin(1000));
      ++frames;
    }
    REQUIRE(frames == 4);
  }
}

TEST_CASE("frames of a simulator that has become slower are dropped until their times are known again") {
  LeagueSource source(two_teams());
  Time now = kNow;
  Duration simulated = -std::chrono::seconds(1);
  const auto run = [&](Duration duration, double rate) {
    int frames = 0, beyond = 0;
    for (const Time end = now + duration; now < end; ++frames) {
      now += from_seconds(1 / (60 * rate));
      simulated += from_seconds(1 / 60.0);
      league::DetectionFrame detection =
          detection_at(simulated, static_cast<std::uint32_t>(simulated / milliseconds(1)));
      detection.sent = simulated;
      if (const auto* frame = source.decode(datagram(detection), kSender, now))
        beyond += std::chrono::abs(time_from_ns(frame->captured_at_ns()) - now) > source.date_uncertainty();
    }
    CHECK(beyond == 0);
    return frames;
  };
  (void)run(std::chrono::seconds(3), 1);
  const std::uint64_t before = source.counts().unsynchronised;
  (void)run(std::chrono::seconds(1), 0.6);
  CHECK(source.counts().unsynchronised > before);
  const std::uint64_t known = source.counts().frames;
  const int frames = run(std::chrono::seconds(5), 0.6);
  CHECK(source.counts().frames == known + static_cast<std::uint64_t>(frames));
  REQUIRE(source.clock());
  CHECK(source.clock()->rate() == Approx(0.6).margin(0.01));
}

TEST_CASE("a geometry packet sets the field and gives no frame") {
  Rng rng(1);
  LeagueSource source(two_teams());
  league::VisionPacket packet;
  packet.geometry = league::test::random_geometry(rng);
  CHECK_FALSE(source.decode(encode(packet), kSender, kNow));
  REQUIRE(source.field());
  CHECK(source.field()->length_m == Approx(packet.geometry->field.length_m));
  CHECK(source.rejected() == 0);
}

TEST_CASE("corrupted and truncated packets give only valid frames") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u);
  CAPTURE(seed);
  Rng rng(seed);
  Scenario scenario = two_teams();
  LeagueSource source(scenario);
  std::uint64_t frames = 0, packets = 0;
  Frame frame;
  for (int i = 0; i < 5000; ++i) {
    const Time now = kNow + milliseconds(8) * i;
    league::VisionPacket packet = league::test::random_vision_packet(rng);
    if (packet.detection) {
      packet.detection->captured = milliseconds(8) * i;
      packet.detection->sent = milliseconds(8) * i + milliseconds(2);
    }
    auto bytes = encode(packet);
    for (std::uint64_t flips = rng.below(4); flips > 0; --flips) {
      bytes[rng.below(bytes.size())] ^= static_cast<std::byte>(1 << rng.below(8));
    }
    if (rng.chance(0.1)) bytes.resize(rng.below(bytes.size()));
    const auto* decoded = source.decode(bytes, kSender, now);
    ++packets;
    if (!decoded) continue;
    ++frames;
    frame.assign(*decoded, now);
    REQUIRE(frame.is_usable());
    REQUIRE(frame.rejected() == 0);
  }
  const LeagueSource::Counts& counts = source.counts();
  CHECK(counts.packets == packets);
  CHECK(counts.frames == frames);
  CHECK(frames > 1000);
  CHECK(source.rejected() > 100);
}

}  // namespace sidestep::league_source_test
