// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/ros/ros_messages.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <type_traits>

namespace sidestep::ros {
namespace {

// Maximum length of an accepted frame name.
constexpr std::size_t kMaxName = 256;

/// Counts the bytes of a message's members in the order of its definition, as plain CDR.
class Counter {
 public:
  template <typename Number>
  void number(const Number&) {
    align(sizeof(Number));
    size_ += sizeof(Number);
  }
  void text(const std::string& value) {
    number(std::uint32_t{});
    size_ += value.size() + 1;
  }
  std::size_t size() const { return size_; }

 private:
  void align(std::size_t to) { size_ = (size_ + to - 1) / to * to; }
  std::size_t size_ = 0;
};

class Writer {
 public:
  explicit Writer(std::span<std::uint8_t> bytes) : bytes_(bytes) {}
  template <typename Number>
  void number(const Number& value) {
    align(sizeof(Number));
    std::memcpy(bytes_.data() + at_, &value, sizeof value);  // this machine is also little-endian
    at_ += sizeof value;
  }
  void text(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size() + 1));
    std::memcpy(bytes_.data() + at_, value.c_str(), value.size() + 1);
    at_ += value.size() + 1;
  }
  std::size_t size() const { return at_; }

 private:
  void align(std::size_t to) {
    for (; at_ % to != 0; ++at_) bytes_[at_] = 0;
  }
  std::span<std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

/// Reads untrusted bytes. After an error, all further values are zero.
class Reader {
 public:
  Reader(std::span<const std::uint8_t> bytes, ByteOrder order) : bytes_(bytes), order_(order) {}
  template <typename Number>
  void number(Number& value) {
    value = {};
    at_ = (at_ + sizeof(Number) - 1) / sizeof(Number) * sizeof(Number);
    if (!has(sizeof(Number))) return;
    std::array<std::uint8_t, sizeof(Number)> copy{};
    std::memcpy(copy.data(), bytes_.data() + at_, copy.size());
    if (order_ == ByteOrder::kBigEndian) std::reverse(copy.begin(), copy.end());
    std::memcpy(&value, copy.data(), copy.size());
    at_ += copy.size();
  }
  void text(std::string& value) {
    value.clear();
    std::uint32_t size = 0;
    number(size);
    if (size == 0 || size > kMaxName + 1 || !has(size) || bytes_[at_ + size - 1] != 0) {
      is_valid_ = false;
      return;
    }
    value.assign(reinterpret_cast<const char*>(bytes_.data() + at_), size - 1);
    at_ += size;
  }
  /// Whether all bytes except padding were read without error.
  bool is_complete() const { return is_valid_ && bytes_.size() - at_ <= 3; }

 private:
  bool has(std::size_t size) {
    is_valid_ = is_valid_ && at_ <= bytes_.size() && bytes_.size() - at_ >= size;
    return is_valid_;
  }
  std::span<const std::uint8_t> bytes_;
  ByteOrder order_;
  std::size_t at_ = 0;
  bool is_valid_ = true;
};

template <typename Coder, typename Numbers>
void numbers(Coder& coder, Numbers& values) {
  for (auto& value : values) coder.number(value);
}

/// Visits the members in the order of the definition. `Message` is const unless the coder reads.
template <typename Coder, typename Message>
void visit(Coder& coder, Message& m) {
  if constexpr (std::is_same_v<std::remove_const_t<Message>, Twist>) {
    numbers(coder, m.linear);
    numbers(coder, m.angular);
  } else {
    coder.number(m.sec);
    coder.number(m.nanosec);
    coder.text(m.frame_id);
    coder.text(m.child_frame_id);
    numbers(coder, m.position);
    numbers(coder, m.orientation);
    numbers(coder, m.pose_covariance);
    visit(coder, m.twist);
    numbers(coder, m.twist_covariance);
  }
}

template <typename Message>
std::size_t size_of(const void* message) {
  Counter counter;
  visit(counter, *static_cast<const Message*>(message));
  return counter.size();
}

template <typename Message>
std::size_t write_message(const void* message, std::span<std::uint8_t> bytes) {
  if (size_of<Message>(message) > bytes.size()) return 0;
  Writer writer(bytes);
  visit(writer, *static_cast<const Message*>(message));
  return writer.size();
}

template <typename Message>
bool read_message(std::span<const std::uint8_t> bytes, ByteOrder order, std::size_t, void* message) {
  Reader reader(bytes, order);
  visit(reader, *static_cast<Message*>(message));
  return reader.is_complete();
}

template <typename Message>
MessageType type_of(const char* name) {
  const auto make = [] { return std::shared_ptr<void>(std::make_shared<Message>()); };
  const auto copy = [](const void* m) -> std::shared_ptr<const void> {
    return std::make_shared<const Message>(*static_cast<const Message*>(m));
  };
  return {
      name, 0, make, copy, size_of<Message>, write_message<Message>, nullptr, nullptr, read_message<Message>};
}

std::string channel(const std::string& prefix, std::uint32_t robot, const char* topic) {
  return fmt::format("rt/{}{}/{}", prefix, robot, topic);
}

}  // namespace

std::string command_channel(const std::string& prefix, std::uint32_t robot) {
  return channel(prefix, robot, "cmd_vel");
}

std::string odometry_channel(const std::string& prefix, std::uint32_t robot) {
  return channel(prefix, robot, "odom");
}

const TopicInfo kTwist{"cmd_vel",
                       Role::kRobot,
                       Role::kSimulator,
                       Qos::kState,
                       false,
                       false,
                       type_of<Twist>("geometry_msgs::msg::dds_::Twist_")};
const TopicInfo kOdometry{"odom",
                          Role::kSimulator,
                          Role::kRobot,
                          Qos::kState,
                          false,
                          false,
                          type_of<Odometry>("nav_msgs::msg::dds_::Odometry_")};

TopicInfo reliable(TopicInfo topic) {
  topic.qos = Qos::kEvent;
  return topic;
}

}  // namespace sidestep::ros
