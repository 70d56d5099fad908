// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "common/messaging/sim/event_queue.hpp"
#include "common/messaging/sim/pool.hpp"
#include "common/messaging/sim/sim_links.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

class SimNetwork;

/// What the network has to know of one life of a process.
struct SimLife {
  ProcessId process = 0;
  bool is_alive = true;
  bool is_aside = false;
  Time paused_until = Time::min();
  std::size_t waiting = 0, most_waiting = 0;
};

/// One subscription of one life.
struct SimReader {
  SimLife* life;
  std::function<void(const void*)> callback;
  Time last_event{};  ///< arrival of the last event, to keep events in order
};

/// Where a simulated process runs.
struct SimPlace {
  ProcessId process = 0;     ///< links and their faults go by it
  Duration clock_offset{0};  ///< its clock against the network's time
};

/// One life of a simulated process, and its view of a SimNetwork. Destroying it is kill -9: its timers never
/// fire, nothing that is under way to it arrives; what it has sent does.
class SimBus : public Bus {
 public:
  /// A process of its own, that no link's fault concerns.
  explicit SimBus(SimNetwork& network);
  SimBus(SimNetwork& network, const SimPlace& place);
  ~SimBus() override;
  SimBus(const SimBus&) = delete;
  SimBus& operator=(const SimBus&) = delete;

  /// By the process's own clock.
  Time now() const override;
  void at(Time when, std::function<void()> callback) override;
  std::shared_ptr<void>* beside(const void* message) override;

  /// Hears everything at once and loses nothing: for judges, who are no part of the system.
  void listen_aside();
  /// SIGSTOP until a time of the network: no timer fires, messages pile up, `most_waiting` of them at most;
  /// the others are lost as when a socket's buffer is full. Then everything comes at once.
  void pause(Time until, std::size_t most_waiting);

 protected:
  std::unique_ptr<RawWriter> make_writer(const TopicInfo& topic, const std::string& channel) override;
  void make_reader(const TopicInfo& topic, const std::string& channel,
                   std::function<void(const void*)> callback) override;

 private:
  SimNetwork& network_;
  Duration clock_offset_;
  SimLife* life_;  // the network's, which keeps it when it has ended
  SimReader* timers_;
};

/// Many processes in one thread under virtual time: an event queue ordered by (time, order of scheduling),
/// and a network between the processes that delays, loses, duplicates and reorders from a seed. The same seed
/// gives the same run, bit for bit. Channels of kEvent are reliable and in order, as DDS makes them; they are
/// only delayed.
class SimNetwork {
 public:
  SimNetwork(std::uint64_t seed, Time begin, const NetworkSpec& network);

  Time now() const { return now_; }
  /// Runs the next event; false when there is none until `limit`, and then now() is the limit.
  bool step(Time limit);
  /// Runs everything until a time.
  void run_until(Time limit) {
    while (step(limit)) {
    }
  }

  /// A number for another process.
  ProcessId new_process() { return next_process_++; }
  /// From now on this link does this, instead of what the NetworkSpec says.
  void set_link(ProcessId from, ProcessId to, const LinkQuality& quality) { links_.set(from, to, quality); }

 private:
  friend class SimBus;
  class Writer;
  using Reader = SimReader;
  struct Sent {
    std::shared_ptr<const void> message;
    std::uint32_t under_way = 0;     ///< to so many readers, and one more while it is being sent
    std::shared_ptr<void> beside{};  ///< what readers have made of it
  };
  struct Event {
    Reader* reader;
    std::uint32_t content;  ///< in timers_ or sent_
    bool is_timer;          ///< then the reader only says whose it is
    bool may_be_lost;       ///< where a paused process's messages pile up
  };
  struct Channel {
    std::vector<Reader*> readers;
  };

  void run(const Event& event);
  /// What the event was to bring is of no use any more.
  void drop(const Event& event);
  void release(std::uint32_t sent);
  void hold_back(const Event& event);
  void send(ProcessId from, const TopicInfo& topic, Channel& channel, const void* message);
  void send_event(ProcessId from, Reader& reader, std::uint32_t sent);
  void deliver(Reader& reader, Time when, std::uint32_t sent, bool may_be_lost);
  Duration sample_delay();

  Rng rng_;
  Time now_;
  NetworkSpec spec_;
  SimLinks links_;
  ProcessId next_process_ = 0;
  EventQueue<Event> events_;
  Pool<std::function<void()>> timers_;
  Pool<Sent> sent_;
  std::optional<std::uint32_t> delivering_;  ///< in sent_
  std::deque<SimLife> lives_;
  std::deque<Reader> readers_;
  std::map<std::string, std::unique_ptr<Channel>> channels_;
};

}  // namespace sidestep
