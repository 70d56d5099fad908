// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/conformance/conformance.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace sidestep {
namespace {

// How often a step is made until it can be judged: a busy computer may disturb one.
constexpr int kAttempts = 3;

}  // namespace

Conformance::Conformance(Bus& bus, const Scenario& scenario, RobotId robot, Incarnation incarnation,
                         ConformanceSettings settings)
    : bus_(bus),
      scenario_(scenario),
      settings_(std::move(settings)),
      probe_(bus, scenario_, robot, incarnation),
      stream_(probe_, scenario_),
      context_{scenario_, settings_, probe_, stream_, report_},
      steps_(conformance_steps(scenario_, settings_)),
      step_(steps_.front()()) {
  bus.at(bus.now(), [this] { cycle(); });
}

void Conformance::cycle() {
  if (is_finished()) return;
  if (step_->update(context_)) end_step();
  probe_.send_command();
  bus_.at(bus_.now() + scenario_.cycle, [this] { cycle(); });
}

void Conformance::end_step() {
  const std::span rows = std::span(report_.rows).subspan(before_step_.rows.size());
  // A robot that does not know when its motors respond would not be judged again.
  const bool is_repeated =
      !was_late_ && attempt_ < kAttempts &&
      std::ranges::find(rows, Conformity::kNotJudged, &ConformanceRow::conformity) != rows.end() &&
      std::ranges::find(rows, Conformity::kFailed, &ConformanceRow::conformity) == rows.end();
  probe_.reset_gap();
  if (is_repeated) {
    ++attempt_;
    report_ = before_step_;
    context_.is_late = was_late_;
    step_ = steps_[index_]();
    return;
  }
  const bool has_failed = !rows.empty() && rows.back().conformity != Conformity::kPassed;
  const bool is_last = step_->is_required() && has_failed;
  index_ = is_last ? steps_.size() : index_ + 1;
  if (!is_finished()) step_ = steps_[index_]();
  attempt_ = 1;
  before_step_ = report_;
  was_late_ = context_.is_late;
}

std::string Conformance::activity() const {
  if (is_finished()) return "";
  return step_->name() + (attempt_ > 1 ? ", again" : "");
}

}  // namespace sidestep
