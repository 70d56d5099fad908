// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/messaging/topics.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Stands for a writer that a bus has made; publishing on it costs no look-up.
class RawWriter {
 public:
  virtual ~RawWriter() = default;
  virtual void write(const void* message) = 0;
};

template <typename Message>
class Writer {
 public:
  Writer() = default;
  explicit Writer(std::unique_ptr<RawWriter> raw) : raw_(std::move(raw)) {}

  /// Stamps the message and sends it: head.sender and head.incarnation are the caller's, number and stamp are
  /// set.
  void publish(Message& message, Time now) {
    message.head().message_number(++count_);
    message.head().stamp_ns(to_ns(now));
    raw_->write(&message);
  }
  std::uint64_t count() const { return count_; }

 private:
  std::unique_ptr<RawWriter> raw_;
  std::uint64_t count_ = 0;
};

/// What one process sees of the world outside: time, timers and messages. Everything a bus calls back, it
/// calls from one thread, one after the other; so the code above it needs no locks. Calls are made from
/// callbacks or before the bus runs.
class Bus {
 public:
  virtual ~Bus() = default;

  virtual Time now() const = 0;
  /// Calls back once, as soon as may be at or after the time.
  virtual void at(Time when, std::function<void()> callback) = 0;

  /// While a message is being delivered: where its readers in this process share what they make of it, which
  /// is kept as long as the message, empty at first; nullptr when nobody shares. A topic's readers agree
  /// about what it is.
  virtual std::shared_ptr<void>* beside(const void* message) {
    (void)message;
    return nullptr;
  }

  /// `robot` is for topics that every robot has one of (Topic::per_robot); it is ignored for the others.
  template <typename Message>
  Writer<Message> advertise(const Topic<Message>& topic, std::uint32_t robot = 0) {
    return Writer<Message>(make_writer(topic, channel_name(topic, robot)));
  }
  /// `callback` takes a const Message&.
  template <typename Message, typename Callback>
  void subscribe(const Topic<Message>& topic, std::uint32_t robot, Callback callback) {
    make_reader(topic, channel_name(topic, robot),
                [callback = std::move(callback)](const void* message) mutable {
                  callback(*static_cast<const Message*>(message));
                });
  }
  template <typename Message, typename Callback>
  void subscribe(const Topic<Message>& topic, Callback callback) {
    subscribe(topic, 0, std::move(callback));
  }

 protected:
  virtual std::unique_ptr<RawWriter> make_writer(const TopicInfo& topic, const std::string& channel) = 0;
  virtual void make_reader(const TopicInfo& topic, const std::string& channel,
                           std::function<void(const void*)> callback) = 0;
};

}  // namespace sidestep
