// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/adapters/skeleton/skeleton_driver.hpp"
#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"

namespace sidestep {

/// Sees the ideal bases of a SkeletonDriver, so that they can be tried without cameras: the first camera of
/// the scenario sees all of them, without errors, and the others see an empty floor. Drivers of real bases
/// need no such class: vision gets their poses from cameras. The bus must make no callback after its
/// destruction.
class SkeletonCamera {
 public:
  /// The bases of `robots` start where the scenario says. `driver` must outlive the camera.
  SkeletonCamera(Bus& bus, const Scenario& scenario, const std::vector<RobotId>& robots,
                 const SkeletonDriver& driver, Incarnation incarnation);
  SkeletonCamera(const SkeletonCamera&) = delete;
  SkeletonCamera& operator=(const SkeletonCamera&) = delete;

 private:
  void capture();

  Bus& bus_;
  std::vector<RobotSpec> robots_;
  const SkeletonDriver& driver_;
  std::uint32_t cameras_;
  Duration period_;
  Time captured_at_;
  Incarnation incarnation_;
  Writer<msg::DetectionFrame> frames_;
};

}  // namespace sidestep
