// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "agents/adapters/driven_robot.hpp"
#include "agents/adapters/driver.hpp"
#include "agents/adapters/robot_memory.hpp"
#include "common/log/log_event.hpp"
#include "common/messaging/bus.hpp"
#include "common/messaging/counter_publisher.hpp"

namespace sidestep {

/// Runs the robots that a driver moves: receives their commands, drives them, and publishes their reports at
/// every change, and otherwise at most max_report_gap() apart. The bus must make no callback after the node's
/// destruction.
class RobotDriverNode {
 public:
  /// Precondition: `robots` belong to the scenario. Throws the same exceptions as RobotMemory.
  RobotDriverNode(Bus& bus, const Scenario& scenario, const std::vector<RobotId>& robots,
                  Incarnation incarnation, const DriveSettings& settings, Driver& driver,
                  const std::string& memory_folder);
  RobotDriverNode(const RobotDriverNode&) = delete;
  RobotDriverNode& operator=(const RobotDriverNode&) = delete;

  /// Sets a callback for events of level `min_level` or higher.
  void on_event(LogLevel min_level, OnLogEvent callback) {
    events_.set_listener(min_level, std::move(callback));
  }
  void count_drops(DropCounters& drops) const;
  /// Whether any robot obeys an agent.
  bool is_commanded() const;
  /// Accepts no more versions, so all robots come to rest at the ends of those that they have. From then on
  /// commands rest, for as long as bases may still move. Returns whether that has lasted long enough.
  [[nodiscard]] bool come_to_rest();
  /// The robots that still drive a version, or that fixes show in motion.
  std::vector<RobotId> moving_robots();
  const DrivenRobot& robot(std::size_t index) const { return *robots_[index].robot; }

 private:
  struct Entry {
    std::unique_ptr<RobotMemory> memory;
    std::unique_ptr<DrivenRobot> robot;
    Writer<msg::Feedback> robot_report;
    Time report_due{};
    Time watched_start{};  ///< the version start for which a timer is set
    // Values in the last published report.
    VersionNumber executing = 0;
    Incarnation incarnation = 0;
    Epoch epoch = 0;
    bool is_known = false;
    std::string memory_failure;  ///< the last reported failure to store the state; empty: none
  };
  Time clock();
  void tick();
  void on_command(Entry& entry, const msg::Command& message);
  void publish_if_changed(Entry& entry, Time now);
  void publish(Entry& entry, Time now);
  void watch_start(Entry& entry, Time now);
  void report_changes(Entry& entry);
  void report_memory(Entry& entry);

  Bus& bus_;
  Duration cycle_;
  Incarnation incarnation_;
  Driver& driver_;
  Time clock_;
  EventReporter events_;
  std::vector<Entry> robots_;
  std::unordered_map<RobotId, std::size_t> index_of_;
  std::vector<BaseCommand> commands_;
  Time next_tick_;
  Duration latency_;
  Duration max_stopping_time_;
  std::optional<Time> stopping_since_;     ///< no more versions are accepted
  std::optional<Time> stand_still_since_;  ///< all versions have ended, and only rest is commanded
  CounterPublisher counters_;
};

}  // namespace sidestep
