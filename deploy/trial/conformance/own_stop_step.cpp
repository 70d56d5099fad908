// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/format.h>

#include "deploy/trial/conformance/motion_examination.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

/// Reports a false position to the robot, as if it had been moved.
class OwnStopStep final : public ConformanceStep {
 public:
  std::string name() const override { return "own stop"; }

  bool update(ConformanceContext& context) override {
    RobotProbe& probe = context.probe;
    const RobotReport& robot_report = *probe.robot_report();
    const Time now = probe.now();
    if (!since_) {
      since_ = now;
      before_ = robot_report.executing.number;
      context.stream.stop();
      probe.fix_error_m = Vec2(0.3, 0);
    }
    if (!own_ && robot_report.is_off_reference && robot_report.executing.number != before_) {
      own_ = robot_report;
      took_ = now - *since_;
    }
    if (!own_ && now - *since_ < 2s) return false;
    // Reports the true position again, which is another displacement.
    probe.fix_error_m = Vec2(0, 0);
    if (now - *since_ < took_ + 2s) return false;
    context.stream.forget();
    constexpr VersionNumber kGap = VersionNumber{1} << 20;
    const VersionNumber highest = std::max(before_, probe.incarnation);
    const bool is_numbered = own_ && own_->executing.number >= highest + kGap;
    const bool is_resting = own_ && own_->executing.trajectory.residual_speed_mps() < 1e-5;
    context.report.rows.push_back(
        {"own stop", passed_if(is_numbered && is_resting),
         own_ ? fmt::format("{:.0f} ms after pose fixes showed it elsewhere; numbered {} above all others; "
                            "inflation {:.0f} mm",
                            to_seconds(took_) * 1e3, own_->executing.number - highest,
                            own_->executing.inflation_m * 1e3)
              : "no own stop, although pose fixes showed the robot 0.3 m off its reference"});
    return true;
  }

 private:
  std::optional<Time> since_;
  VersionNumber before_ = 0;
  std::optional<RobotReport> own_;
  Duration took_{0};
};

}  // namespace

std::unique_ptr<ConformanceStep> make_own_stop_step() { return std::make_unique<OwnStopStep>(); }

}  // namespace sidestep
