// SPDX-License-Identifier: Apache-2.0
// The pairs of versions that an audit reports as too close, compared with all pairs of a history.
#include <algorithm>
#include <map>
#include <set>

#include "common/messaging/version_codec.hpp"
#include "common/motion/clearance.hpp"
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/tampering.hpp"

namespace sidestep::auditor_pairs_test {

/// Two versions, with the lower robot id first.
using Pair = std::array<std::pair<RobotId, VersionNumber>, 2>;

/// The facts about one version in a history. Times are the times of messages.
struct VersionFacts {
  Version version;
  bool is_registered = false;
  std::int64_t granted_ns = kAlways;  ///< kAlways: not granted by a verdict
  std::int64_t excluded_ns = kNever;  ///< first report after which the robot cannot execute it
  std::int64_t executed_until_ns = kAlways;
};
using VersionFactsByNumber = std::map<std::pair<RobotId, VersionNumber>, VersionFacts>;

bool excludes(const msg::Feedback& robot_report, const Version& version) {
  const VersionNumber executing = robot_report.executing().version_number();
  return version.number < executing ||
         (version.number > executing && to_ns(version.trajectory.start()) <= robot_report.valid_at_ns());
}

/// All versions that were granted or registered, in one epoch, by agents that did not restart.
VersionFactsByNumber pasts_of(MessageHistory& history) {
  VersionFactsByNumber pasts;
  std::map<std::pair<RobotId, VersionNumber>, Version> proposed;
  std::map<RobotId, msg::Feedback> robot_reports;
  for (ReceivedMessage& received : history.messages) {
    const std::int64_t at_ns = to_ns(received.at);
    if (const auto* proposal = std::get_if<msg::Proposal>(&received.message)) {
      for (std::size_t i = 0; i < proposal->candidate_count(); ++i) {
        const msg::Version& candidate = proposal->candidates()[i];
        proposed[{candidate.robot(), candidate.version_number()}] = decode(candidate).value();
      }
    } else if (const auto* verdict = std::get_if<msg::Verdict>(&received.message)) {
      if (verdict->granted_version() == 0) continue;
      const std::pair key(verdict->robot(), verdict->granted_version());
      VersionFacts& past = pasts[key];
      if (past.granted_ns != kAlways) continue;
      past.version = proposed.at(key);
      past.granted_ns = at_ns;
      const auto robot_report = robot_reports.find(verdict->robot());
      if (robot_report != robot_reports.end() && excludes(robot_report->second, past.version))
        past.excluded_ns = kAlways;
    } else if (const auto* registration = std::get_if<msg::Registration>(&received.message)) {
      for (std::size_t i = 0; i < registration->version_count(); ++i) {
        VersionFacts& past = pasts[{registration->robot(), registration->versions()[i].version_number()}];
        past.version = decode(registration->versions()[i]).value();
        past.is_registered = true;
      }
    } else if (const auto* robot_report = std::get_if<msg::Feedback>(&received.message)) {
      robot_reports[robot_report->robot()] = *robot_report;
      for (auto& [key, past] : pasts) {
        if (key.first == robot_report->robot() && past.excluded_ns == kNever &&
            excludes(*robot_report, past.version))
          past.excluded_ns = at_ns;
      }
      const auto executing = pasts.find({robot_report->robot(), robot_report->executing().version_number()});
      if (executing == pasts.end()) continue;
      executing->second.executed_until_ns = robot_report->valid_at_ns();
      const auto base = pasts.find({robot_report->robot(), robot_report->executing().base()});
      if (base != pasts.end() && base != executing)
        base->second.executed_until_ns =
            std::max(base->second.executed_until_ns, robot_report->executing().start_ns());
    }
  }
  return pasts;
}

/// The part of a trajectory from `from` on.
Trajectory remainder(const Trajectory& whole, Time from) {
  if (from <= whole.start()) return whole;
  Trajectory rest(from, whole.state_at(from));
  Time begin = whole.start();
  for (const MotionPhase& phase : whole.phases()) {
    const Time end = begin + phase.duration;
    if (end > from) rest.append(end - std::max(begin, from), phase.acceleration_mps2);
    begin = end;
  }
  return rest;
}

/// Whether a pair must be reported. For a borderline pair, rounding decides.
enum class Judgement : std::uint8_t { kClear, kTooClose, kBorderline };

class ReferencePairJudge {
 public:
  ReferencePairJudge(const Scenario& scenario, const VersionFactsByNumber& pasts)
      : pasts_(pasts), robots_m_(2 * scenario.radius_m + scenario.margin_m) {}

