// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <set>
#include <string>

#include "common/messaging/sim/bus.hpp"

namespace sidestep {

/// The bus of a simulated process that can be stopped and resumed (like SIGSTOP, SIGCONT), and cut off in one
/// direction or for single topics.
class FaultyBus : public SimBus {
 public:
  using SimBus::SimBus;

  Time now() const override { return SimBus::now() + clock_offset_; }
  void at(Time when, std::function<void()> callback) override;

  /// Sets how far the process's clock is ahead of the network's clock from now on.
  void set_clock_offset(Duration offset) { clock_offset_ = offset; }

  /// From now on no callback runs; timers and messages are queued.
  void stop() { is_stopped_ = true; }
  void resume();
  /// While blocked, all incoming messages are lost.
  void block_incoming(bool is_blocked) { blocks_incoming_ = is_blocked; }
  /// While blocked, all outgoing messages are lost.
  void block_outgoing(bool is_blocked) { blocks_outgoing_ = is_blocked; }
  /// From now on all incoming messages of a topic are lost.
  void block_topic(const std::string& topic) { blocked_topics_.insert(topic); }
  void unblock_topics() { blocked_topics_.clear(); }

 protected:
  std::unique_ptr<RawWriter> make_writer(const TopicInfo& topic, const std::string& channel) override;
  void make_reader(const TopicInfo& topic, const std::string& channel,
                   std::function<void(const void*)> callback) override;

 private:
  void run(std::function<void()> work);

  Duration clock_offset_{0};
  bool is_stopped_ = false, blocks_incoming_ = false, blocks_outgoing_ = false;
  std::set<std::string> blocked_topics_;
  std::deque<std::function<void()>> queue_;
};

}  // namespace sidestep
