// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <set>
#include <string>

#include "common/messaging/sim/sim_bus.hpp"

namespace sidestep {

/// A simulated process that can be stopped and continued (SIGSTOP, SIGCONT), and that can be cut off in one
/// direction or for some topics only.
class TroubledBus : public SimBus {
 public:
  using SimBus::SimBus;

  Time now() const override { return SimBus::now() + clock_ahead_; }
  void at(Time when, std::function<void()> callback) override;

  /// From now on the process's clock is ahead of the network's by so much.
  void set_clock_ahead(Duration ahead) { clock_ahead_ = ahead; }

  /// From now on nothing runs. What comes waits for the process.
  void stop() { is_stopped_ = true; }
  void go_on();
  /// Whether it hears anything; what comes meanwhile is lost.
  void set_deaf(bool is_deaf) { is_deaf_ = is_deaf; }
  /// Whether others hear it.
  void set_mute(bool is_mute) { is_mute_ = is_mute; }
  /// Loses all that comes on a topic.
  void set_deaf_to(const std::string& topic) { deaf_to_.insert(topic); }
  void hear_all() { deaf_to_.clear(); }

 protected:
  std::unique_ptr<RawWriter> make_writer(const TopicInfo& topic, const std::string& channel) override;
  void make_reader(const TopicInfo& topic, const std::string& channel,
                   std::function<void(const void*)> callback) override;

 private:
  void run(std::function<void()> work);

  Duration clock_ahead_{0};
  bool is_stopped_ = false, is_deaf_ = false, is_mute_ = false;
  std::set<std::string> deaf_to_;
  std::deque<std::function<void()>> waiting_;
};

}  // namespace sidestep
