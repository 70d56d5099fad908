// SPDX-License-Identifier: Apache-2.0
// A true history is judged without a word. Then somebody tampers with one thing at a time, and the rule that
// this breaks has to be named.
#include "deploy/audit/auditor.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "common/config/scenario_loader.hpp"
#include "tests/unit/deploy/audit/history.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

const History& crossing() {
  static const History history = [] {
    Scenario scenario = load_scenario(SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml");
    return history_of(scenario, 3, 4s);
  }();
  return history;
}

constexpr AuditHearing kComplete{true, {}};

std::uint64_t count(const AuditTotals& totals, AuditRule rule) {
  return totals.by_rule[static_cast<std::size_t>(rule)];
}

/// A version that a robot switches to in full motion, and what surrounds that.
struct Switch {
  RobotId robot;
  VersionNumber number, before;
  std::int64_t start_ns;
  msg::Version version;
};

Switch a_switch(History& history) {
  std::map<RobotId, std::vector<msg::Version>> executed;
  history.each<msg::Feedback>([&](msg::Feedback& f, Time) {
    auto& list = executed[f.robot()];
    if (list.empty() || list.back().version_number() != f.executing().version_number())
      list.push_back(f.executing());
  });
  const auto& list = executed.at(2);
  REQUIRE(list.size() > 60);
  const msg::Version& to = list[50];
  return {2, to.version_number(), list[49].version_number(), to.start_ns(), to};
}

/// Tampers with a copy of the true history, and hears it.
AuditTotals tampered(const std::function<void(History&)>& tamper) {
  History history = crossing();
  tamper(history);
  return audit_of(history, kComplete);
}

void require_caught(AuditRule rule, const std::function<void(History&)>& tamper) {
  const AuditTotals totals = tampered(tamper);
  INFO(audit_rule(rule).name << " expected; found:\n" << lines(totals));
  REQUIRE(count(totals, rule) > 0);
}

}  // namespace

TEST_CASE("a true history is judged without a word") {
  const AuditTotals totals = audit_of(crossing(), kComplete);
  INFO(lines(totals));
  CHECK(totals.violations == 0);
  CHECK(totals.missed == 0);
  CHECK(totals.invalid == 0);
  CHECK(totals.unjudged == 0);
  CHECK(totals.pairs > 1000);
}

