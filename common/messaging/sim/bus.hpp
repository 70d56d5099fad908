// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/messaging/bus.hpp"
#include "common/messaging/sim/network.hpp"
#include "common/time/clock_error.hpp"

namespace sidestep {

/// Identity and clock of a simulated process.
struct SimProcessSpec {
  ProcessId process = 0;  ///< identifies the process's links
  ClockError clock{};     ///< error relative to the network's time, which is true time
};

/// One instance of a simulated process, and its access to a SimNetwork. Its destruction simulates kill -9:
/// its timers never fire and messages in transit to it are lost; messages that it has sent still arrive.
class SimBus : public Bus {
 public:
  /// A new process, without link faults.
  explicit SimBus(SimNetwork& network);
  SimBus(SimNetwork& network, const SimProcessSpec& spec);
  ~SimBus() override;
  SimBus(const SimBus&) = delete;
  SimBus& operator=(const SimBus&) = delete;

  /// The time by the process's own clock.
  Time now() const override;
  void at(Time when, std::function<void()> callback) override;
  MessageAttachment* attachment(const void* message) override;

  /// From now on, receives all messages without delay or loss. Only for audit and metrics, which are not part
  /// of the system.
  void become_observer();
  /// From now on, observers receive nothing that this process sends. For hostile senders, because audit and
  /// metrics judge only the other processes.
  void hide_from_observers();
  /// Sets the process's clock. Timers keep their true times.
  void set_clock(const ClockError& clock) { clock_ = clock; }
  /// Simulates SIGSTOP until `until`, in network time: no timer fires, and up to `max_queued` messages are
  /// queued. Further messages are lost, like datagrams that find a full socket buffer. At the end, all queued
  /// messages and timers are delivered at the same time. A second pause can only prolong the first.
  void pause(Time until, std::size_t max_queued);

 protected:
  std::unique_ptr<RawWriter> make_writer(const TopicInfo& topic, const std::string& channel) override;
  void make_reader(const TopicInfo& topic, const std::string& channel,
                   std::function<void(const void*)> callback) override;
  void add_drops(DropCounters& drops) const override;

 private:
  SimNetwork::Channel& channel_named(const std::string& name);

  SimNetwork& network_;
  ClockError clock_;
  SimProcessInstance* instance_;  // owned by the network, which keeps it after the bus is destroyed
  SimSubscription* timers_;
};

}  // namespace sidestep
