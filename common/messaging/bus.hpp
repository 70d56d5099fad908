// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "common/messaging/attachment.hpp"
#include "common/messaging/single_writer_guard.hpp"
#include "common/messaging/topics.hpp"
#include "common/protocol/drop_counters.hpp"
#include "common/protocol/senders.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// A bus's writer for one channel, independent of the message's type.
class RawWriter {
 public:
  virtual ~RawWriter() = default;
  virtual void write(const void* message) = 0;
};

/// Publishes messages of one type on one channel.
template <typename Message>
class Writer {
 public:
  Writer() = default;
  Writer(std::unique_ptr<RawWriter> raw, std::uint64_t rules) : raw_(std::move(raw)), rules_(rules) {}

  /// Sets the header's rules, message_number and stamp_ns, and sends the message. The caller sets the other
  /// fields.
  void publish(Message& message, Time now) {
    message.header().rules(rules_);
    message.header().message_number(++count_);
    message.header().stamp_ns(to_ns(now));
    raw_->write(&message);
  }

 private:
  std::unique_ptr<RawWriter> raw_;
  std::uint64_t rules_ = 0;
  std::uint64_t count_ = 0;
};

/// A process's only interface to the outside: time, timers and messages. A bus makes all its callbacks in one
/// thread, one after another, so nodes need no locks. Nodes may call a bus from its callbacks, or before it
/// runs.
class Bus {
 public:
  virtual ~Bus() = default;

  virtual Time now() const = 0;
  /// Calls back once, as soon as possible at or after `when`.
  virtual void at(Time when, std::function<void()> callback) = 0;

  /// The attachment slot of the message being delivered, valid until the next call of the bus; null if the
  /// bus does not support attachments.
  virtual MessageAttachment* attachment(const void* message) {
    (void)message;
    return nullptr;
  }

  /// Whether this process's keys allow it to write, or read, a robot's channel of a topic; true without keys.
  /// If the keys forbid it, advertise() throws std::invalid_argument, and a subscription receives no
  /// messages.
  virtual bool may_write(const TopicInfo& topic, std::uint32_t robot) const {
    (void)topic;
    (void)robot;
    return true;
  }
  virtual bool may_read(const TopicInfo& topic, std::uint32_t robot) const {
    (void)topic;
    (void)robot;
    return true;
  }

  /// From now on, every new writer announces these rules (Header.rules), and messages from processes with
  /// different or no rules are refused on all topics with TopicInfo::is_checked: they are not passed to
  /// callbacks, but `on_refused` receives their topics and headers. Call it before the first advertise().
  void use_rules(std::uint64_t fingerprint,
                 std::function<void(const TopicInfo&, const msg::Header&)> on_refused) {
    rules_ = fingerprint;
    on_refused_ = std::move(on_refused);
  }

  /// From now on, `watcher` receives the topic and header of every message that a subscription receives.
  void watch_headers(std::function<void(const TopicInfo&, const msg::Header&)> watcher) {
    header_watcher_ = std::move(watcher);
  }

  /// From now on, `watcher` is called whenever a second process starts to write a single-writer channel
  /// (TopicInfo::is_single_writer). It receives the topic, the robot and the header of that process's
  /// message.
  void watch_conflicts(std::function<void(const TopicInfo&, std::uint32_t, const msg::Header&)> watcher) {
    conflict_watcher_ = std::move(watcher);
  }

  /// From now on, if two processes write a single-writer channel, only the messages of the process that was
  /// heard first are used. For observers of a simulation, in which the first process is the genuine one.
  void trust_first_senders() { trusts_first_sender_ = true; }

  /// From now on, new subscriptions to single-writer channels listen for a moment before they trust a writer.
  /// For a process that starts while other processes are running.
  void listen_before_trusting() { listening_ = SingleWriterGuard::kListening; }

  /// Counts an item dropped by this process outside its node.
  void count_drop(DropReason reason) { drops_.count(reason); }
  /// Adds the drops of this bus, and of this process outside its node.
  void count_drops(DropCounters& drops) const {
    drops.add(drops_);
    add_drops(drops);
  }