  Judgement judge(const VersionFacts& a, const VersionFacts& b) const {
    if (a.version.number == 0 && b.version.number == 0) return Judgement::kClear;
    const double clearance = clearance_m(a.version.trajectory, b.version.trajectory, required_m(a, b));
    if (clearance > 1e-5) return Judgement::kClear;
    const Judgement first = excuse(a, b), second = excuse(b, a);
    if (first == Judgement::kClear || second == Judgement::kClear) return Judgement::kClear;
    const bool is_borderline =
        clearance > -1e-5 || first == Judgement::kBorderline || second == Judgement::kBorderline;
    return is_borderline ? Judgement::kBorderline : Judgement::kTooClose;
  }

 private:
  /// kClear if the base of `later` was already too close and `later` comes no closer.
  Judgement excuse(const VersionFacts& later, const VersionFacts& other) const {
    if (later.version.number == 0) return Judgement::kTooClose;
    const Version& base = pasts_.at({later.version.robot, later.version.base}).version;
    const Time from = later.version.trajectory.start();
    const double separation_m = required_m(later, other);
    const double before =
        clearance_m(remainder(base.trajectory, from), other.version.trajectory, separation_m);
    const double after = clearance_m(later.version.trajectory, other.version.trajectory, separation_m);
    if (before > 1e-5 || after < before - 1e-5) return Judgement::kTooClose;
    return before > -1e-5 || after < before - 1e-7 ? Judgement::kBorderline : Judgement::kClear;
  }

  double required_m(const VersionFacts& a, const VersionFacts& b) const {
    return robots_m_ + a.version.inflation_m + b.version.inflation_m;
  }

