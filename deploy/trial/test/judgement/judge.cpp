// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/judgement/judge.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "common/protocol/process_names.hpp"
#include "deploy/trial/test/judgement/coverage_gaps.hpp"
#include "deploy/trial/test/judgement/judge_each.hpp"

namespace sidestep {
namespace {

Judgement judge_name(RobotId robot, const ExpectNamed& check, const RunHistory& history) {
  const auto named = std::ranges::find_if(history.notices, [&](const NoticeSample& notice) {
    return notice.robot == robot && notice.kind == check.as && notice.at_s >= check.span.from_s;
  });
  const bool is_named = named != history.notices.end();
  if (is_named && named->at_s <= check.span.to_s) return {};
  const bool is_heard = std::ranges::any_of(history.coordinators, [&](const CoordinatorSample& sample) {
    return sample.at_s >= check.span.from_s && sample.at_s <= check.span.to_s;
  });
  if (const auto ended = ended_before(check.span.to_s, history)) return *ended;
  if (!is_heard) return Judgement::not_judged(check.span.from_s, "no active coordinator was heard");
  return Judgement::failed(check.span.to_s,
                           is_named ? fmt::format("robot {} was named late, at {:.3f} s", robot, named->at_s)
                                    : fmt::format("robot {} was not named", robot));
}

Judgement judge_arrival(RobotId robot, const ExpectArrived& check, const RunHistory& history) {
  const RunEnd& end = history.end;
  const auto found = end.arrival_s.find(robot);
  if (found != end.arrival_s.end() && found->second) {
    const double arrival_s = *found->second;
    if (!check.by_s || arrival_s <= *check.by_s) return {};
    return Judgement::failed(arrival_s, fmt::format("robot {} arrived late, at {:.3f} s", robot, arrival_s));
  }
  if (!end.abort_reason.empty()) return gap_at_end(history).value_or(Judgement{});
  if (const auto ended = check.by_s ? ended_before(*check.by_s, history) : std::nullopt) return *ended;
  return Judgement::failed(check.by_s.value_or(end.at_s), fmt::format("robot {} had not arrived", robot));
}

Judgement judge_absence_of_arrival(RobotId robot, const RunHistory& history) {
  const auto found = history.end.arrival_s.find(robot);
  const bool has_arrived = found != history.end.arrival_s.end() && found->second;
  if (!has_arrived) return gap_at_end(history).value_or(Judgement{});
  return Judgement::failed(*found->second,
                           fmt::format("robot {} arrived at {:.3f} s", robot, *found->second));
}

}  // namespace

Judgement judge(const ExpectTakeover& check, const RunHistory& history) {
  const CoordinatorSample* before = nullptr;
  for (const CoordinatorSample& sample : history.coordinators) {
    if (!sample.is_granting) continue;
    if (sample.at_s <= check.span.from_s) {
      before = &sample;
      continue;
    }
    if (!before || sample.number == before->number || sample.epoch <= before->epoch) continue;
    if (sample.at_s <= check.span.to_s) return {};
    return Judgement::failed(
        sample.at_s, fmt::format("{} granted late, after {:.0f} ms", coordinator_process(sample.number),
                                 1e3 * (sample.at_s - check.span.from_s)));
  }
  if (!before) return Judgement::not_judged(check.span.from_s, "no coordinator had granted before this time");
  if (const auto ended = ended_before(check.span.to_s, history)) return *ended;
  return Judgement::failed(check.span.to_s, "no other coordinator granted");
}

Judgement judge(const ExpectNamed& check, const RunHistory& history) {
  return judge_each(check.robots, [&](RobotId robot) { return judge_name(robot, check, history); });
}

Judgement judge(const ExpectNoViolations&, const RunHistory& history) {
  const RunEnd& end = history.end;
  if (end.violations > 0) {
    return Judgement::failed(end.first_violation_at_s, fmt::format("{} violations, the first: {}",
                                                                   end.violations, end.first_violation));
  }
  if (!end.abort_reason.empty()) return gap_at_end(history).value_or(Judgement{});
  if (!end.shortfall.empty()) return Judgement::not_judged(end.at_s, "audit: " + end.shortfall);
  return {};
}

Judgement judge(const ExpectArrived& check, const RunHistory& history) {
  return judge_each(check.robots, [&](RobotId robot) { return judge_arrival(robot, check, history); });
}

Judgement judge(const ExpectNotArrived& check, const RunHistory& history) {
  return judge_each(check.robots, [&](RobotId robot) { return judge_absence_of_arrival(robot, history); });
}

Judgement judge(const ExpectMismatch& check, const RunHistory& history) {
  const RunEnd& end = history.end;
  if (end.mismatches.contains(check.process)) return {};
  if (!end.abort_reason.empty()) return gap_at_end(history).value_or(Judgement{});
  std::string others;
  for (const auto& [process, differences] : end.mismatches) others += (others.empty() ? "" : ", ") + process;
  return Judgement::failed(end.at_s, others.empty() ? "no process is reported to have different rules"
                                                    : "only other processes are reported: " + others);
}

Judgement judge(const Expectation& expectation, const RunHistory& history) {
  return std::visit([&](const auto& check) { return judge(check, history); }, expectation.check);
}

}  // namespace sidestep
