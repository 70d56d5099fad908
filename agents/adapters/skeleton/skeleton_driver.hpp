// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "agents/adapters/driver.hpp"

namespace sidestep {

/// A template for new drivers. Unchanged, it drives ideal bases, which move exactly as commanded, without a
/// latency, and report their motion.
class SkeletonDriver : public Driver {
 public:
  /// `now` returns the process's time.
  SkeletonDriver(const std::vector<RobotId>& robots, std::function<Time()> now);

  void send(std::span<const BaseCommand> commands) override;
  void on_odometry(std::function<void(const OdometryReport&)> callback) override;

  /// The pose of a base in its odometry frame, initially the origin.
  const OdometryReport& base(RobotId robot) const;

 private:
  struct Base {
    OdometryReport odometry;
    BodyVelocity velocity;  ///< since the odometry's time
  };

  std::function<Time()> now_;
  std::function<void(const OdometryReport&)> callback_;
  std::vector<Base> bases_;
};

}  // namespace sidestep
