// SPDX-License-Identifier: Apache-2.0
// Steps that test the rules about reports, clocks, fences and versions while the robot rests.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <limits>

#include "common/messaging/robot_codec.hpp"
#include "common/messaging/version_codec.hpp"
#include "deploy/trial/conformance/conformance_step.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

constexpr Duration kReadyTimeout = 15s, kAnswerTimeout = 1s;
// After a version's start, a report of it arrives within this time.
constexpr Duration kReportTime = 100ms;
// Pause between the robot's refusal and the next attempt.
constexpr Duration kPause = 50ms;

double ms(Duration duration) { return to_seconds(duration) * 1e3; }

/// A version that accelerates gently from rest, and stops within a centimetre.
Trajectory nudge(const State& from, Time start) {
  Trajectory trajectory(start, from);
  trajectory.append(100ms, Vec2(0.5, 0));
  append_stop(trajectory, 1);
  return trajectory;
}

class ReportsStep final : public ConformanceStep {
 public:
  std::string name() const override { return "reports"; }
  bool is_required() const override { return true; }

  bool update(ConformanceContext& context) override {
    RobotProbe& probe = context.probe;
    const Time now = probe.now();
    if (!since_) since_ = now;
    const auto& robot_report = probe.robot_report();
    const bool is_fenced = robot_report && robot_report->obeyed_incarnation == probe.incarnation &&
                           robot_report->obeyed_epoch == probe.epoch;
    if (!heard_since_ && is_fenced) {
      heard_since_ = now;
      first_report_count_ = probe.report_count();
      probe.reset_gap();
    }
    if (!heard_since_) {
      if (now - *since_ < kReadyTimeout) return false;
      context.report.rows.push_back({"reports", Conformity::kFailed, silence(probe)});
      return true;
    }
    if (now - *heard_since_ < 2s) return false;
    const double rate_hz =
        static_cast<double>(probe.report_count() - first_report_count_) / to_seconds(now - *heard_since_);
    const Duration bound = probe.max_gap();
    const bool is_healthy = probe.malformed_reports() == 0 && !robot_report->is_lifted;
    const bool is_on_time = probe.longest_gap() <= bound;
    std::string figures = fmt::format(
        "{:.0f} reports a second, at most {:.1f} ms apart of {:.1f} ms; {} malformed; lead {:.0f} ms",
        rate_hz, ms(probe.longest_gap()), ms(bound), probe.malformed_reports(), ms(robot_report->lead));
    Conformity conformity = passed_if(is_healthy && is_on_time);
    if (is_healthy && !is_on_time && probe.longest_gap_at_robot() <= bound) {
      conformity = Conformity::kNotJudged;
      figures += fmt::format(
          "; the robot made them at most {:.1f} ms apart: the network or this computer is too busy",
          ms(probe.longest_gap_at_robot()));
    }
    context.report.rows.push_back({"reports", conformity, figures});
    return true;
  }

 private:
  static std::string silence(const RobotProbe& probe) {
    if (!probe.seen()) return fmt::format("vision does not see robot {}", probe.robot());
    if (probe.malformed_reports() > 0)
      return fmt::format("only malformed reports, {} so far", probe.malformed_reports());
    if (!probe.robot_report()) return fmt::format("no report from robot {}", probe.robot());
    return "the robot does not acknowledge a new agent and epoch; does another agent drive it?";
  }
  std::optional<Time> since_, heard_since_;
  std::uint64_t first_report_count_ = 0;
};

class ClockStep final : public ConformanceStep {
 public:
  std::string name() const override { return "clock"; }

  bool update(ConformanceContext& context) override {
    const Time now = context.probe.now();
    if (!since_) since_ = now;
    if (now - *since_ < 2s) return false;
    const Duration bound = from_seconds(context.scenario.clock_bound_s);
    const auto offset = context.probe.clock_offset();
    if (!offset) {
      context.report.rows.push_back({"clock", Conformity::kFailed, "the robot's reports echo no command"});
      return true;
    }
    const bool is_known = offset->uncertainty() <= bound;
    const Conformity conformity = offset->is_beyond(bound) ? Conformity::kFailed
                                  : is_known               ? Conformity::kPassed
                                                           : Conformity::kNotJudged;
    context.report.rows.push_back({"clock", conformity,
                                   fmt::format("{:+.2f} ms ahead, within {:.2f} ms; bound {:g} ms",
                                               ms(offset->middle()), ms(offset->uncertainty()), ms(bound))});
    const double largest_s = std::max(std::abs(to_seconds(offset->low)), std::abs(to_seconds(offset->high)));
    context.report.figures.clock_bound_s =
        std::max(context.scenario.clock_bound_s, std::ceil(1.5e4 * largest_s) * 1e-4);
    return true;
  }

