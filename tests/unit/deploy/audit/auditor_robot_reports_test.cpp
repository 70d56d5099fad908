// SPDX-License-Identifier: Apache-2.0
// Robot reports and ground truth with one detail modified at a time.
#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/tampering.hpp"

namespace sidestep::auditor_robot_reports_test {

using namespace std::chrono_literals;

TEST_CASE("each firmware breach is reported under its rule") {
  SECTION("the robot executes a version that was never sent") {
    require_violation(AuditRule::kSent, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.remove_if<msg::Command>([&](const msg::Command& c) {
        return c.robot() == s.robot && c.has_version() && c.version().version_number() == s.number;
      });
    });
  }
  SECTION("the robot switches from a version other than the base") {
    require_violation(AuditRule::kSwitch, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.for_each_copy(s.robot, s.number, [&](msg::Version& v) { v.base(s.before - 1); });
    });
  }
  SECTION("the robot switches after the start has passed") {
    require_violation(AuditRule::kLateSwitch, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      msg::Feedback* last = nullptr;
      h.each<msg::Feedback>([&](msg::Feedback& f, Time) {
        if (f.robot() == s.robot && f.executing().version_number() == s.before) last = &f;
      });
      last->valid_at_ns(s.start_ns);
    });
  }
  SECTION("the robot executes a version of a superseded agent") {
    require_violation(AuditRule::kStaleIncarnation, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.each<msg::Feedback>([&](msg::Feedback& f, Time at) {
        if (f.robot() == s.robot && to_ns(at) > s.start_ns - 30'000'000)
          f.obeyed_incarnation(f.obeyed_incarnation() + 1);
      });
    });
  }
  SECTION("the robot executes a version of a superseded epoch") {
    require_violation(AuditRule::kStaleEpoch, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.each<msg::Feedback>([&](msg::Feedback& f, Time at) {
        if (f.robot() == s.robot && to_ns(at) > s.start_ns) f.obeyed_epoch(f.obeyed_epoch() + 1);
      });
    });
  }
  SECTION("the robot's reports contradict earlier ones") {
    const auto tamper = GENERATE(
        std::function<void(msg::Feedback&, const msg::Feedback&)>(
            [](msg::Feedback& f, const msg::Feedback& old) { f.executing(old.executing()); }),
        [](msg::Feedback& f, const msg::Feedback& old) { f.valid_at_ns(old.valid_at_ns()); },
        [](msg::Feedback& f, const msg::Feedback&) { f.obeyed_incarnation(f.obeyed_incarnation() - 1); },
        [](msg::Feedback& f, const msg::Feedback&) { f.obeyed_epoch(f.obeyed_epoch() - 1); });
    require_violation(AuditRule::kFacts, [&](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      std::optional<msg::Feedback> old;
      bool is_done = false;
      h.each<msg::Feedback>([&](msg::Feedback& f, Time at) {
        if (is_done || f.robot() != s.robot || to_ns(at) < s.start_ns - 100'000'000) return;
        if (!old) old = f;
        if (to_ns(at) < s.start_ns) return;
        tamper(f, *old);
        is_done = true;
      });
    });
  }
  SECTION("the robot's own stop does not end at rest") {
    require_violation(AuditRule::kOffReference, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      bool is_done = false;
      h.each<msg::Feedback>([&](msg::Feedback& f, Time at) {
        if (is_done || f.robot() != s.robot || to_ns(at) < s.start_ns) return;
        is_done = true;
        f.is_off_reference(true);
        f.executing().version_number(s.number + 1'000'000);
        f.executing().vx_mps(1);
        f.executing().phase_count(0);
      });
    });
  }
}

TEST_CASE("an own stop that takes longer than braking needs is reported") {
  const auto [factor, is_reported] =
      GENERATE(table<double, bool>({{1.0, false}, {1.005, false}, {1.2, true}}));
  CAPTURE(factor);
  const AuditTotals totals = audit_tampered_crossing([longer = factor](MessageHistory& h) {
    const Switch s = first_moving_switch(h);
    const double speed_mps = 1, braking_s = speed_mps / h.scenario.limits.deceleration_mps2;
    bool is_done = false;
    h.each<msg::Feedback>([&](msg::Feedback& f, Time at) {
      if (is_done || f.robot() != s.robot || to_ns(at) < s.start_ns) return;
      is_done = true;
      f.is_off_reference(true);
      msg::Version& stop = f.executing();
      stop.version_number(s.number + 1'000'000);
      stop.vx_mps(speed_mps);
      stop.vy_mps(0);
      stop.phase_count(1);
      msg::MotionPhase& phase = stop.phases()[0];
      phase.duration_ns(std::llround(longer * braking_s * 1e9));
      phase.ax_mps2(-speed_mps / (static_cast<double>(phase.duration_ns()) * 1e-9));
      phase.ay_mps2(0);
    });
  });
  INFO(lines(totals));
  CHECK((count(totals, AuditRule::kOffReference) > 0) == is_reported);
}

