// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <queue>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

class SimNetwork;

/// One simulated process's view of a SimNetwork. Destroying it is kill -9: its timers never fire, nothing
/// that is under way to it arrives; what it has sent does.
class SimBus : public Bus {
 public:
  explicit SimBus(SimNetwork& network);
  ~SimBus() override;
  SimBus(const SimBus&) = delete;
  SimBus& operator=(const SimBus&) = delete;

  Time now() const override;
  void at(Time when, std::function<void()> callback) override;

 protected:
  std::unique_ptr<RawWriter> make_writer(const TopicInfo& topic, const std::string& channel) override;
  void make_reader(const TopicInfo& topic, const std::string& channel,
                   std::function<void(const void*)> callback) override;

 private:
  SimNetwork& network_;
  std::shared_ptr<bool> alive_;
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

 private:
  friend class SimBus;
  class Writer;
  struct Reader {
    std::shared_ptr<bool> alive;
    std::function<void(const void*)> callback;
    Time last_event{};  ///< arrival of the last event, to keep events in order
  };
  struct Event {
    Time when;
    std::uint64_t order;
    std::shared_ptr<bool> alive;
    std::function<void()> run;
  };
  struct Later {
    bool operator()(const Event& a, const Event& b) const {
      return a.when != b.when ? a.when > b.when : a.order > b.order;
    }
  };
  struct Channel {
    std::vector<std::shared_ptr<Reader>> readers;
  };

  void schedule(Time when, const std::shared_ptr<bool>& alive, std::function<void()> run);
  void send(const TopicInfo& topic, Channel& channel, const void* message);
  void deliver(const std::shared_ptr<Reader>& reader, Time when, const std::shared_ptr<const void>& message);
  Duration draw_delay();

  Rng rng_;
  Time now_;
  NetworkSpec spec_;
  std::uint64_t order_ = 0;
  std::priority_queue<Event, std::vector<Event>, Later> events_;
  std::map<std::string, std::unique_ptr<Channel>> channels_;
};

}  // namespace sidestep
