// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>
#include <sstream>

#include "common/geometry/coordinate_bound.hpp"
#include "common/league/log_file.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/unit/common/league/random_packets.hpp"
#include "vision/league/sender_clock.hpp"

namespace sidestep::fuzz {
namespace {

enum Reader : unsigned { kVision, kTracked, kReferee, kCommands, kControl, kLog, kClock, kReaders };

bool is_within(const Vec2& v, double bound) { return std::abs(v.x()) <= bound && std::abs(v.y()) <= bound; }
bool is_probability(double p) { return p >= 0 && p <= 1; }

void check(const league::DetectedRobot& robot) {
  SIDESTEP_REQUIRE(is_within(robot.position_m, kMaxCoordinate_m));
  SIDESTEP_REQUIRE(is_probability(robot.confidence));
  SIDESTEP_REQUIRE(!robot.number || *robot.number < league::kRobotNumbers);
  SIDESTEP_REQUIRE(!robot.heading_rad || std::abs(*robot.heading_rad) <= 3.1416);
}

bool try_vision(std::span<const std::byte> bytes) {
  const auto decoded = league::decode_vision(bytes);
  SIDESTEP_REQUIRE(decoded.packet.has_value() == (decoded.error == league::DecodeError::kNone));
  if (!decoded.packet) return false;
  const league::VisionPacket& packet = *decoded.packet;
  SIDESTEP_REQUIRE(packet.detection || packet.geometry);
  if (packet.detection) {
    SIDESTEP_REQUIRE(packet.detection->camera < league::kMaxCameras);
    SIDESTEP_REQUIRE(packet.detection->captured >= -std::chrono::hours(1));
    for (const auto& robot : packet.detection->yellow) check(robot);
    for (const auto& robot : packet.detection->blue) check(robot);
    for (const auto& ball : packet.detection->balls) {
      SIDESTEP_REQUIRE(is_within(ball.position_m, kMaxCoordinate_m) && is_probability(ball.confidence));
    }
  }
  // An accepted packet must be accepted again after encoding, unless a time is at the end of its range.
  const auto again = league::decode_vision(encode(packet));
  SIDESTEP_REQUIRE(again.packet || again.error == league::DecodeError::kTime);
  if (!again.packet) return true;
  SIDESTEP_REQUIRE(again.packet->detection.has_value() == packet.detection.has_value());
  SIDESTEP_REQUIRE(again.packet->geometry.has_value() == packet.geometry.has_value());
  if (packet.detection)
    SIDESTEP_REQUIRE(again.packet->detection->blue.size() == packet.detection->blue.size());
  if (packet.geometry) {
    SIDESTEP_REQUIRE(again.packet->geometry->cameras.size() == packet.geometry->cameras.size());
  }
  return true;
}

bool try_tracked(std::span<const std::byte> bytes) {
  const auto decoded = league::decode_tracked(bytes);
  SIDESTEP_REQUIRE(decoded.packet.has_value() == (decoded.error == league::DecodeError::kNone));
  if (!decoded.packet) return false;
  if (decoded.packet->frame) {
    for (const auto& robot : decoded.packet->frame->robots) {
      SIDESTEP_REQUIRE(is_within(robot.position_m, kMaxCoordinate_m));
      SIDESTEP_REQUIRE(robot.number < league::kRobotNumbers);
      SIDESTEP_REQUIRE(std::abs(robot.heading_rad) <= 3.1416);
    }
  }
  const auto again = league::decode_tracked(encode(*decoded.packet));
  SIDESTEP_REQUIRE(again.packet || again.error == league::DecodeError::kTime);
  return true;
}

bool try_referee(std::span<const std::byte> bytes) {
  const auto decoded = league::decode_referee(bytes);
  SIDESTEP_REQUIRE(decoded.packet.has_value() == (decoded.error == league::DecodeError::kNone));
  if (!decoded.packet) return false;
  const league::RefereePacket& packet = *decoded.packet;
  SIDESTEP_REQUIRE(packet.sent >= Duration{0} && packet.commanded >= Duration{0});
  SIDESTEP_REQUIRE(!name_of(packet.command).empty());
  SIDESTEP_REQUIRE(!packet.designated_position_m ||
                   is_within(*packet.designated_position_m, kMaxCoordinate_m));
  const auto again = league::decode_referee(encode(packet));
  SIDESTEP_REQUIRE(again.packet || again.error == league::DecodeError::kNumber);
  SIDESTEP_REQUIRE(!again.packet || again.packet->command == packet.command);
  return true;
}

bool try_commands(std::span<const std::byte> bytes) {
  const auto response = league::decode_team_response(bytes);
  SIDESTEP_REQUIRE(response.packet.has_value() == (response.error == league::DecodeError::kNone));
  const auto decoded = league::decode_team_commands(bytes);
  SIDESTEP_REQUIRE(decoded.packet.has_value() == (decoded.error == league::DecodeError::kNone));
  if (!decoded.packet) return response.packet.has_value();
  for (const league::RobotCommand& robot : decoded.packet->robots) {
    SIDESTEP_REQUIRE(robot.number < league::kRobotNumbers);
    SIDESTEP_REQUIRE(!robot.move || is_within(robot.move->linear_mps, 100));
    SIDESTEP_REQUIRE(robot.kick_mps >= 0 && robot.kick_mps <= 100);
  }
  return true;
}

bool try_control(std::span<const std::byte> bytes) {
  const auto response = league::decode_simulator_response(bytes);
  SIDESTEP_REQUIRE(response.packet.has_value() == (response.error == league::DecodeError::kNone));
  const auto decoded = league::decode_simulator_command(bytes);
  SIDESTEP_REQUIRE(decoded.packet.has_value() == (decoded.error == league::DecodeError::kNone));
  if (!decoded.packet) return response.packet.has_value();
  for (const league::RobotTeleport& robot : decoded.packet->robots) {
    SIDESTEP_REQUIRE(robot.number < league::kRobotNumbers);
    SIDESTEP_REQUIRE(std::abs(robot.x_m.value_or(0)) <= kMaxCoordinate_m &&
                     std::abs(robot.heading_rad.value_or(0)) <= 3.1416);
  }
  return true;
}

std::size_t read_to_end(league::LogReader& reader) {
  league::LogRecord record;
  std::size_t bytes = 0;
  while (reader.next(record)) {
    SIDESTEP_REQUIRE(to_ns(record.received) >= 0);
    SIDESTEP_REQUIRE(record.bytes.size() <= league::kMaxDatagramSize);
    bytes += 16 + record.bytes.size();
  }
  SIDESTEP_REQUIRE(reader.status() != league::LogStatus::kReading);
  SIDESTEP_REQUIRE(reader.error().empty() == (reader.status() == league::LogStatus::kComplete));
  return bytes;
}

bool try_log(std::span<const std::byte> bytes) {
  std::string text(bytes.size(), '\0');
  if (!bytes.empty()) std::memcpy(text.data(), bytes.data(), bytes.size());
  try {
    league::LogReader reader(std::make_unique<std::istringstream>(text), "input");
    const std::size_t all = read_to_end(reader);
    SIDESTEP_REQUIRE(16 + all <= bytes.size());
    const bool has_record = reader.seek(std::chrono::seconds(1));
    league::LogRecord record;
    SIDESTEP_REQUIRE(reader.next(record) == has_record);
    SIDESTEP_REQUIRE(read_to_end(reader) <= all);
    return all > 0;
  } catch (const std::runtime_error&) {
    return false;  // the input is not a log, which is reported by an exception
  }
}

/// Takes capture times, sending times and the waits between frames from the input. Any values are valid.
bool try_clock(std::span<const std::byte> bytes) {
  constexpr std::uint64_t kMaxCapture_ns = 8'589'934'592'000'000'000;
  SenderClock clock;
  Time now = time_from_ns(1'700'000'000'000'000'000);
  struct Step {
    std::uint64_t captured_ns, sent_after_ns;
    std::uint32_t wait_us;
  };
  while (bytes.size() >= sizeof(Step)) {
    Step step{};
    std::memcpy(&step, bytes.data(), sizeof step);
    bytes = bytes.subspan(sizeof step);
    const Duration begin = -std::chrono::hours(1);
    const Duration captured = begin + Duration{static_cast<std::int64_t>(step.captured_ns % kMaxCapture_ns)};
    const Duration sent = begin + Duration{static_cast<std::int64_t>(step.sent_after_ns % kMaxCapture_ns)};
    now += std::chrono::microseconds(step.wait_us);
    const auto dated = clock.add(captured, sent, now);
    if (!dated) continue;
    SIDESTEP_REQUIRE(dated->captured_at <= now);
    SIDESTEP_REQUIRE(dated->captured_at >= now - SenderClock::kMaxAge);
    SIDESTEP_REQUIRE(dated->uncertainty.count() > 0);
  }
  return true;
}

}  // namespace

/// The first byte of an input selects the code under test: a reader of vision, tracker, referee, team or
/// simulator packets, the reader of log files, or the clock that converts frame times.
bool try_input(View input) {
  if (input.empty()) return false;
  const std::span<const std::byte> rest = std::as_bytes(input.subspan(1));
  switch (input[0] % kReaders) {
    case kVision:
      return try_vision(rest);
    case kTracked:
      return try_tracked(rest);
    case kReferee:
      return try_referee(rest);
    case kCommands:
      return try_commands(rest);
    case kControl:
      return try_control(rest);
    case kLog:
      return try_log(rest);
    default:
      return try_clock(rest);
  }
}

std::vector<Bytes> seeds() {
  Rng rng(1);
  std::vector<Bytes> seeds;
  const auto add = [&](Reader reader, const std::vector<std::byte>& bytes) {
    Bytes& seed = seeds.emplace_back(Bytes{static_cast<std::uint8_t>(reader)});
    for (const std::byte byte : bytes) seed.push_back(std::to_integer<std::uint8_t>(byte));
  };
  std::vector<std::byte> log;
  const auto append = [&](const std::string& text) {
    for (const char c : text) log.push_back(static_cast<std::byte>(c));
  };
  append(std::string("SSL_LOG_FILE\0\0\0\1", 16));
  for (int i = 0; i < 20; ++i) {
    const auto vision = encode(league::test::random_vision_packet(rng));
    add(kVision, vision);
    add(kTracked, encode(league::test::random_tracked_packet(rng)));
    add(kReferee, encode(league::test::random_referee_packet(rng)));
    add(kCommands, encode(league::test::random_team_commands(rng)));
    add(kControl, encode(league::test::random_simulator_command(rng)));
    if (i < 4) {
      const std::size_t size = vision.size();
      append(std::string("\0\0\0\0\x40\0\0\0\0\0\0\4\0\0", 14) + static_cast<char>(size >> 8) +
             static_cast<char>(size));
      log.insert(log.end(), vision.begin(), vision.end());
      add(kLog, log);
    }
    std::vector<std::byte> steps(800);
    for (std::byte& byte : steps) byte = static_cast<std::byte>(rng.chance(0.3) ? rng.bits() : 0);
    add(kClock, steps);
  }
  return seeds;
}

}  // namespace sidestep::fuzz
