// SPDX-License-Identifier: Apache-2.0
// An unmodified history breaks no rule. If one detail of it is modified, the audit must report the rule that
// the modification breaks.
#include "deploy/audit/auditor.hpp"

#include <algorithm>

#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/tampering.hpp"

namespace sidestep::auditor_test {

using namespace std::chrono_literals;

msg::AbsenceAttestation attestation_of(RobotId robot) {
  msg::AbsenceAttestation attestation;
  attestation.robot(robot);
  return attestation;
}

TEST_CASE("an unmodified history breaks no rule") {
  const AuditTotals totals = audit_of(crossing(), kComplete);
  INFO(lines(totals));
  CHECK(totals.violations == 0);
  CHECK(totals.missed == 0);
  CHECK(totals.invalid == 0);
  CHECK(totals.undecided_pairs == 0);
  CHECK(totals.compared_pairs > 1000);
}

TEST_CASE("an unmodified history that is received incompletely raises no false alarm") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u);
  const double loss = GENERATE(0.0, 0.1, 0.5);
  const Duration joined_after = GENERATE(Duration{0}, Duration{1'700'000'000});
  CAPTURE(seed, loss, to_seconds(joined_after));
  const AuditTotals totals = audit_of(degraded(crossing(), seed, loss, joined_after), {});
  INFO(lines(totals));
  CHECK(totals.violations == 0);
  CHECK(totals.received > 1000);
  CHECK(totals.compared_pairs > 25);
  if (loss > 0) CHECK(totals.missed > 100);
}

// Whether the audit finds versions too close to each other if they must keep `more_m` more distance.
bool is_too_close(MessageHistory history, const AuditInput& input, double more_m) {
  history.scenario.margin_m += more_m;
  return count(audit_of(history, input), AuditRule::kClearance) > 0;
}

// The distance by which the closest versions of the unmodified crossing exceed the distance that they must
// keep.
double slack_of_closest_m() {
  double slack_m = 0, too_much_m = 0.05;
  REQUIRE_FALSE(is_too_close(crossing(), kComplete, slack_m));
  REQUIRE(is_too_close(crossing(), kComplete, too_much_m));
  while (too_much_m - slack_m > 1e-6) {
    const double middle_m = (slack_m + too_much_m) / 2;
    (is_too_close(crossing(), kComplete, middle_m) ? too_much_m : slack_m) = middle_m;
  }
  return slack_m;
}

TEST_CASE("versions too close to each other are found even in an incomplete history") {
  // Equivalent to granting the closest versions with 1 mm too little margin, or with 5 mm if some were lost.
  const double slack_m = slack_of_closest_m();
  CAPTURE(slack_m);
  CHECK(is_too_close(crossing(), kComplete, slack_m + 0.001));
  CHECK(is_too_close(degraded(crossing(), 5, 0.2, Duration{0}), {}, slack_m + 0.005));
}

TEST_CASE("the inflations of both robots add to the distance that their versions must keep") {
  const double slack_m = slack_of_closest_m();
  CAPTURE(slack_m);
  const auto is_too_close_with = [&](double inflation_m) {
    MessageHistory history = crossing();
    history.each_version([&](msg::Version& version) { version.inflation_m(inflation_m); });
    return is_too_close(history, kComplete, slack_m - 0.001);
  };
  // Only the sum of both inflations exceeds the remaining slack of 1 mm.
  CHECK_FALSE(is_too_close_with(0.00045));
  CHECK(is_too_close_with(0.00055));
}

TEST_CASE("each wrong grant is reported under its rule") {
  SECTION("one version number has two trajectories") {
    require_violation(AuditRule::kUniqueVersion, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
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
  SECTION("the base is unknown") {
    require_violation(AuditRule::kBase, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.for_each_copy(s.robot, s.number, [&](msg::Version& v) { v.base(s.before - 1); });
    });
  }
  SECTION("the version does not continue its base") {
    require_violation(AuditRule::kContinuity, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.for_each_copy(s.robot, s.number, [&](msg::Version& v) { v.x_m(v.x_m() + 1e-5); });
    });
  }
  SECTION("the acceleration is too high") {
    require_violation(AuditRule::kLimits, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.for_each_copy(s.robot, s.number, [](msg::Version& v) {
        for (msg::MotionPhase& phase : v.phases()) phase.ax_mps2(phase.ax_mps2() + 6);
      });
    });
  }
  SECTION("the version accelerates at D once its velocity has reversed") {
    require_violation(AuditRule::kLimits, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.for_each_copy(s.robot, s.number, [](msg::Version& v) {
        const Vec2 velocity(v.vx_mps(), v.vy_mps());
        const double d_mps2 = 4.9, braking_s = velocity.norm() / d_mps2;
        REQUIRE(braking_s > 0.02);
        const Vec2 braking = -velocity / braking_s;
        const auto ns = static_cast<std::int64_t>(braking_s * 1e9);
        msg::MotionPhase phase;
        phase.duration_ns(2 * ns);
        phase.ax_mps2(braking.x());
        phase.ay_mps2(braking.y());
        v.phases()[0] = phase;
        phase.duration_ns(ns);
        phase.ax_mps2(-braking.x());
        phase.ay_mps2(-braking.y());
        v.phases()[1] = phase;
        v.phase_count(2);
      });
    });
  }
  SECTION("the version does not brake at the end") {
    require_violation(AuditRule::kRest, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.for_each_copy(s.robot, s.number,
                      [](msg::Version& v) { v.phase_count(static_cast<std::uint8_t>(v.phase_count() - 1)); });
    });
  }
  SECTION("the version leaves the field") {
    require_violation(AuditRule::kField, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.for_each_copy(s.robot, s.number, [&](msg::Version& v) { v.x_m(h.scenario.field.length_m / 2); });
    });
  }
  SECTION("the version leads through an obstacle") {
    require_violation(AuditRule::kObstacle, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      const Vec2 centre_m = sidestep::centre_m(h.scenario.obstacles.front());
      h.for_each_copy(s.robot, s.number, [&](msg::Version& v) { v.x_m(centre_m.x()), v.y_m(centre_m.y()); });
    });
  }
  SECTION("the version leads through a blocked map cell") {
    require_violation(AuditRule::kObstacle, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      const Vec2 at_m(h.scenario.field.length_m / 4, h.scenario.field.width_m / 4);
      MapGrid grid;
      grid.columns = grid.rows = 400, grid.resolution_m = 0.05, grid.origin_m = {-10, -10};
      BitGrid blocked(grid.columns, grid.rows);
      const Cell cell = grid.cell_at(at_m);
      blocked.set(cell.column, cell.row);
      h.scenario.obstacles.clear();
      h.scenario.map = std::make_shared<const FloorMap>(OccupancyMap(grid, blocked));
      h.for_each_copy(s.robot, s.number, [&](msg::Version& v) { v.x_m(at_m.x()), v.y_m(at_m.y()); });
    });
  }
  SECTION("the version has an inflation that its base does not have") {
    require_violation(AuditRule::kInflation, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.for_each_copy(s.robot, s.number, [](msg::Version& v) { v.inflation_m(0.001); });
    });
  }
  SECTION("the base has a higher number than the version") {
    require_violation(AuditRule::kVersionOrder, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.for_each_copy(s.robot, s.number, [](msg::Version& v) { v.base(v.version_number() + 1); });
    });
  }
  SECTION("the version was not proposed") {
    require_violation(AuditRule::kProposed, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.each<msg::Verdict>([&](msg::Verdict& v, Time) {
        if (v.robot() == s.robot && v.granted_version() == s.number) v.granted_version(s.number + 100);
      });
    });
  }
  SECTION("a robot has not registered yet") {
    require_violation(AuditRule::kAllRegistered, [](MessageHistory& h) {
      h.remove_if<msg::Registration>([](const msg::Registration& r) { return r.robot() == 3; });
    });
  }
  SECTION("an unregistered robot was attested absent too late") {
    require_violation(AuditRule::kAllRegistered, [](MessageHistory& h) {
      h.remove_if<msg::Registration>([](const msg::Registration& r) { return r.robot() == 3; });
      h.messages.push_back({h.messages.back().at, attestation_of(3)});
    });
  }
  SECTION("a robot obeys an older epoch") {
    const AuditTotals totals = [] {
      MessageHistory history = crossing();
      history.each<msg::Feedback>([](msg::Feedback& f, Time) {
        if (f.robot() == 3) f.obeyed_epoch(0);
      });
      return audit_of(degraded(history, 1, 0.1, Duration{0}), {});
    }();
    CHECK(count(totals, AuditRule::kAllRegistered) == 1);
  }
  SECTION("two coordinators grant in one epoch") {
    require_violation(AuditRule::kSingleCoordinator, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.each<msg::Verdict>([&](msg::Verdict& v, Time) {
        if (v.robot() == s.robot && v.granted_version() == s.number)
          v.header().incarnation(v.header().incarnation() + 1);
      });
    });
  }
  SECTION("the ledger drops a version that no robot report has excluded") {
    require_violation(AuditRule::kLedgerPage, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.each<msg::LedgerPage>([&](msg::LedgerPage& page, Time) {
        std::erase_if(page.versions(), [&](const msg::Version& v) {
          return v.robot() == s.robot && v.version_number() == s.number;
        });
      });
    });
  }
  SECTION("the ledger lists a version that was not granted") {
    require_violation(AuditRule::kLedgerPage, [](MessageHistory& h) {
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

TEST_CASE("each breach by an agent is reported under its rule") {
  SECTION("the registration lacks the version that the robot executes") {
    require_violation(AuditRule::kRegistration, [](MessageHistory& h) {
      h.each<msg::Registration>([](msg::Registration& r, Time) {
        if (r.robot() == 1) r.versions()[0].version_number(5);
      });
    });
  }
  SECTION("the agent registers before the robot has acknowledged it") {
    require_violation(AuditRule::kAcknowledged, [](MessageHistory& h) {
      h.each<msg::Registration>([](msg::Registration& r, Time) {
        if (r.robot() == 1) r.header().incarnation(r.header().incarnation() + 1);
      });
    });
  }
  SECTION("the agent sends a command that was not granted") {
    require_violation(AuditRule::kForwarded, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.each<msg::Command>([&](msg::Command& c, Time) {
        if (c.robot() == s.robot && c.has_version() && c.version().version_number() == s.number)
          c.version().version_number(s.number + 1000);
      });
    });
  }
  SECTION("the agent sends a candidate that was not granted, in an incomplete history") {
    MessageHistory history = crossing();
    const Switch s = first_moving_switch(history);
    history.each<msg::Verdict>([&](msg::Verdict& v, Time) {
      if (v.robot() == s.robot && v.granted_version() == s.number) v.granted_version(s.number + 1);
    });
    const AuditTotals totals = audit_of(degraded(history, 2, 0, Duration{0}), {});
    INFO(lines(totals));
    CHECK(count(totals, AuditRule::kForwarded) == 1);
  }
  SECTION("the agent sends commands under a lower epoch") {
    require_violation(AuditRule::kEpochRegression, [](MessageHistory& h) {
      const Switch s = first_moving_switch(h);
      h.each<msg::Command>([&](msg::Command& c, Time at) {
        if (c.robot() == s.robot && to_ns(at) > s.start_ns) c.epoch(c.epoch() - 1);
      });
    });
  }
}

TEST_CASE("a verdict that is repeated much later breaks no rule") {
  const AuditTotals totals = audit_tampered_crossing([](MessageHistory& h) {
    const Switch s = first_moving_switch(h);
    const auto is_grant = [&](const ReceivedMessage& m) {
      const auto* verdict = std::get_if<msg::Verdict>(&m.message);
      return verdict && verdict->robot() == s.robot && verdict->granted_version() == s.number;
    };
    const ReceivedMessage grant = *std::ranges::find_if(h.messages, is_grant);
    const Time later = grant.at + 2s;
    const auto place = std::ranges::find_if(h.messages, [&](const auto& m) { return m.at >= later; });
    REQUIRE(place != h.messages.end());
    h.messages.insert(place, {later, grant.message});
  });
  INFO(lines(totals));
  CHECK(totals.violations == 0);
}

TEST_CASE("a granted version stays granted even if a later agent's proposal with its number is denied") {
  // A restarted agent may reuse the last numbers of its predecessor.
  const std::uint64_t numbers_before = GENERATE(0u, 2u);
  const AuditTotals totals = audit_tampered_crossing([&](MessageHistory& h) {
    const Switch s = first_moving_switch(h);
    std::optional<msg::Proposal> proposal;
    h.each<msg::Proposal>([&](msg::Proposal& p, Time) {
      if (p.robot() == s.robot && p.candidates().front().version_number() == s.number) proposal = p;
    });
    REQUIRE(proposal);
    proposal->header().incarnation(proposal->header().incarnation() + 1);
    proposal->candidate_count(5);
    for (std::size_t i = 0; i < 5; ++i) {
      proposal->candidates()[i] = proposal->candidates()[0];
      proposal->candidates()[i].incarnation(proposal->header().incarnation());
      proposal->candidates()[i].version_number(s.number - numbers_before + i);
    }
    const auto is_sent = [&](const ReceivedMessage& m) {
      const auto* command = std::get_if<msg::Command>(&m.message);
      return command && command->robot() == s.robot && command->has_version() &&
             command->version().version_number() == s.number;
    };
    const auto sent = std::ranges::find_if(h.messages, is_sent);
    REQUIRE(sent != h.messages.end());
    msg::Verdict verdict;
    verdict.robot(s.robot);
    verdict.epoch(proposal->epoch());
    verdict.proposal_number(s.number - numbers_before);
    verdict.reasons().fill(msg::Reason::REASON_CONFLICT);
    const Time at = sent->at;
    h.messages.insert(h.messages.insert(sent + 1, {at, verdict}), {at, *proposal});
  });
  INFO(lines(totals));
  CHECK(totals.violations == 0);
}

TEST_CASE("an operator's attestation of absence replaces a robot's registration") {
  const AuditTotals totals = audit_tampered_crossing([](MessageHistory& h) {
    h.remove_if<msg::Registration>([](const msg::Registration& r) { return r.robot() == 3; });
    h.remove_if<msg::Feedback>([](const msg::Feedback& f) { return f.robot() == 3; });
    h.messages.insert(h.messages.begin(), {h.messages.front().at, attestation_of(3)});
  });
  INFO(lines(totals));
  CHECK(count(totals, AuditRule::kAllRegistered) == 0);
}

TEST_CASE("an attested absence stays valid in its epoch even if the agent registers in an older epoch") {
  const bool is_in_time = GENERATE(true, false);
  CAPTURE(is_in_time);
  const AuditTotals totals = audit_tampered_crossing([&](MessageHistory& h) {
    std::optional<msg::Registration> late;
    h.each<msg::Registration>([&](const msg::Registration& r, Time) {
      if (r.robot() == 3) late = r;
    });
    REQUIRE(late);
    const Epoch epoch = late->epoch();
    late->epoch(epoch - 1);
    h.remove_if<msg::Registration>([](const msg::Registration& r) { return r.robot() == 3; });
    h.remove_if<msg::Feedback>([](const msg::Feedback& f) { return f.robot() == 3; });
    // Inserts the attestation after the epoch has begun, or before.
    auto at = h.messages.begin();
    if (is_in_time) {
      at = std::ranges::find_if(h.messages, [&](const ReceivedMessage& received) {
        const auto* state = std::get_if<msg::CoordinatorState>(&received.message);
        return state && state->epoch() == epoch;
      });
      REQUIRE(at++ != h.messages.end());
    }
    const Time sent_at = is_in_time ? std::prev(at)->at : at->at;
    at = h.messages.insert(at, {sent_at, attestation_of(3)});
    h.messages.insert(at + 1, {sent_at, *late});
  });
  INFO(lines(totals));
  CHECK(count(totals, AuditRule::kAllRegistered) == (is_in_time ? 0 : 1));
}

TEST_CASE("a coordinator that resumes after many epochs may use its old registrations") {
  const AuditTotals totals = audit_tampered_crossing([](MessageHistory& h) {
    // Adds forty successive coordinators with which every agent registers.
    std::vector<ReceivedMessage> messages;
    for (const ReceivedMessage& received : h.messages) {
      messages.push_back(received);
      const auto* registration = std::get_if<msg::Registration>(&received.message);
      if (!registration) continue;
      for (Epoch before = 1; before <= 40; ++before) {
        msg::Registration other = *registration;
        other.epoch(registration->epoch() - before);
        messages.push_back({received.at, other});
      }
    }
    REQUIRE(messages.size() >= h.messages.size() + 40);
    h.messages = std::move(messages);
  });
  INFO(lines(totals));
  CHECK(totals.violations == 0);
}

TEST_CASE("an epoch memory holds the highest epochs and knows which lower epochs it may have evicted") {
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

TEST_CASE("invalid messages are counted and otherwise ignored") {
  const AuditTotals totals = audit_tampered_crossing([](MessageHistory& h) {
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

}  // namespace sidestep::auditor_test
