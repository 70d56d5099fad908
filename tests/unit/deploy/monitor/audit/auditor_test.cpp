// SPDX-License-Identifier: Apache-2.0
// A true history is judged without a word. Then somebody tampers with one thing at a time, and the rule that
// this breaks has to be named.
#include "deploy/monitor/audit/auditor.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/unit/deploy/monitor/audit/tampering.hpp"

namespace sidestep {

using namespace std::chrono_literals;

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
  const AuditTotals totals = audit_of(history, hears_badly ? AuditTrace{} : kComplete);
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
        for (msg::MotionPhase& phase : v.phases()) phase.ax_mps2(phase.ax_mps2() + 6);
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
    require_caught(AuditRule::kInflation, [](History& h) {
      const Switch s = a_switch(h);
      h.each_mention(s.robot, s.number, [](msg::Version& v) { v.inflation_m(0.001); });
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

TEST_CASE("a grant that is said once more long after breaks no rule") {
  const AuditTotals totals = tampered([](History& h) {
    const Switch s = a_switch(h);
    const auto is_grant = [&](const HeardMessage& m) {
      const auto* verdict = std::get_if<msg::Verdict>(&m.message);
      return verdict && verdict->robot() == s.robot && verdict->granted() == s.number;
    };
    const HeardMessage grant = *std::ranges::find_if(h.messages, is_grant);
    const Time later = grant.at + 2s;
    const auto place = std::ranges::find_if(h.messages, [&](const auto& m) { return m.at >= later; });
    REQUIRE(place != h.messages.end());
    h.messages.insert(place, {later, grant.message});
  });
  INFO(lines(totals));
  CHECK(totals.violations == 0);
}

TEST_CASE("a coordinator that wakes up after many epochs keeps what was registered with it") {
  const AuditTotals totals = tampered([](History& h) {
    // As if coordinators had come and gone: every agent registered with forty more of them.
    std::vector<HeardMessage> messages;
    for (const HeardMessage& heard : h.messages) {
      messages.push_back(heard);
      const auto* registration = std::get_if<msg::Registration>(&heard.message);
      if (!registration) continue;
      for (Epoch before = 1; before <= 40; ++before) {
        msg::Registration other = *registration;
        other.epoch(registration->epoch() - before);
        messages.push_back({heard.at, other});
      }
    }
    REQUIRE(messages.size() >= h.messages.size() + 40);
    h.messages = std::move(messages);
  });
  INFO(lines(totals));
  CHECK(totals.violations == 0);
}

TEST_CASE("the highest epochs are remembered and of lower ones that there were some") {
  EpochMemory memory;
  CHECK_FALSE(memory.may_have_held(0));
  CHECK_FALSE(memory.may_have_held(1));
  for (Epoch epoch = 10; epoch <= 400; epoch += 10) memory.add(epoch);
  CHECK(memory.holds(400));
  CHECK(memory.holds(250));
  CHECK_FALSE(memory.holds(240));
  CHECK(memory.may_have_held(240));
  CHECK(memory.may_have_held(10));
  CHECK_FALSE(memory.may_have_held(255));
  CHECK_FALSE(memory.may_have_held(410));
  memory.add(20);
  CHECK_FALSE(memory.may_have_held(255));
  CHECK(memory.holds(250));
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
