// SPDX-License-Identifier: Apache-2.0
// Expectations that are judged by ground truth.
#include <algorithm>
#include <fmt/format.h>

#include "deploy/audit/metrics/run_metrics.hpp"
#include "deploy/trial/test/judgement/coverage_gaps.hpp"
#include "deploy/trial/test/judgement/judge.hpp"
#include "deploy/trial/test/judgement/judge_each.hpp"

namespace sidestep {
namespace {

constexpr double kMoving_mps = 0.05;
// A robot that is not heard from for longer may have moved in that time.
constexpr double kMaxUnheardRest_s = 0.25;

/// For a robot that no sample of the span shows.
Judgement not_on_floor(RobotId robot, double from_s, double to_s, const RunHistory& history) {
  const bool has_sample = std::ranges::any_of(history.truths, [=](const TruthSample& sample) {
    return sample.at_s >= from_s && sample.at_s <= to_s;
  });
  if (!has_sample) {
    return Judgement::not_judged(
        from_s,
        fmt::format("there is no sample of ground truth between {:.3f} s and {:.3f} s", from_s, to_s));
  }
  return Judgement::not_judged(
      from_s,
      fmt::format("robot {} was not on the floor between {:.3f} s and {:.3f} s", robot, from_s, to_s));
}

/// The time at which the robot came to rest within the span and then stayed at rest long enough.
std::optional<double> rest_time(RobotId robot, const ExpectAtRest& check, const RunHistory& history) {
  std::optional<double> rest_since, heard_s;
  for (const TruthSample& sample : history.truths) {
    if (sample.at_s < check.span.from_s) continue;
    if (heard_s && sample.at_s - *heard_s > kMaxUnheardRest_s) rest_since.reset();
    heard_s = sample.at_s;
    const auto speed_mps = sample.speed_of(robot);
    if (!speed_mps || *speed_mps >= RunMetrics::kAtRest_mps)
      rest_since.reset();
    else
      rest_since = rest_since.value_or(sample.at_s);
    if (!rest_since) continue;
    if (*rest_since > check.span.to_s) return std::nullopt;
    if (sample.at_s - *rest_since >= check.for_s) return rest_since;
  }
  return std::nullopt;
}

Judgement judge_rest(RobotId robot, const ExpectAtRest& check, const RunHistory& history) {
  if (rest_time(robot, check, history)) return {};
  const double end_s = check.span.to_s + check.for_s;
  if (const auto unheard = gap_between(check.span.from_s, end_s, history)) return *unheard;
  std::optional<double> moved_s, rested_s;
  double speed_mps = 0;
  for (const TruthSample& sample : history.truths) {
    const auto speed = sample.at_s < check.span.from_s ? std::nullopt : sample.speed_of(robot);
    if (!speed) continue;
    if (*speed >= RunMetrics::kAtRest_mps && sample.at_s <= end_s) {
      moved_s = sample.at_s;
      speed_mps = *speed;
    } else if (*speed < RunMetrics::kAtRest_mps && sample.at_s > end_s && !rested_s) {
      rested_s = sample.at_s;
    }
  }
  if (!moved_s) return not_on_floor(robot, check.span.from_s, end_s, history);
  return Judgement::failed(
      *moved_s, fmt::format("robot {} still moved at {:.3f} m/s{}", robot, speed_mps,
                            rested_s ? fmt::format(", and came to rest by {:.3f} s", *rested_s) : ""));
}

Judgement judge_motion(RobotId robot, const ExpectMoving& check, const RunHistory& history) {
  std::optional<double> highest_mps;
  for (const TruthSample& sample : history.truths) {
    if (sample.at_s < check.span.from_s || sample.at_s > check.span.to_s) continue;
    if (const auto speed = sample.speed_of(robot)) highest_mps = std::max(highest_mps.value_or(0), *speed);
  }
  if (highest_mps >= kMoving_mps) return {};
  if (const auto unheard = gap_between(check.span.from_s, check.span.to_s, history)) return *unheard;
  if (!highest_mps) return not_on_floor(robot, check.span.from_s, check.span.to_s, history);
  return Judgement::failed(
      check.span.to_s,
      fmt::format("robot {} did not move; its highest speed was {:.3f} m/s", robot, *highest_mps));
}

Judgement judge_speed(RobotId robot, const ExpectMaxSpeed& check, const RunHistory& history) {
  const double to_s = check.to_s.value_or(history.end.at_s);
  bool is_seen = false;
  for (const TruthSample& sample : history.truths) {
    const auto speed = sample.speed_of(robot);
    if (!speed || sample.at_s < check.from_s || sample.at_s > to_s) continue;
    is_seen = true;
    if (*speed > check.speed_mps)
      return Judgement::failed(sample.at_s, fmt::format("robot {} moved at {:.3f} m/s", robot, *speed));
  }
  if (const auto unheard = check.to_s ? std::nullopt : gap_at_end(history)) return *unheard;
  if (const auto unheard = gap_between(check.from_s, to_s, history)) return *unheard;
  return is_seen ? Judgement{} : not_on_floor(robot, check.from_s, to_s, history);
}

}  // namespace

Judgement judge(const ExpectNoContact& check, const RunHistory& history) {
  for (const ContactSample& contact : history.contacts) {
    const auto is_in = [&](const RobotSet& robots) {
      return robots.contains(contact.first) || (contact.second && robots.contains(*contact.second));
    };
    if (!is_in(check.robots) || is_in(check.except)) continue;
    const std::string touched = contact.second ? fmt::format("robot {}", *contact.second) : "an obstacle";
    return Judgement::failed(contact.at_s, fmt::format("robot {} touched {}", contact.first, touched));
  }
  const auto crash = std::ranges::find_if(
      history.truths, [](const TruthSample& sample) { return sample.crashes_while_moving > 0; });
  if (check.robots.is_all && crash != history.truths.end())
    return Judgement::failed(crash->at_s, "a moving robot touched an opponent");
  if (history.unidentified_contacts > 0) {
    return Judgement::not_judged(history.end.at_s, fmt::format("the robots of {} contacts are unknown",
                                                               history.unidentified_contacts));
  }
  return gap_at_end(history).value_or(Judgement{});
}

Judgement judge(const ExpectMinClearance& check, const RunHistory& history) {
  const auto close = std::ranges::find_if(
      history.truths, [&](const TruthSample& sample) { return sample.min_clearance_m < check.clearance_m; });
  if (close == history.truths.end()) return gap_at_end(history).value_or(Judgement{});
  return Judgement::failed(close->at_s, fmt::format("the clearance was {:.6f} m", close->min_clearance_m));
}

Judgement judge(const ExpectAtRest& check, const RunHistory& history) {
  return judge_each(check.robots, [&](RobotId robot) { return judge_rest(robot, check, history); });
}

Judgement judge(const ExpectMoving& check, const RunHistory& history) {
  return judge_each(check.robots, [&](RobotId robot) { return judge_motion(robot, check, history); });
}

Judgement judge(const ExpectMaxSpeed& check, const RunHistory& history) {
  return judge_each(check.robots, [&](RobotId robot) { return judge_speed(robot, check, history); });
}

}  // namespace sidestep