 private:
  std::optional<Time> since_;
};

/// Sends commands that the robot must refuse, one at a time, and waits for reports that would show obedience.
class RefusalStep : public ConformanceStep {
 public:
  struct Attempt {
    std::string rule;
    std::string what;
    /// Corrupts a command whose version the robot would otherwise execute.
    std::function<void(msg::Command&, const ConformanceContext&)> spoil;
  };
  RefusalStep(std::string name, std::vector<Attempt> attempts)
      : name_(std::move(name)), attempts_(std::move(attempts)) {}

  std::string name() const override { return name_; }

  bool update(ConformanceContext& context) override {
    RobotProbe& probe = context.probe;
    const RobotReport& robot_report = *probe.robot_report();
    if (!sent_) {
      sent_ = next_version(context);
      before_ = robot_report;
    }
    if (probe.robot_now() < sent_->trajectory.start()) {
      // Each command is sent in at least two cycles, as an agent repeats its commands.
      msg::Command message = command(context);
      attempts_[index_].spoil(message, context);
      probe.send(message);
      return false;
    }
    if (robot_report.valid_at < sent_->trajectory.start() + kReportTime) return false;
    const bool is_refused = robot_report.executing.number == before_.executing.number &&
                            robot_report.obeyed_incarnation == before_.obeyed_incarnation &&
                            robot_report.obeyed_epoch == before_.obeyed_epoch;
    if (!is_refused) obeyed_.push_back(attempts_[index_].what);
    if (robot_report.executing.number != before_.executing.number) context.stream.forget();
    sent_.reset();
    const std::string& rule = attempts_[index_].rule;
    ++tried_;
    const bool is_last_of_rule = index_ + 1 == attempts_.size() || attempts_[index_ + 1].rule != rule;
    if (is_last_of_rule) add_row(context, rule);
    return ++index_ == attempts_.size();
  }

 private:
  Version next_version(const ConformanceContext& context) const {
    const Version& base = context.probe.robot_report()->executing;
    const Time start = context.probe.robot_now() + context.stream.notice() + kPause;
    return context.stream.next(nudge(base.trajectory.state_at(start), start));
  }
  msg::Command command(const ConformanceContext& context) const {
    Command command;
    command.robot = context.probe.robot();
    command.incarnation = context.probe.incarnation;
    command.epoch = context.probe.epoch;
    command.version = sent_;
    return encode(command);
  }
  void add_row(ConformanceContext& context, const std::string& rule) {
    std::string figures = fmt::format("{} of {} refused", tried_ - obeyed_.size(), tried_);
    for (const std::string& what : obeyed_) figures += "; obeyed: " + what;
    context.report.rows.push_back({rule, passed_if(obeyed_.empty()), figures});
    tried_ = 0;
    obeyed_.clear();
  }

  std::string name_;
  std::vector<Attempt> attempts_;
  std::size_t index_ = 0, tried_ = 0;
  std::optional<Version> sent_;
  RobotReport before_;
  std::vector<std::string> obeyed_;
};

/// Sends commands of a new agent and in a new epoch, before the step that checks the refusal of the old ones.
class FenceStep final : public ConformanceStep {
 public:
  std::string name() const override { return "fences"; }

  bool update(ConformanceContext& context) override {
    RobotProbe& probe = context.probe;
    if (!since_) {
      since_ = probe.now();
      probe.incarnation += 1000;
      probe.epoch += 1000;
    }
    const RobotReport& robot_report = *probe.robot_report();
    const bool is_fenced =
        robot_report.obeyed_incarnation == probe.incarnation && robot_report.obeyed_epoch == probe.epoch;
    if (!is_fenced && probe.now() - *since_ < kAnswerTimeout) return false;
    context.report.rows.push_back(
        {"new agent and epoch", passed_if(is_fenced),
         is_fenced ? fmt::format("acknowledged after {:.0f} ms", ms(probe.now() - *since_))
                   : "not acknowledged"});
    return true;
  }

