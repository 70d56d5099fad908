// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/plan/expectation.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sidestep {
namespace {

struct NamedKind {
  NoticeKind kind;
  const char* name;
};
constexpr std::array<NamedKind, 5> kNoticeKinds{{{NoticeKind::kMissing, "missing"},
                                                 {NoticeKind::kQuarantined, "quarantined"},
                                                 {NoticeKind::kDisplaced, "displaced"},
                                                 {NoticeKind::kConflict, "conflict"},
                                                 {NoticeKind::kClockOutOfBound, "clock_out_of_bound"}}};

std::string text_of(const TimeSpan& span) {
  return fmt::format("between {:g} s and {:g} s", span.from_s, span.to_s);
}

std::string by_text(const std::optional<double>& by_s) {
  return by_s ? fmt::format("by {:g} s", *by_s) : "by the end of the run";
}

/// Describes each kind of expectation.
struct DescribeCheck {
  std::string operator()(const ExpectNoContact& check) const {
    std::string text = "no contact of " + to_text(check.robots);
    if (!check.except.ids.empty()) text += ", except with " + to_text(check.except);
    return text;
  }
  std::string operator()(const ExpectNoViolations&) const { return "no violation of the protocol's rules"; }
  std::string operator()(const ExpectArrived& check) const {
    return fmt::format("{} arrived {}", to_text(check.robots), by_text(check.by_s));
  }
  std::string operator()(const ExpectNotArrived& check) const {
    return fmt::format("{} not arrived by the end of the run", to_text(check.robots));
  }
  std::string operator()(const ExpectAtRest& check) const {
    const std::string text = fmt::format("{} at rest {}", to_text(check.robots), text_of(check.span));
    return check.for_s > 0 ? fmt::format("{}, for {:g} s", text, check.for_s) : text;
  }
  std::string operator()(const ExpectMoving& check) const {
    return fmt::format("{} moving {}", to_text(check.robots), text_of(check.span));
  }
  std::string operator()(const ExpectMinClearance& check) const {
    return fmt::format("a clearance of at least {:g} m", check.clearance_m);
  }
  std::string operator()(const ExpectMaxSpeed& check) const {
    return fmt::format("{} not faster than {:g} m/s from {:g} s {}", to_text(check.robots), check.speed_mps,
                       check.from_s,
                       check.to_s ? fmt::format("to {:g} s", *check.to_s) : "to the end of the run");
  }
  std::string operator()(const ExpectTakeover& check) const {
    return "another coordinator grants " + text_of(check.span);
  }
  std::string operator()(const ExpectNamed& check) const {
    return fmt::format("{} named {} {}", to_text(check.robots), name_of(check.as), text_of(check.span));
  }
  std::string operator()(const ExpectMismatch& check) const {
    return check.process + " reported to have different rules";
  }
};

/// The deadline of each kind of expectation.
struct DeadlineOfCheck {
  template <typename Check>
  std::optional<double> operator()(const Check&) const {
    return std::nullopt;
  }
  std::optional<double> operator()(const ExpectArrived& check) const { return check.by_s; }
  std::optional<double> operator()(const ExpectAtRest& check) const { return check.span.to_s + check.for_s; }
  std::optional<double> operator()(const ExpectMoving& check) const { return check.span.to_s; }
  std::optional<double> operator()(const ExpectMaxSpeed& check) const { return check.to_s; }
  std::optional<double> operator()(const ExpectTakeover& check) const { return check.span.to_s; }
  std::optional<double> operator()(const ExpectNamed& check) const { return check.span.to_s; }
};

}  // namespace

const char* name_of(NoticeKind kind) { return std::ranges::find(kNoticeKinds, kind, &NamedKind::kind)->name; }

std::optional<NoticeKind> notice_kind_named(const std::string& name) {
  const auto found = std::ranges::find(kNoticeKinds, name, &NamedKind::name);
  return found == kNoticeKinds.end() ? std::nullopt : std::optional(found->kind);
}

bool RobotSet::contains(RobotId robot) const { return std::ranges::find(ids, robot) != ids.end(); }

std::string to_text(const RobotSet& robots) {
  if (robots.is_all) return "all robots";
  return fmt::format("robot{} {}", robots.ids.size() == 1 ? "" : "s", fmt::join(robots.ids, ", "));
}

std::string describe(const Expectation& expectation) {
  return std::visit(DescribeCheck{}, expectation.check);
}

std::optional<double> deadline_s(const Expectation& expectation) {
  return std::visit(DeadlineOfCheck{}, expectation.check);
}

}  // namespace sidestep
