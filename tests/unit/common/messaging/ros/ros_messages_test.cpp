// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/ros/ros_messages.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::ros {

std::vector<std::uint8_t> bytes_of(const TopicInfo& topic, const void* message) {
  std::vector<std::uint8_t> bytes(topic.type.cdr_size(message));
  REQUIRE(topic.type.write_cdr(message, bytes) == bytes.size());
  return bytes;
}

Odometry random_odometry(Rng& rng) {
  Odometry message;
  message.sec = static_cast<std::int32_t>(rng.below(1u << 31));
  message.nanosec = static_cast<std::uint32_t>(rng.below(1'000'000'000));
  message.frame_id.assign(rng.below(20), 'f');
  message.child_frame_id.assign(rng.below(20), 'c');
  for (double& value : message.position) value = rng.uniform(-9.0, 9.0);
  for (double& value : message.orientation) value = rng.uniform(-1.0, 1.0);
  for (double& value : message.pose_covariance) value = rng.uniform(0.0, 1.0);
  for (double& value : message.twist.linear) value = rng.uniform(-2.0, 2.0);
  for (double& value : message.twist_covariance) value = rng.uniform(0.0, 1.0);
  return message;
}

TEST_CASE("an encoded twist has the same bytes as a twist written by ROS 2") {
  Twist twist;
  twist.linear = {1, -0.5, 0};
  twist.angular = {0, 0, 2};
  const std::vector<std::uint8_t> bytes = bytes_of(kTwist, &twist);
  REQUIRE(bytes.size() == 48);
  CHECK(std::vector<std::uint8_t>(bytes.begin(), bytes.begin() + 16) ==
        std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 0xf0, 0x3f, 0, 0, 0, 0, 0, 0, 0xe0, 0xbf});
  CHECK(bytes[47] == 0x40);
}

TEST_CASE("odometry survives encoding and decoding in both byte orders, and truncated odometry is refused") {
  Rng rng(3);
  for (int i = 0; i < 200; ++i) {
    const Odometry sent = random_odometry(rng);
    const std::vector<std::uint8_t> bytes = bytes_of(kOdometry, &sent);
    Odometry received;
    REQUIRE(kOdometry.type.read_cdr(bytes, ByteOrder::kLittleEndian, 0, &received));
    CHECK(received.sec == sent.sec);
    CHECK(received.frame_id == sent.frame_id);
    CHECK(received.child_frame_id == sent.child_frame_id);
    CHECK(received.orientation == sent.orientation);
    CHECK(received.twist.linear == sent.twist.linear);
    CHECK(received.twist_covariance == sent.twist_covariance);
    for (std::size_t size = 0; size + 4 < bytes.size(); size += 1 + rng.below(40))
      CHECK_FALSE(
          kOdometry.type.read_cdr(std::span(bytes).first(size), ByteOrder::kLittleEndian, 0, &received));
    std::vector<std::uint8_t> longer = bytes;
    longer.resize(bytes.size() + 8);
    CHECK_FALSE(kOdometry.type.read_cdr(longer, ByteOrder::kLittleEndian, 0, &received));
  }
  Twist twist;
  twist.linear = {1, 0, 0};
  std::vector<std::uint8_t> big = bytes_of(kTwist, &twist);
  for (std::size_t at = 0; at < big.size(); at += 8)
    std::reverse(big.begin() + static_cast<std::ptrdiff_t>(at),
                 big.begin() + static_cast<std::ptrdiff_t>(at) + 8);
  Twist received;
  REQUIRE(kTwist.type.read_cdr(big, ByteOrder::kBigEndian, 0, &received));
  CHECK(received.linear[0] == 1);
}

TEST_CASE("odometry that states wrong text lengths is refused") {
  Rng rng(4);
  const Odometry sent = random_odometry(rng);
  const std::vector<std::uint8_t> valid = bytes_of(kOdometry, &sent);
  for (int i = 0; i < 20'000; ++i) {
    std::vector<std::uint8_t> bytes = valid;
    for (std::uint64_t changes = 1 + rng.below(4); changes > 0; --changes)
      bytes[rng.below(bytes.size())] = static_cast<std::uint8_t>(rng.bits());
    if (rng.chance(0.5)) bytes.resize(rng.below(bytes.size()));
    Odometry received;
    if (kOdometry.type.read_cdr(bytes, ByteOrder::kLittleEndian, 0, &received))
      CHECK(received.frame_id.size() <= 256);
  }
  for (const std::uint32_t length : {0u, 1000u, 0x7fffffffu, 0xffffffffu}) {
    std::vector<std::uint8_t> bytes = valid;
    std::memcpy(bytes.data() + 8, &length, 4);
    Odometry received;
    CHECK_FALSE(kOdometry.type.read_cdr(bytes, ByteOrder::kLittleEndian, 0, &received));
  }
}

TEST_CASE("topics are named as ROS 2 names them over DDS") {
  CHECK(command_channel("robot", 3) == "rt/robot3/cmd_vel");
  CHECK(odometry_channel("tb", 12) == "rt/tb12/odom");
  CHECK(std::string(kTwist.type.name) == "geometry_msgs::msg::dds_::Twist_");
  CHECK(std::string(kOdometry.type.name) == "nav_msgs::msg::dds_::Odometry_");
}

}  // namespace sidestep::ros