 private:
  std::optional<Time> since_;
};

class SwitchStep final : public ConformanceStep {
 public:
  std::string name() const override { return "switch"; }

  bool update(ConformanceContext& context) override {
    RobotProbe& probe = context.probe;
    const RobotReport& robot_report = *probe.robot_report();
    if (!sent_) {
      const Time start = probe.robot_now() + context.stream.notice() + kPause;
      sent_ = context.stream.next(nudge(robot_report.executing.trajectory.state_at(start), start));
      probe.version = sent_;
      return false;
    }
    if (robot_report.executing.number == sent_->number && !seen_) seen_ = probe.robot_report();
    const bool is_early = seen_ && seen_->valid_at < sent_->trajectory.start();
    if (!seen_ && robot_report.valid_at < sent_->trajectory.start() + kAnswerTimeout) return false;
    if (seen_ && robot_report.valid_at < sent_->trajectory.end()) return false;
    probe.version.reset();
    if (!seen_) {
      std::string figures = "the robot did not execute a version that was sent in time";
      const Conformity conformity = unless_busy(false, probe, figures);
      context.report.rows.push_back({"switches", conformity, figures});
      return true;
    }
    context.stream.forget();
    const bool is_same = encode(seen_->executing) == encode(*sent_);
    const Duration late = seen_->valid_at - sent_->trajectory.start();
    std::string figures = fmt::format("reported {:.1f} ms after the start, contents {}", ms(late),
                                      is_same ? "bit for bit" : "altered");
    const bool is_true = is_same && !is_early;
    const Conformity conformity =
        is_true ? unless_busy(late <= kReportTime, probe, figures) : Conformity::kFailed;
    context.report.rows.push_back({"switches", conformity, figures});
    return true;
  }

 private:
  std::optional<Version> sent_;
  std::optional<RobotReport> seen_;
};

/// Starts a new agent while a version of the previous one is pending. Motors that respond late have already
/// received the beginning of a version that starts within the lead.
class TakeoverStep final : public ConformanceStep {
 public:
  std::string name() const override { return "takeover"; }

  bool update(ConformanceContext& context) override {
    RobotProbe& probe = context.probe;
    const RobotReport& robot_report = *probe.robot_report();
    if (!sent_) {
      const Time start = probe.robot_now() + context.stream.notice() + kPause;
      sent_ = context.stream.next(nudge(robot_report.executing.trajectory.state_at(start), start));
      probe.version = sent_;
      earlier_ = probe.incarnation;
      return false;
    }
    const Time start = sent_->trajectory.start();
    // Half a lead before the start, or early enough that the lead has not begun.
    const Duration before = starts_within_lead_ ? robot_report.lead / 2 : robot_report.lead + kPause / 2;
    if (probe.incarnation == earlier_ && probe.robot_now() >= start - before) {
      probe.version.reset();
      probe.incarnation += 1000;
    }
    const bool has_new_agent = probe.incarnation != earlier_;
    if (has_new_agent && robot_report.obeyed_incarnation == probe.incarnation && !acknowledged_)
      acknowledged_ = probe.robot_report();
    if (robot_report.valid_at < start + kAnswerTimeout) return false;
    const bool is_executed = robot_report.executing.number == sent_->number;
    const bool is_stated = acknowledged_ && acknowledged_->executing.number == robot_report.executing.number;
    if (is_executed != starts_within_lead_)
      faults_ += starts_within_lead_ ? "; a version that starts within the lead was discarded"
                                     : "; a version that starts later was executed";
    if (!acknowledged_)
      faults_ += "; the new agent was not acknowledged";
    else if (!is_stated)
      faults_ +=
          "; the report that acknowledges the new agent states a version that the robot does not execute "
          "then";
    context.stream.forget();
    sent_.reset();
    acknowledged_.reset();
    // A robot whose motors respond immediately has no lead.
    if (!starts_within_lead_ && robot_report.lead > 2 * probe.cycle()) {
      starts_within_lead_ = true;
      return false;
    }
    std::string figures = !faults_.empty()      ? faults_.substr(2)
                          : starts_within_lead_ ? "later ones discarded, one within the lead executed"
                                                : "discarded";
    const Conformity conformity = unless_busy(faults_.empty(), probe, figures);
    context.report.rows.push_back({"pending versions", conformity, figures});
    return true;
  }

