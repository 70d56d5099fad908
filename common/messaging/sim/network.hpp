// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/attachment.hpp"
#include "common/messaging/sim/event_queue.hpp"
#include "common/messaging/sim/links.hpp"
#include "common/messaging/sim/pool.hpp"
#include "common/messaging/sim/reliable_stream.hpp"
#include "common/messaging/topics.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// The network's state of one process instance. A restarted process is a new instance of the same process.
struct SimProcessInstance {
  ProcessId process = 0;
  bool is_alive = true;
  bool is_observer = false;
  Time paused_until = Time::min();
  Reachability reachability{};  ///< limited by its pauses; see reachability_of()
  Time queued_until =
      Time::min();  ///< due time of queued events; before paused_until if a second pause prolonged the first
  std::size_t queued = 0, max_queued = 0;  ///< number of messages that wait for the end of the pause
  std::uint64_t lost = 0;                  ///< number of messages to this process that the network has lost
  std::uint64_t overflowed = 0;            ///< number of messages to this process that found its queue full
};

/// One subscription of one process instance. The instance's timers use a subscription without a callback.
struct SimSubscription {
  SimProcessInstance* instance;
  std::function<void(const void*)> callback;
  Time begin = Time::min();
  Time last_event{};  ///< arrival of the last kEvent message; keeps such messages in order
};

/// Runs many processes in one thread under virtual time: an event queue ordered by (time, order of
/// scheduling), and a network between the processes that delays, loses, duplicates and reorders messages. The
/// same seed gives the same run, bit for bit. Channels with Qos::kEvent are reliable and in order, as over
/// DDS: a writer resends lost messages, but only to readers that it knew at the time of writing, only while
/// its process lives, and only messages that its history still holds (README.md).
class SimNetwork {
 public:
  SimNetwork(std::uint64_t seed, Time begin, const NetworkSpec& network);

  Time now() const { return now_; }
  /// Runs the next event. If there is none before `limit`, advances now() to the limit and returns false.
  bool step(Time limit);
  /// Runs all events until `limit`.
  void run_until(Time limit) {
    while (step(limit)) {
    }
  }

  /// Allocates a new process id.
  ProcessId new_process() { return next_process_++; }
  /// From now on, `quality` replaces the NetworkSpec for this link.
  void set_link(ProcessId from, ProcessId to, const LinkQuality& quality) {
    links_.set(from, to, quality, now_);
  }

 private:
  friend class SimBus;
  class Writer;
  struct SentMessage {
    std::shared_ptr<const void> message;
    std::uint32_t references = 0;  ///< number of pending deliveries, plus one during sending
    MessageAttachment attachment{};
  };
  struct Event {
    SimSubscription* subscription;
    std::uint32_t index;  ///< index in timers_ or sent_
    bool is_timer;        ///< if true, the subscription only identifies the timer's instance
    bool is_droppable;    ///< counts towards max_queued of a paused process
  };
  struct Channel {
    std::vector<SimSubscription*> subscriptions;
  };

  void run(const Event& event);
  /// Discards an event whose process cannot receive it.
  void drop(const Event& event);
  void release(std::uint32_t sent);
  /// Postpones an event to the end of its process's pause.
  void postpone(const Event& event);
  void send(Writer& writer, const void* message);
  void send_event(Writer& writer, SimSubscription& subscription, std::uint32_t sent);
  /// Stores a message that did not arrive immediately, and drops messages beyond the writer's history.
  void keep(Writer& writer, const std::shared_ptr<ReliableStream>& stream, std::uint32_t sent,
            bool has_arrived);
  /// Resends lost messages if a heartbeat and the answer to it arrive.
  void heartbeat(Writer& writer, ReliableStream& stream);
  void schedule_heartbeat(Writer& writer, const std::shared_ptr<ReliableStream>& stream);
  void deliver_arrived(ReliableStream& stream, Duration delay);
  /// Updates and returns whether writer and reader know each other. If not, the waiting messages are lost.
  bool update_match(const Writer& writer, ReliableStream& stream);
  void discard_waiting(ReliableStream& stream);
  /// Whether a single datagram of a reliable message arrives.
  bool arrives(ProcessId from, ProcessId to);
  Duration event_delay(ProcessId from, ProcessId to, Rng& rng);
  void deliver_event(SimSubscription& subscription, Duration delay, std::uint32_t sent);
  static Reachability& reachability_of(SimProcessInstance& instance, Time now);
  void deliver(SimSubscription& subscription, Time when, std::uint32_t sent, bool is_droppable);
  Duration sample_delay(Rng& rng) const;

  Rng rng_;
  Rng reliable_rng_;  ///< separate, so reliable messages do not affect the losses of other messages
  const Time begin_;
  Time now_;
  NetworkSpec spec_;
  SimLinks links_;
  ProcessId next_process_ = 0;
  std::set<ProcessId> hidden_;  ///< processes hidden from observers
  EventQueue<Event> events_;
  Pool<std::function<void()>> timers_;
  Pool<SentMessage> sent_;
  std::optional<std::uint32_t> delivering_;  ///< index in sent_
  std::deque<SimProcessInstance> instances_;
  std::deque<SimSubscription> subscriptions_;
  std::map<std::string, std::unique_ptr<Channel>> channels_;
};

}  // namespace sidestep