  const VersionFactsByNumber& pasts_;
  double robots_m_;
};

/// The pairs that are not clear and for which `were_concurrent` holds, with their judgements.
std::map<Pair, Judgement> judged_pairs(
    const Scenario& scenario, const VersionFactsByNumber& pasts,
    const std::function<bool(const VersionFacts&, const VersionFacts&)>& were_concurrent) {
  const ReferencePairJudge judge(scenario, pasts);
  std::map<Pair, Judgement> result;
  for (const auto& [a, a_past] : pasts) {
    for (const auto& [b, b_past] : pasts) {
      if (a.first >= b.first || !were_concurrent(a_past, b_past)) continue;
      const Judgement judgement = judge.judge(a_past, b_past);
      if (judgement != Judgement::kClear) result[{a, b}] = judgement;
    }
  }
  return result;
}

/// How often an audit reports each pair.
std::map<Pair, int> reported_pairs(const MessageHistory& history, const AuditInput& input) {
  std::map<Pair, int> pairs;
  audit_of(history, input, [&](const Violation& violation) {
    if (violation.rule != AuditRule::kClearance) return;
    Pair pair{std::pair(violation.robot, violation.version),
              std::pair(violation.other.value(), violation.other_version)};
    std::ranges::sort(pair);
    ++pairs[pair];
  });
  return pairs;
}

int count(const std::map<Pair, Judgement>& pairs, Judgement judgement) {
  return static_cast<int>(
      std::ranges::count_if(pairs, [=](const auto& pair) { return pair.second == judgement; }));
}

/// Whether some ledger held both versions at the same time: no report had excluded either version before both
/// were granted. Registered versions were in the ledger before any grant.
bool were_in_ledger_together(const VersionFacts& a, const VersionFacts& b) {
  const bool is_granted = a.granted_ns != kAlways || b.granted_ns != kAlways;
  const std::int64_t both_ns = std::max(a.granted_ns, b.granted_ns);
  return is_granted && a.excluded_ns >= both_ns && b.excluded_ns >= both_ns;
}

/// Whether reports prove simultaneous execution of the versions, despite the errors of both clocks.
bool were_executed_concurrently(const VersionFacts& a, const VersionFacts& b, std::int64_t clock_bound_ns) {
  const Time from = std::max(a.version.trajectory.start(), b.version.trajectory.start());
  const std::int64_t until_ns = std::min(a.executed_until_ns, b.executed_until_ns);
  return until_ns != kAlways && until_ns > to_ns(from) + 2 * clock_bound_ns + 1000;
}

/// The crossing as if all versions had been granted with too little margin, some of them with inflation.
MessageHistory too_close(double less_m) {
  MessageHistory history = crossing();
  history.scenario.margin_m += less_m;
  history.each_version([](msg::Version& version) { version.inflation_m(0.004 * (version.robot() % 3)); });
  return history;
}

/// Checks that each pair that is too close is reported once, and that no clear pair is reported.
void check_reported(const std::map<Pair, Judgement>& expected, const std::map<Pair, int>& reported) {
  for (const auto& [pair, judgement] : expected) {
    CAPTURE(pair[0].first, pair[0].second, pair[1].first, pair[1].second);
    if (judgement == Judgement::kTooClose) CHECK(reported.contains(pair));
  }
  for (const auto& [pair, times] : reported) {
    CAPTURE(pair[0].first, pair[0].second, pair[1].first, pair[1].second);
    CHECK(expected.contains(pair));
    CHECK(times == 1);
  }
  CHECK(count(expected, Judgement::kTooClose) >= 5);
  CHECK(count(expected, Judgement::kBorderline) < count(expected, Judgement::kTooClose) / 5);
}

TEST_CASE("each pair of versions that are in the ledger together and too close is reported exactly once") {
  const double less_m = GENERATE(0.05, 0.15);
  CAPTURE(less_m);
  MessageHistory history = too_close(less_m);
  check_reported(judged_pairs(history.scenario, pasts_of(history), were_in_ledger_together),
                 reported_pairs(history, kComplete));
}

TEST_CASE("an audit that hears no grants reports exactly the pairs that were executed too close together") {
  const double less_m = GENERATE(0.05, 0.15), clock_bound_s = GENERATE(0.001, 0.004);
  CAPTURE(less_m, clock_bound_s);
  MessageHistory history = too_close(less_m);
  history.scenario.clock_bound_s = clock_bound_s;
  const auto expected =
      judged_pairs(history.scenario, pasts_of(history), [&](const VersionFacts& a, const VersionFacts& b) {
        return were_executed_concurrently(a, b, from_seconds(clock_bound_s).count());
      });
  history.remove_if<msg::Verdict>([](const msg::Verdict&) { return true; });
  history.remove_if<msg::LedgerPage>([](const msg::LedgerPage&) { return true; });
  check_reported(expected, reported_pairs(history, kComplete));
}

TEST_CASE("reports of a robot whose clock is out of bounds do not prove that a pair was too close") {
  const std::size_t place = GENERATE(0u, 1u);
  MessageHistory history = too_close(0.15);
  history.remove_if<msg::Verdict>([](const msg::Verdict&) { return true; });
  history.remove_if<msg::LedgerPage>([](const msg::LedgerPage&) { return true; });
  const auto before = reported_pairs(history, kComplete);
  REQUIRE_FALSE(before.empty());
  const RobotId robot = before.begin()->first[place].first;
  const auto involves = [&](const auto& entry) {
    return entry.first[0].first == robot || entry.first[1].first == robot;
  };
  history.each<msg::Feedback>([&](msg::Feedback& robot_report, Time) {
    if (robot_report.robot() == robot) robot_report.valid_at_ns(robot_report.valid_at_ns() + 3'000'000);
  });
  auto after = reported_pairs(history, kComplete);
  CHECK(std::ranges::none_of(after, involves));
  CHECK(static_cast<std::ptrdiff_t>(after.size()) ==
        static_cast<std::ptrdiff_t>(before.size()) - std::ranges::count_if(before, involves));
}

TEST_CASE("an audit that may miss messages reports most pairs that are too close and no other pairs") {
  const double less_m = GENERATE(0.05, 0.15);
  const bool has_pages = GENERATE(true, false);
  CAPTURE(less_m, has_pages);
  MessageHistory history = too_close(less_m);
  const std::int64_t clock_bound_ns = from_seconds(history.scenario.clock_bound_s).count();
  const auto expected =
      judged_pairs(history.scenario, pasts_of(history), [&](const VersionFacts& a, const VersionFacts& b) {
        return has_pages ? were_in_ledger_together(a, b) : were_executed_concurrently(a, b, clock_bound_ns);
      });
  // Without pages the content of the ledger is unknown.
  if (!has_pages) history.remove_if<msg::LedgerPage>([](const msg::LedgerPage&) { return true; });
  const auto reported = reported_pairs(history, {});
  int found = 0;
  for (const auto& [pair, times] : reported) {
    CAPTURE(pair[0].first, pair[0].second, pair[1].first, pair[1].second);
    CHECK(expected.contains(pair));
    CHECK(times == 1);
    found += expected.contains(pair);
  }
  CHECK(3 * found > 2 * count(expected, Judgement::kTooClose));
}

}  // namespace sidestep::auditor_pairs_test