 private:
  bool starts_within_lead_ = false;  ///< the version starts within the lead when the new agent takes over
  std::optional<Version> sent_;
  Incarnation earlier_ = 0;
  std::optional<RobotReport> acknowledged_;  ///< the first report that acknowledges the new agent
  std::string faults_;
};

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
using Message = msg::Command;
using Context = ConformanceContext;

/// Lowers the incarnations of the command and of its version, which must not exceed the command's.
void lower_incarnation(Message& m, std::uint64_t by) {
  m.header().incarnation(m.header().incarnation() - by);
  m.version().incarnation(m.header().incarnation());
}

}  // namespace

std::unique_ptr<ConformanceStep> make_reports_step() { return std::make_unique<ReportsStep>(); }
std::unique_ptr<ConformanceStep> make_clock_step() { return std::make_unique<ClockStep>(); }
std::unique_ptr<ConformanceStep> make_new_agent_step() { return std::make_unique<FenceStep>(); }
std::unique_ptr<ConformanceStep> make_takeover_step() { return std::make_unique<TakeoverStep>(); }
std::unique_ptr<ConformanceStep> make_switch_step() { return std::make_unique<SwitchStep>(); }

std::unique_ptr<ConformanceStep> make_fence_step() {
  return std::make_unique<RefusalStep>(
      "fences",
      std::vector<RefusalStep::Attempt>{
          {"fences", "a version of an earlier agent",
           [](Message& m, const Context&) { lower_incarnation(m, 1); }},
          {"fences", "a version of a much earlier agent",
           [](Message& m, const Context&) { lower_incarnation(m, 1'000'000'000); }},
          {"fences", "a version of an earlier epoch",
           [](Message& m, const Context&) { m.epoch(m.epoch() - 1); }},
          {"fences", "a version without an epoch", [](Message& m, const Context&) { m.epoch(0); }}});
}

std::unique_ptr<ConformanceStep> make_versions_step() {
  const auto delayed = [](Message& m, const Context& context) {
    // When the version arrives, half of the robot's lead is left, or nothing if it has no lead.
    const Time now = context.probe.robot_now();
    m.version().start_ns(to_ns(now + context.probe.robot_report()->lead / 2 - 1ms));
  };
  return std::make_unique<RefusalStep>(
      "versions",
      std::vector<RefusalStep::Attempt>{
          {"late versions", "a version that arrives too late", delayed},
          {"wrong base", "a version on a base that it does not execute",
           [](Message& m, const Context&) { m.version().base(m.version().base() + 1'000'000); }},
          {"wrong base", "a version on base 0",
           [](Message& m, const Context&) { m.version().base(m.version().base() == 0 ? 1 : 0); }},
          {"malformed commands", "a position of NaN",
           [](Message& m, const Context&) { m.version().x_m(kNan); }},
          {"malformed commands", "a heading of NaN",
           [](Message& m, const Context&) { m.desired_heading_rad(kNan); }},
          {"malformed commands", "an acceleration of 10^9 m/s²",
           [](Message& m, const Context&) { m.version().phases()[0].ax_mps2(1e9); }},
          {"malformed commands", "a phase count above the maximum",
           [](Message& m, const Context&) { m.version().phase_count(99); }},
          {"malformed commands", "a version of another robot",
           [](Message& m, const Context&) { m.version().robot(m.version().robot() + 1); }},
          {"malformed commands", "a command of another sender",
           [](Message& m, const Context&) { m.header().sender(m.header().sender() + 1); }},
          {"malformed commands", "an agent started a day ahead",
           [](Message& m,
              const Context&) { m.header().incarnation(m.header().incarnation() + 86'400'000'000'000); }},
          {"malformed commands", "an epoch a day ahead",
           [](Message& m, const Context&) { m.epoch(m.epoch() + 86'400'000'000'000); }}});
}

}  // namespace sidestep