TEST_CASE("a robot whose distance from its reference exceeds the budget is reported") {
  // The default bounds are 5 mm, and 3 mm for more than 25 ms, or 100 ms for a robot that does not move away.
  // Robots report at least every 17 ms.
  const auto [error_m, duration, is_reported] =
      GENERATE(table<double, Duration, bool>({{0.0033, 1s, false},
                                              {0.0045, 20ms, false},
                                              {0.0045, 60ms, false},
                                              {0.0045, 140ms, true},
                                              {0.006, 0ms, false},
                                              {0.006, 20ms, true}}));
  CAPTURE(error_m, to_seconds(duration), is_reported);
  const AuditTotals totals =
      audit_tampered_crossing([&, off_m = error_m, until = duration](MessageHistory& h) {
        std::optional<Time> first;
        h.each<msg::Feedback>([&](msg::Feedback& f, Time at) {
          if (f.robot() != 2 || at < h.messages.front().at + 1500ms) return;
          if (!first) first = at;
          if (at <= *first + until) f.tracking_error_m(off_m);
        });
      });
  INFO(lines(totals));
  CHECK((count(totals, AuditRule::kTracking) > 0) == is_reported);
}

TEST_CASE("ground truth also shows robots beyond the tracking bound in a live run") {
  const auto [error_m, is_reported] = GENERATE(table<double, bool>({{0.0045, false}, {0.0055, true}}));
  CAPTURE(error_m);
  MessageHistory history = crossing();
  history.each<msg::GroundTruth>([off_m = error_m](msg::GroundTruth& truth, Time) {
    for (msg::TrueRobotState& robot : truth.robots()) robot.reference_error_m(off_m);
  });
  const AuditTotals totals = audit_of(history, {});
  INFO(lines(totals));
  CHECK((count(totals, AuditRule::kPosition) > 0) == is_reported);
  CHECK(totals.max_position_error_m == Approx(error_m));
}

TEST_CASE("a robot whose reference jumps because its clock is set breaks no rule") {
  const AuditTotals totals = audit_tampered_crossing([](MessageHistory& h) {
    int count = 0;
    h.each<msg::Feedback>([&](msg::Feedback& f, Time) {
      if (f.robot() != 2 || ++count != 100) return;
      f.tracking_error_m(0.3);
      f.valid_at_ns(f.valid_at_ns() + 400'000'000);
    });
  });
  CHECK(count(totals, AuditRule::kTracking) == 0);
}

TEST_CASE("a late report of a robot's former incarnation changes nothing") {
  const auto totals_with = [](bool is_delivered_late) {
    MessageHistory history = crossing();
    const Time set_back = history.messages.front().at + 1500ms;
    std::optional<msg::Feedback> last;
    history.each<msg::Feedback>([&](msg::Feedback& robot_report, Time at) {
      if (robot_report.robot() != 2) return;
      if (at < set_back) last = robot_report;
      if (at >= set_back) robot_report.header().incarnation(robot_report.header().incarnation() + 1);
    });
    const auto is_last = [&](const msg::Feedback& robot_report) {
      return robot_report.robot() == 2 &&
             robot_report.header().incarnation() == last->header().incarnation() &&
             robot_report.header().message_number() == last->header().message_number();
    };
    history.remove_if<msg::Feedback>(is_last);
    const auto place = std::ranges::find_if(
        history.messages, [&](const ReceivedMessage& received) { return received.at > set_back + 40ms; });
    if (is_delivered_late) history.messages.insert(place, {set_back + 40ms, *last});
    return audit_of(history, {});
  };
  const AuditTotals without = totals_with(false), with = totals_with(true);
  INFO(lines(with));
  CHECK(without.violations == 0);
  CHECK(with.violations == 0);
  CHECK(with.received == without.received + 1);
  CHECK(with.compared_pairs == without.compared_pairs);
  CHECK(with.coverage.versions == without.coverage.versions);
}

