// SPDX-License-Identifier: Apache-2.0
// What robots and their simulator say of themselves, tampered with in one thing at a time.
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/unit/deploy/monitor/audit/tampering.hpp"

namespace sidestep {

using namespace std::chrono_literals;

TEST_CASE("every breach of the firmware's rules is named") {
  SECTION("a version that was never sent") {
    require_caught(AuditRule::kSent, [](History& h) {
      const Switch s = a_switch(h);
      h.remove_if<msg::Command>([&](const msg::Command& c) {
        return c.robot() == s.robot && c.has_version() && c.granted().version_number() == s.number;
      });
    });
  }
  SECTION("a switch from something else than the base") {
    require_caught(AuditRule::kSwitch, [](History& h) {
      const Switch s = a_switch(h);
      h.each_mention(s.robot, s.number, [&](msg::Version& v) { v.base(s.before - 1); });
    });
  }
  SECTION("a switch after the start had passed") {
    require_caught(AuditRule::kLate, [](History& h) {
      const Switch s = a_switch(h);
      msg::Feedback* last = nullptr;
      h.each<msg::Feedback>([&](msg::Feedback& f, Time) {
        if (f.robot() == s.robot && f.executing().version_number() == s.before) last = &f;
      });
      last->at_ns(s.start_ns);
    });
  }
  SECTION("a version of an agent that is not obeyed any more") {
    require_caught(AuditRule::kFenced, [](History& h) {
      const Switch s = a_switch(h);
      h.each<msg::Feedback>([&](msg::Feedback& f, Time at) {
        if (f.robot() == s.robot && to_ns(at) > s.start_ns - 30'000'000)
          f.obeyed_incarnation(f.obeyed_incarnation() + 1);
      });
    });
  }
  SECTION("a version of an epoch that is not obeyed any more") {
    require_caught(AuditRule::kOldEpoch, [](History& h) {
      const Switch s = a_switch(h);
      h.each<msg::Feedback>([&](msg::Feedback& f, Time at) {
        if (f.robot() == s.robot && to_ns(at) > s.start_ns) f.obeyed_epoch(f.obeyed_epoch() + 1);
      });
    });
  }
  SECTION("facts that contradict earlier ones") {
    const auto tamper = GENERATE(
        std::function<void(msg::Feedback&, const msg::Feedback&)>(
            [](msg::Feedback& f, const msg::Feedback& old) { f.executing(old.executing()); }),
        [](msg::Feedback& f, const msg::Feedback& old) { f.at_ns(old.at_ns()); },
        [](msg::Feedback& f, const msg::Feedback&) { f.obeyed_incarnation(f.obeyed_incarnation() - 1); },
        [](msg::Feedback& f, const msg::Feedback&) { f.obeyed_epoch(f.obeyed_epoch() - 1); });
    require_caught(AuditRule::kFacts, [&](History& h) {
      const Switch s = a_switch(h);
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
  SECTION("a stop of its own that does not stop") {
    require_caught(AuditRule::kOffReference, [](History& h) {
      const Switch s = a_switch(h);
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
  SECTION("a robot that believes to be far off and goes on") {
    require_caught(AuditRule::kTracking, [](History& h) {
      h.each<msg::Feedback>([](msg::Feedback& f, Time) { f.tracking_error_m(0.02); });
    });
  }
}

TEST_CASE("a robot that finds itself far off because its clock is set breaks no rule") {
  const AuditTotals totals = tampered([](History& h) {
    int count = 0;
    h.each<msg::Feedback>([&](msg::Feedback& f, Time) {
      if (f.robot() != 2 || ++count != 100) return;
      f.tracking_error_m(0.3);
      f.at_ns(f.at_ns() + 400'000'000);
    });
  });
  CHECK(count(totals, AuditRule::kTracking) == 0);
}

TEST_CASE("what truth says against the promise is named") {
  SECTION("a robot elsewhere") {
    require_caught(AuditRule::kPlace, [](History& h) {
      const Switch s = a_switch(h);
      h.each<msg::GroundTruth>([&](msg::GroundTruth& truth, Time) {
        for (msg::TruthRobot& robot : truth.robots()) {
          if (robot.robot() == s.robot) robot.x_m(robot.x_m() + 0.02);
        }
      });
    });
  }
  SECTION("a robot elsewhere whom nobody has pushed, and one that was long ago") {
    // Nobody, then the robot itself, then another, and for how long it has been so.
    const auto [pushed, late, is_named] = GENERATE(
        table<int, Duration, bool>({{-1, 0ms, true}, {2, 0ms, false}, {2, 1200ms, true}, {3, 0ms, true}}));
    CAPTURE(pushed, to_seconds(late), is_named);
    const AuditTotals totals = tampered([&, robot_pushed = pushed, after = late](History& h) {
      const Time push = h.messages.front().at + 1500ms;
      const RobotId moved = a_switch(h).robot;
      h.each<msg::GroundTruth>([&](msg::GroundTruth& truth, Time at) {
        if (at < push + after || at > push + after + 500ms) return;
        for (msg::TruthRobot& robot : truth.robots()) {
          if (robot.robot() == moved) robot.x_m(robot.x_m() + 0.02);
        }
      });
      if (robot_pushed >= 0) h.push(static_cast<RobotId>(robot_pushed), push);
    });
    INFO(lines(totals));
    CHECK((count(totals, AuditRule::kPlace) > 0) == is_named);
    CHECK((totals.places_by_hand > 0) == !is_named);
  }
  SECTION("a contact long after a push, by who hears badly too") {
    const bool hears_all = GENERATE(true, false);
    CAPTURE(hears_all);
    History history = crossing();
    const Time push = history.messages.front().at + 500ms;
    history.push(2, push);
    history.each<msg::GroundTruth>([&](msg::GroundTruth& truth, Time at) {
      if (at < push + 2s) return;
      truth.contacts(1);
      truth.touches()[0].first(2);
      truth.touches()[0].second(3);
    });
    const AuditTotals totals = audit_of(history, hears_all ? kComplete : AuditTrace{});
    CHECK(count(totals, AuditRule::kContact) > 0);
  }
  SECTION("who touches one that was pushed and has parted from it, and who touches that one") {
    // The last pair, and how many contacts are by hand and how many are not.
    const auto [first, second, by_hand, own] = GENERATE(table<RobotId, RobotId, std::uint64_t, std::uint64_t>(
        {{4, 5, 3, 0}, {0, 1, 2, 1}, {5, msg::NO_ROBOT, 3, 0}, {1, msg::NO_ROBOT, 2, 1}}));
    CAPTURE(first, second);
    const AuditTotals totals = tampered([a = first, b = second](History& h) {
      const Time push = h.messages.front().at + 1500ms;
      h.push(2, push);
      h.each<msg::GroundTruth>([&](msg::GroundTruth& truth, Time at) {
        if (at < push + 100ms) return;
        truth.contacts(3);
        const std::pair<RobotId, RobotId> pairs[] = {{2, 5}, {4, 5}, {a, b}};
        for (std::size_t i = 0; i < 3; ++i) {
          truth.touches()[i].first(pairs[i].first);
          truth.touches()[i].second(pairs[i].second);
        }
      });
    });
    INFO(lines(totals));
    CHECK(totals.contacts_by_hand == by_hand);
    CHECK(count(totals, AuditRule::kContact) == own);
  }
  SECTION("a contact") {
    require_caught(AuditRule::kContact, [](History& h) {
      h.each<msg::GroundTruth>([](msg::GroundTruth& truth, Time) { truth.contacts(1); });
    });
  }
  SECTION("a moving robot that something touches") {
    require_caught(AuditRule::kCrash, [](History& h) {
      h.each<msg::GroundTruth>([](msg::GroundTruth& truth, Time) { truth.moving_crashes(1); });
    });
  }
  SECTION("what the simulator's judge has seen") {
    require_caught(AuditRule::kFirmwareMonitor, [](History& h) {
      h.each<msg::GroundTruth>([](msg::GroundTruth& truth, Time) { truth.firmware_violations(2); });
    });
  }
}

}  // namespace sidestep
