// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "deploy/trial/conformance/conformance_step.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

constexpr Duration kRestTime = 1500ms;

class RestStep final : public ConformanceStep {
 public:
  std::string name() const override { return "rest"; }

  bool update(ConformanceContext& context) override {
    const Time now = context.probe.now();
    if (!since_) {
      since_ = now;
      context.probe.on_sample([this](const MotionSample& sample) { seen_m_.push_back(sample.seen_m); });
    }
    if (now - *since_ < kRestTime) return false;
    context.probe.on_sample(nullptr);
    if (seen_m_.size() < 5) {
      context.report.rows.push_back(
          {"vision", Conformity::kNotJudged, fmt::format("{} observations at rest", seen_m_.size())});
      return true;
    }
    Vec2 mean(0, 0), square(0, 0);
    for (const Vec2& p : seen_m_) mean += p / static_cast<double>(seen_m_.size());
    for (const Vec2& p : seen_m_) square += (p - mean).cwiseAbs2() / static_cast<double>(seen_m_.size());
    context.vision_noise_m = std::sqrt(square.maxCoeff());
    const double rate_hz = static_cast<double>(seen_m_.size()) / to_seconds(now - *since_);
    context.report.rows.push_back({"vision", Conformity::kPassed,
                                   fmt::format("{:.0f} observations a second, {:.2f} mm of noise", rate_hz,
                                               context.vision_noise_m * 1e3)});
    return true;
  }

 private:
  std::optional<Time> since_;
  std::vector<Vec2> seen_m_;
};

}  // namespace

std::unique_ptr<ConformanceStep> make_rest_step() { return std::make_unique<RestStep>(); }

}  // namespace sidestep
