// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/messaging/sim/bus.hpp"
#include "deploy/trial/simulate/system/driven_bases.hpp"

namespace sidestep {

/// A bus that simulates defective robots by changing their commands.
class DefectiveBus : public SimBus {
 public:
  DefectiveBus(SimNetwork& network, std::function<void(msg::Command&)> defect)
      : SimBus(network), defect_(std::move(defect)) {}

 protected:
  void make_reader(const TopicInfo& topic, const std::string& channel,
                   std::function<void(const void*)> callback) override {
    if (!defect_ || topic.name != std::string("command"))
      return SimBus::make_reader(topic, channel, std::move(callback));
    SimBus::make_reader(topic, channel, [this, callback = std::move(callback)](const void* message) {
      msg::Command command = *static_cast<const msg::Command*>(message);
      defect_(command);
      callback(&command);
    });
  }

 private:
  std::function<void(msg::Command&)> defect_;
};

/// A floor of simulated bases and the process that drives them, on SimBus.
class DrivenFloor {
 public:
  DrivenFloor(SimNetwork& network, const Scenario& scenario, const BaseSettings& bases, Duration latency,
              std::uint64_t seed, std::function<void(msg::Command&)> defect = {})
      : DrivenFloor(network, scenario, bases, drive_settings(scenario, latency), seed, std::move(defect)) {}
  DrivenFloor(SimNetwork& network, const Scenario& scenario, const BaseSettings& bases,
              const DriveSettings& drive, std::uint64_t seed, std::function<void(msg::Command&)> defect = {})
      : floor_bus_(network),
        robots_bus_(network, std::move(defect)),
        bases_(floor_bus_, scenario, {.bases = bases}, 1, seed),
        driver_(bases_, scenario),
        robots_(robots_bus_, scenario, roster_of(scenario), 1, drive, driver_, memory_.path()) {}

  BaseWorld& world() { return bases_.world_now(); }
  RobotDriverNode& robots() { return robots_; }
  /// Stops the process that drives the robots, as if by SIGSTOP; commands are lost until then.
  void pause_robots(Time until) { robots_bus_.pause(until, 1000); }

 private:
  TemporaryFolder memory_;
  SimBus floor_bus_;
  DefectiveBus robots_bus_;
  VelocityRobotSimNode bases_;
  DirectDriver driver_;
  RobotDriverNode robots_;
};

}  // namespace sidestep