TEST_CASE("a true history that is heard badly is judged without a word too") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u);
  const double loss = GENERATE(0.0, 0.1, 0.5);
  const Duration joined_after = GENERATE(Duration{0}, Duration{1'700'000'000});
  CAPTURE(seed, loss, to_seconds(joined_after));
  const AuditTotals totals = audit_of(badly_heard(crossing(), seed, loss, joined_after), {});
  INFO(lines(totals));
  CHECK(totals.violations == 0);
  CHECK(totals.heard > 1000);
  CHECK(totals.pairs > 25);
  if (loss > 0) CHECK(totals.missed > 100);
}

TEST_CASE("versions too near to each other are found, also by those who hear badly") {
  const bool hears_badly = GENERATE(false, true);
  CAPTURE(hears_badly);
  History history = hears_badly ? badly_heard(crossing(), 5, 0.2, Duration{0}) : crossing();
  // As if they had all been granted with half a centimetre too little.
  history.scenario.margin_m += 0.005;
  const AuditTotals totals = audit_of(history, hears_badly ? AuditHearing{} : kComplete);
  CHECK(count(totals, AuditRule::kClearance) > 0);
}

TEST_CASE("every breach of what may be granted is named") {
  SECTION("a number that means two trajectories") {
    require_caught(AuditRule::kOneMeaning, [](History& h) {
      const Switch s = a_switch(h);
      bool is_done = false;
      h.each<msg::LedgerPage>([&](msg::LedgerPage& page, Time) {
        for (msg::Version& v : page.versions()) {
          if (is_done || v.robot() != s.robot || v.version_number() != s.number) continue;
          v.x_m(v.x_m() + 1e-6);
          is_done = true;
        }
      });
    });
  }
  SECTION("a base that nobody knows") {
    require_caught(AuditRule::kBase, [](History& h) {
      const Switch s = a_switch(h);
      h.each_mention(s.robot, s.number, [&](msg::Version& v) { v.base(s.before - 1); });
    });
  }
  SECTION("a jump from the base") {
    require_caught(AuditRule::kContinuity, [](History& h) {
      const Switch s = a_switch(h);
      h.each_mention(s.robot, s.number, [&](msg::Version& v) { v.x_m(v.x_m() + 1e-5); });
    });
  }
  SECTION("too much acceleration") {
    require_caught(AuditRule::kLimits, [](History& h) {
      const Switch s = a_switch(h);
      h.each_mention(s.robot, s.number, [](msg::Version& v) {
        for (msg::Phase& phase : v.phases()) phase.ax_mps2(phase.ax_mps2() + 6);
      });
    });
  }
  SECTION("no braking at the end") {
    require_caught(AuditRule::kRest, [](History& h) {
      const Switch s = a_switch(h);
      h.each_mention(s.robot, s.number,
                     [](msg::Version& v) { v.phase_count(static_cast<std::uint8_t>(v.phase_count() - 1)); });
    });
  }
  SECTION("over the edge") {
    require_caught(AuditRule::kFloor, [](History& h) {
      const Switch s = a_switch(h);
      h.each_mention(s.robot, s.number, [&](msg::Version& v) { v.x_m(h.scenario.field.length_m / 2); });
    });
  }
  SECTION("through an obstacle") {
    require_caught(AuditRule::kObstacle, [](History& h) {
      const Switch s = a_switch(h);
      const Vec2 there = h.scenario.obstacles.front().centre_m;
      h.each_mention(s.robot, s.number, [&](msg::Version& v) { v.x_m(there.x()), v.y_m(there.y()); });
    });
  }
  SECTION("growth out of nothing") {
    require_caught(AuditRule::kGrowth, [](History& h) {
      const Switch s = a_switch(h);
      h.each_mention(s.robot, s.number, [](msg::Version& v) { v.grown_m(0.001); });
    });
  }
  SECTION("a base above the version") {
    require_caught(AuditRule::kNumbers, [](History& h) {
      const Switch s = a_switch(h);
      h.each_mention(s.robot, s.number, [](msg::Version& v) { v.base(v.version_number() + 1); });
    });
  }
  SECTION("what nobody has proposed") {
    require_caught(AuditRule::kProposed, [](History& h) {
      const Switch s = a_switch(h);
      h.each<msg::Verdict>([&](msg::Verdict& v, Time) {
        if (v.robot() == s.robot && v.granted() == s.number) v.granted(s.number + 100);
      });
    });
  }
  SECTION("before a robot has registered") {
    require_caught(AuditRule::kAllRegistered, [](History& h) {
      h.remove_if<msg::Registration>([](const msg::Registration& r) { return r.robot() == 3; });
    });
  }
  SECTION("while a robot obeys an older epoch") {
    const AuditTotals totals = [] {
      History history = crossing();
      history.each<msg::Feedback>([](msg::Feedback& f, Time) {
        if (f.robot() == 3) f.obeyed_epoch(0);
      });
      return audit_of(badly_heard(history, 1, 0.1, Duration{0}), {});
    }();
    CHECK(count(totals, AuditRule::kAllRegistered) == 1);
  }
  SECTION("by two coordinators in one epoch") {
    require_caught(AuditRule::kOneCoordinator, [](History& h) {
      const Switch s = a_switch(h);
      h.each<msg::Verdict>([&](msg::Verdict& v, Time) {
        if (v.robot() == s.robot && v.granted() == s.number) v.head().incarnation(v.head().incarnation() + 1);
      });
    });
  }
  SECTION("a ledger that forgets a version without a fact") {
    require_caught(AuditRule::kLedgerPage, [](History& h) {
      const Switch s = a_switch(h);
      h.each<msg::LedgerPage>([&](msg::LedgerPage& page, Time) {
        std::erase_if(page.versions(), [&](const msg::Version& v) {
          return v.robot() == s.robot && v.version_number() == s.number;
        });
      });
    });
  }
  SECTION("a ledger with a version that nobody granted") {
    require_caught(AuditRule::kLedgerPage, [](History& h) {
      bool is_done = false;
      h.each<msg::LedgerPage>([&](msg::LedgerPage& page, Time) {
        if (std::exchange(is_done, true)) return;
        msg::Version version = page.versions().front();
        version.version_number(version.version_number() + 77);
        page.versions().push_back(version);
      });
    });
  }
}

TEST_CASE("every breach of an agent's duties is named") {
  SECTION("a registration without what the robot executes") {
    require_caught(AuditRule::kRegistration, [](History& h) {
      h.each<msg::Registration>([](msg::Registration& r, Time) {
        if (r.robot() == 1) r.versions()[0].version_number(5);
      });
    });
  }
  SECTION("a registration before the robot has acknowledged the agent") {
    require_caught(AuditRule::kAcknowledged, [](History& h) {
      h.each<msg::Registration>([](msg::Registration& r, Time) {
        if (r.robot() == 1) r.head().incarnation(r.head().incarnation() + 1);
      });
    });
  }
  SECTION("a command that was not granted") {
    require_caught(AuditRule::kForwarded, [](History& h) {
      const Switch s = a_switch(h);
      h.each<msg::Command>([&](msg::Command& c, Time) {
        if (c.robot() == s.robot && c.has_version() && c.granted().version_number() == s.number)
          c.granted().version_number(s.number + 1000);
      });
    });
  }
  SECTION("a command although the verdict granted another candidate, heard badly") {
    History history = crossing();
    const Switch s = a_switch(history);
    history.each<msg::Verdict>([&](msg::Verdict& v, Time) {
      if (v.robot() == s.robot && v.granted() == s.number) v.granted(s.number + 1);
    });
    const AuditTotals totals = audit_of(badly_heard(history, 2, 0, Duration{0}), {});
    INFO(lines(totals));
    CHECK(count(totals, AuditRule::kForwarded) == 1);
  }
  SECTION("commands under a lower epoch") {
    require_caught(AuditRule::kEpochBack, [](History& h) {
      const Switch s = a_switch(h);
      h.each<msg::Command>([&](msg::Command& c, Time at) {
        if (c.robot() == s.robot && to_ns(at) > s.start_ns) c.epoch(c.epoch() - 1);
      });
    });
  }
}

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
      if (robot_pushed < 0) return;
      msg::Disturbance hand;
      hand.robot(static_cast<RobotId>(robot_pushed));
      hand.disturbance_kind(msg::DISTURBANCE_PUSH);
      const auto place = std::ranges::find_if(h.messages, [&](const auto& m) { return m.at >= push; });
      h.messages.insert(place, {push, hand});
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
    msg::Disturbance hand;
    hand.robot(2);
    hand.disturbance_kind(msg::DISTURBANCE_PUSH);
    const auto place = std::ranges::find_if(history.messages, [&](const auto& m) { return m.at >= push; });
    history.messages.insert(place, {push, hand});
    history.each<msg::GroundTruth>([&](msg::GroundTruth& truth, Time at) {
      if (at < push + 2s) return;
      truth.contacts(1);
      // The pushed robot is beside another one.
      truth.robots()[2].x_m(truth.robots()[3].x_m() + 0.18);
      truth.robots()[2].y_m(truth.robots()[3].y_m());
    });
    const AuditTotals totals = audit_of(history, hears_all ? kComplete : AuditHearing{});
    CHECK(count(totals, AuditRule::kContact) > 0);
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
    require_caught(AuditRule::kFirmwareJudge, [](History& h) {
      h.each<msg::GroundTruth>([](msg::GroundTruth& truth, Time) { truth.firmware_violations(2); });
    });
  }
}

TEST_CASE("messages that make no sense are counted and tell nothing") {
  const AuditTotals totals = tampered([](History& h) {
    int number = 0;
    h.each<msg::Feedback>([&](msg::Feedback& f, Time) {
      if (++number % 100 == 0) f.x_m(std::nan(""));
    });
    h.each<msg::Proposal>([&](msg::Proposal& p, Time) {
      if (++number % 200 == 0) p.candidate_count(200);
    });
    h.each<msg::Registration>([&](msg::Registration& r, Time) {
      msg::Registration stranger = r;
      stranger.robot(4'000'000'000);
      r = r.robot() == 99 ? stranger : r;
    });
  });
  CHECK(totals.invalid > 10);
}

}  // namespace sidestep
