// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "agents/adapters/driver.hpp"

namespace sidestep {

/// A driver to start from. As it is, it drives ideal bases, which move exactly as commanded and report that.
class SkeletonDriver : public Driver {
 public:
  /// `now` is the process's clock.
  SkeletonDriver(const std::vector<RobotId>& robots, std::function<Time()> now);

  void send(std::span<const BaseCommand> commands) override;
  void on_odometry(std::function<void(const OdometryReport&)> callback) override;

  /// Where a base is, in its own frame: at the origin at first.
  const OdometryReport& base(RobotId robot) const;

 private:
  std::function<Time()> now_;
  std::function<void(const OdometryReport&)> callback_;
  std::vector<OdometryReport> bases_;
};

}  // namespace sidestep