  /// `robot` selects the channel of a topic with one channel per robot (TopicInfo::per_robot); other topics
  /// ignore it.
  template <typename Message>
  Writer<Message> advertise(const Topic<Message>& topic, std::uint32_t robot = 0) {
    return Writer<Message>(make_writer(topic, channel_name(topic, robot)), rules_);
  }
  /// Creates a writer that leaves message headers unchanged, for example for messages of a recording.
  std::unique_ptr<RawWriter> relay(const TopicInfo& topic, const std::string& channel) {
    return make_writer(topic, channel);
  }
  /// Subscribes to messages without our headers. `callback` takes a const Message& of the topic's type.
  template <typename Message, typename Callback>
  void observe_channel(const TopicInfo& topic, const std::string& channel, Callback callback) {
    make_reader(topic, channel, [callback = std::move(callback)](const void* message) mutable {
      callback(*static_cast<const Message*>(message));
    });
  }
  /// `callback` takes a const Message&. Messages whose sender may not write the topic are not passed to it.
  template <typename Message, typename Callback>
  void subscribe(const Topic<Message>& topic, std::uint32_t robot, Callback callback) {
    observe(topic, robot,
            [this, robot, info = TopicInfo(topic), sender = SingleWriterGuard(listening_),
             callback = std::move(callback)](const Message& message) mutable {
              if (!may_be_from(info, message.header())) return;
              if (!has_same_rules(info, message.header())) return;
              if (info.is_single_writer && !admit(sender, info, robot, message.header())) return;
              if (header_watcher_) header_watcher_(info, message.header());
              callback(message);
            });
  }
  template <typename Message, typename Callback>
  void subscribe(const Topic<Message>& topic, Callback callback) {
    subscribe(topic, 0, std::move(callback));
  }
  /// Like subscribe(), but refuses no message. For recordings.
  template <typename Message, typename Callback>
  void observe(const Topic<Message>& topic, std::uint32_t robot, Callback callback) {
    observe_channel<Message>(topic, channel_name(topic, robot), std::move(callback));
  }

 protected:
  virtual std::unique_ptr<RawWriter> make_writer(const TopicInfo& topic, const std::string& channel) = 0;
  virtual void make_reader(const TopicInfo& topic, const std::string& channel,
                           std::function<void(const void*)> callback) = 0;
  /// Adds the drops counted by the bus itself.
  virtual void add_drops(DropCounters& drops) const { (void)drops; }

 private:
  bool may_be_from(const TopicInfo& topic, const msg::Header& header) {
    if (topic.writers.overlaps(roles_of(header.sender()))) return true;
    count_drop(DropReason::kForgedSender);
    return false;
  }

  bool has_same_rules(const TopicInfo& topic, const msg::Header& header) {
    if (!on_refused_ || !topic.is_checked || header.rules() == rules_) return true;
    count_drop(DropReason::kOtherRules);
    on_refused_(topic, header);
    return false;
  }

  bool admit(SingleWriterGuard& sender, const TopicInfo& topic, std::uint32_t robot,
             const msg::Header& header) {
    const SingleWriterGuard::Outcome outcome = sender.receive(header.incarnation(), now());
    if (outcome == SingleWriterGuard::Outcome::kCounts) return true;
    if (trusts_first_sender_ && sender.is_first(header.incarnation())) return true;
    count_drop(DropReason::kContestedSender);
    if (outcome == SingleWriterGuard::Outcome::kNewConflict && conflict_watcher_)
      conflict_watcher_(topic, robot, header);
    return false;
  }

  std::uint64_t rules_ = 0;
  bool trusts_first_sender_ = false;
  Duration listening_{0};
  std::function<void(const TopicInfo&, const msg::Header&)> on_refused_, header_watcher_;
  std::function<void(const TopicInfo&, std::uint32_t, const msg::Header&)> conflict_watcher_;
  DropCounters drops_;
};

/// Calls back once per period until the bus stops. Anything that the callback refers to must outlive the bus.
template <typename Callback>
void call_periodically(Bus& bus, Duration period, Callback callback) {
  bus.at(bus.now() + period, [&bus, period, callback] {
    callback();
    call_periodically(bus, period, callback);
  });
}

}  // namespace sidestep