TEST_CASE("ground truth that contradicts the guarantee is reported under its rule") {
  SECTION("a robot is displaced") {
    const double shift_m = GENERATE(0.007, 0.02);
    CAPTURE(shift_m);
    require_violation(AuditRule::kPosition, [shift_m](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.each<msg::GroundTruth>([&](msg::GroundTruth& truth, Time) {
        for (msg::TrueRobotState& robot : truth.robots()) {
          if (robot.robot() == s.robot) robot.x_m(robot.x_m() + shift_m);
        }
      });
    });
  }
  SECTION("a push excuses a displacement of the pushed robot for a while") {
    // The id of the pushed robot (-1: none; robot 2 is displaced), and the time from push to displacement.
    const auto [pushed, late, is_reported] = GENERATE(
        table<int, Duration, bool>({{-1, 0ms, true}, {2, 0ms, false}, {2, 1200ms, true}, {3, 0ms, true}}));
    CAPTURE(pushed, to_seconds(late), is_reported);
    const AuditTotals totals =
        audit_tampered_crossing([&, robot_pushed = pushed, after = late](MessageHistory& h) {
          const Time push = h.messages.front().at + 1500ms;
          const RobotId moved = first_moving_switch(h).robot;
          h.each<msg::GroundTruth>([&](msg::GroundTruth& truth, Time at) {
            if (at < push + after || at > push + after + 500ms) return;
            for (msg::TrueRobotState& robot : truth.robots()) {
              if (robot.robot() == moved) robot.x_m(robot.x_m() + 0.02);
            }
          });
          if (robot_pushed >= 0) h.push(static_cast<RobotId>(robot_pushed), push);
        });
    INFO(lines(totals));
    CHECK((count(totals, AuditRule::kPosition) > 0) == is_reported);
    CHECK((totals.excused_displacements > 0) == !is_reported);
  }
  SECTION("a contact occurs long after a push, also in an incomplete history") {
    const bool is_complete = GENERATE(true, false);
    CAPTURE(is_complete);
    MessageHistory history = crossing();
    const Time push = history.messages.front().at + 500ms;
    history.push(2, push);
    history.each<msg::GroundTruth>([&](msg::GroundTruth& truth, Time at) {
      if (at < push + 2s) return;
      truth.contacts(1);
      truth.recent_contacts()[0].first(2);
      truth.recent_contacts()[0].second(3);
    });
    const AuditTotals totals = audit_of(history, is_complete ? kComplete : AuditInput{});
    CHECK(count(totals, AuditRule::kContact) > 0);
  }
  SECTION("a pushed robot and robots that it pushes in turn have contacts") {
    // The pair of the last contact, and the numbers of excused and reported contacts.
    const auto [first, second, excused, reported] =
        GENERATE(table<RobotId, RobotId, std::uint64_t, std::uint64_t>(
            {{4, 5, 3, 0}, {0, 1, 2, 1}, {5, msg::NO_ROBOT, 3, 0}, {1, msg::NO_ROBOT, 2, 1}}));
    CAPTURE(first, second);
    const AuditTotals totals = audit_tampered_crossing([a = first, b = second](MessageHistory& h) {
      const Time push = h.messages.front().at + 1500ms;
      h.push(2, push);
      h.each<msg::GroundTruth>([&](msg::GroundTruth& truth, Time at) {
        if (at < push + 100ms) return;
        truth.contacts(3);
        const std::pair<RobotId, RobotId> pairs[] = {{2, 5}, {4, 5}, {a, b}};
        for (std::size_t i = 0; i < 3; ++i) {
          truth.recent_contacts()[i].first(pairs[i].first);
          truth.recent_contacts()[i].second(pairs[i].second);
        }
      });
    });
    INFO(lines(totals));
    CHECK(totals.excused_contacts == excused);
    CHECK(count(totals, AuditRule::kContact) == reported);
  }
  SECTION("a contact occurs") {
    require_violation(AuditRule::kContact, [](MessageHistory& h) {
      h.each<msg::GroundTruth>([](msg::GroundTruth& truth, Time) { truth.contacts(1); });
    });
  }
  SECTION("something touches a moving robot") {
    require_violation(AuditRule::kCrash, [](MessageHistory& h) {
      h.each<msg::GroundTruth>([](msg::GroundTruth& truth, Time) { truth.crashes_while_moving(1); });
    });
  }
  SECTION("more moving robots are touched than ground truth lists") {
    require_violation(AuditRule::kCrash, [](MessageHistory& h) {
      h.each<msg::GroundTruth>([](msg::GroundTruth& truth, Time) { truth.crashes_while_moving(100); });
    });
  }
  SECTION("the simulator's firmware monitor finds a violation") {
    require_violation(AuditRule::kFirmwareMonitor, [](MessageHistory& h) {
      h.each<msg::GroundTruth>([](msg::GroundTruth& truth, Time) { truth.firmware_violations(2); });
    });
  }
}

}  // namespace sidestep::auditor_robot_reports_test
