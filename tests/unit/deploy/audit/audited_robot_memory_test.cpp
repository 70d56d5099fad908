// SPDX-License-Identifier: Apache-2.0
// The bounded memories of an audited robot, compared with slow and simple references.
#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "common/random/rng.hpp"
#include "deploy/audit/audited_robot.hpp"
#include "tests/catch.hpp"

namespace sidestep::audited_robot_memory_test {

TEST_CASE("an epoch memory agrees with a complete set of epochs about the sixteen highest epochs") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    EpochMemory memory;
    std::set<Epoch, std::greater<>> all;
    CHECK(memory.is_empty());
    for (int step = 0; step < 60; ++step) {
      const Epoch added = rng.below(80);
      memory.add(added);
      if (added != 0) all.insert(added);
      CHECK(memory.is_empty() == all.empty());
      const Epoch evicted = all.size() > 16 ? *std::next(all.begin(), 16) : 0;
      for (Epoch epoch = 0; epoch < 82; ++epoch) {
        CAPTURE(step, epoch);
        const bool is_held = all.contains(epoch) && epoch > evicted;
        CHECK(memory.holds(epoch) == is_held);
        CHECK(memory.may_have_held(epoch) == (is_held || (epoch != 0 && epoch <= evicted)));
      }
    }
  }
}

TEST_CASE("an own stop belongs only to the epoch whose ledger listed it, even if registered in others") {
  KnownVersion known;
  for (Epoch epoch = 10; epoch <= 200; epoch += 10) known.registered_in.add(epoch);
  known.granted_in = 3;
  for (const bool is_own_stop : {false, true}) {
    known.is_own_stop = is_own_stop;
    CHECK(known.is_in(3));
    CHECK(known.may_be_in(3));
    CHECK(known.is_in(200) == !is_own_stop);
    CHECK(known.may_be_in(200) == !is_own_stop);
    CHECK_FALSE(known.is_in(30));
    CHECK(known.may_be_in(30) == !is_own_stop);
    CHECK_FALSE(known.is_in(205));
    CHECK_FALSE(known.may_be_in(205));
  }
}

/// A slow reference for the version memory, which copies and sorts at every step.
struct SlowVersions {
  struct Entry {
    bool is_excluded = false;
    std::int64_t excluded_ns = kNever;
    bool is_recent = true;
    bool may_be_incomplete = false;
  };

  void insert(VersionNumber number) {
    if (entries.contains(number)) return;
    const bool may_be_incomplete =
        std::ranges::any_of(evicted_numbers, [number](VersionNumber n) { return n >= number; });
    if (entries.size() >= AuditedRobot::kMaxVersions) {
      auto evicted = std::ranges::find_if(entries, [](const auto& e) { return e.second.is_excluded; });
      if (evicted == entries.end()) evicted = entries.begin();
      evicted_numbers.push_back(evicted->first);
      entries.erase(evicted);
    }
    entries[number].may_be_incomplete = may_be_incomplete;
    make_recent(number);
  }
  void make_recent(VersionNumber from) {
    for (auto& [number, entry] : entries) entry.is_recent |= number >= from;
  }
  void advance(std::int64_t since_ns) {
    for (auto& [number, entry] : entries) {
      if (!entry.is_recent) continue;
      if (entry.excluded_ns >= since_ns) return;
      entry.is_recent = false;
    }
  }
  void forget(std::int64_t before_ns) {
    if (entries.empty() || entries.begin()->second.excluded_ns >= before_ns) return;
    std::erase_if(entries, [&](const auto& e) {
      if (e.second.excluded_ns >= before_ns) return false;
      evicted_numbers.push_back(e.first);
      return true;
    });
    make_recent(0);
  }

  VersionNumber max_evicted() const {
    return evicted_numbers.empty() ? 0 : *std::ranges::max_element(evicted_numbers);
  }

  std::map<VersionNumber, Entry> entries;
  std::vector<VersionNumber> evicted_numbers;
};

TEST_CASE("the version memory agrees with a slow reference") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const VersionNumber max_number = rng.chance(0.5) ? 60 : 300;
    AuditedRobot robot;
    SlowVersions slow;
    std::int64_t now_ns = 100;
    for (int step = 0; step < 400; ++step) {
      CAPTURE(step);
      now_ns += 10;
      const VersionNumber number = rng.below(max_number);
      robot.find_or_insert(number);
      slow.insert(number);
      const VersionNumber excluded = rng.below(max_number);
      if (KnownVersion* known = robot.find(excluded); known && known->exclusion == Exclusion::kNone) {
        known->exclusion = Exclusion::kOlder;
        known->excluded_ns = now_ns;
        slow.entries[excluded].is_excluded = true;
        slow.entries[excluded].excluded_ns = now_ns;
      }
      if (rng.chance(0.3)) {
        const std::int64_t since_ns = now_ns - static_cast<std::int64_t>(10 * rng.below(30));
        robot.advance_recent(since_ns);
        slow.advance(since_ns);
      }
      if (rng.chance(0.1)) robot.make_recent(number), slow.make_recent(number);
      if (rng.chance(0.05)) {
        const std::int64_t before_ns = now_ns - static_cast<std::int64_t>(10 * rng.below(100));
        robot.forget(before_ns), slow.forget(before_ns);
      }
      REQUIRE(robot.versions.size() == slow.entries.size());
      CHECK(robot.max_evicted_version == slow.max_evicted());
      std::size_t index = 0;
      for (const auto& [expected, entry] : slow.entries) {
        CHECK(robot.versions[index].number == expected);
        CHECK(robot.find(expected) == &robot.versions[index]);
        CHECK((index >= robot.first_recent) == entry.is_recent);
        ++index;
      }
      const VersionNumber asked = rng.below(max_number);
      const bool is_known = slow.entries.contains(asked);
      CHECK((robot.find(asked) != nullptr) == is_known);
      const bool was_evicted = is_known ? slow.entries[asked].may_be_incomplete : asked <= slow.max_evicted();
      CHECK(robot.was_evicted(asked) == was_evicted);
    }
  }
}

/// Adds an agent's proposal with candidates `number` to `number` + 2.
void propose(AuditedRobot& robot, std::uint64_t number, std::int64_t stamp_ns, Incarnation incarnation) {
  ProposalRecord& record = robot.add_proposal();
  record.number = number;
  record.stamp_ns = stamp_ns;
  record.count = 3;
  for (std::size_t i = 0; i < 4; ++i) {
    // The fourth candidate is left over from an earlier proposal.
    record.candidates[i].version_number(number + i);
    record.candidates[i].incarnation(incarnation);
  }
}

TEST_CASE("the newest matching proposal of the last sixteen is found") {
  AuditedRobot robot;
  CHECK(robot.find_proposal(0) == nullptr);
  for (std::uint64_t i = 1; i <= 40; ++i) {
    // Two agents each propose every number.
    const std::uint64_t number = 10 * ((i + 1) / 2);
    propose(robot, number, static_cast<std::int64_t>(1000 + i), i % 2);
    const std::uint64_t evicted = i > 16 ? i - 16 : 0;
    CHECK(robot.max_evicted_proposal == 10 * ((evicted + 1) / 2));
    for (std::uint64_t j = 1; j <= i; ++j) {
      CAPTURE(i, j);
      const std::uint64_t asked = 10 * ((j + 1) / 2), newest = std::min(i, 2 * ((j + 1) / 2));
      const auto stamp_ns = static_cast<std::int64_t>(1000 + j);
      const ProposalRecord* const found = robot.find_proposal(asked);
      REQUIRE((found != nullptr) == (newest > evicted));
      if (found) CHECK(found->stamp_ns == static_cast<std::int64_t>(1000 + newest));
      const ProposalRecord* const exact = robot.find_proposal(asked, stamp_ns);
      REQUIRE((exact != nullptr) == (j > evicted));
      if (exact) CHECK(exact->stamp_ns == stamp_ns);
      CHECK(robot.find_proposal(asked + 10, stamp_ns) == nullptr);
      msg::Version candidate;
      candidate.incarnation(j % 2);
      for (std::uint64_t k = 0; k < 4; ++k) {
        candidate.version_number(asked + k);
        const ProposalRecord* const of_candidate = robot.find_proposal_of(candidate);
        REQUIRE((of_candidate != nullptr) == (j > evicted && k < 3));
        if (of_candidate) CHECK(of_candidate->stamp_ns == stamp_ns);
      }
    }
  }
  propose(robot, 5, 2000, 0);
  CHECK(robot.max_evicted_proposal == 130);
  CHECK(robot.find_proposal(5)->find(7)->version_number() == 7);
  CHECK(robot.find_proposal(5)->find(8) == nullptr);
  CHECK(robot.find_proposal(5)->find(4) == nullptr);
  for (std::uint64_t i = 0; i < 16; ++i) propose(robot, 6, 3000, 0);
  CHECK(robot.find_proposal(5) == nullptr);
  CHECK(robot.max_evicted_proposal == 200);
}

/// Slow reference: why a robot report excludes a version.
Exclusion reference_exclusion(const AuditedRobot::ReceivedReport& robot_report, const KnownVersion& v) {
  const bool begins_later = v.has_content && v.path.start_ns() > robot_report.at_ns;
  if (robot_report.is_lifted && robot_report.executing == 0) {
    if (!begins_later || v.was_executed) return Exclusion::kLifted;
    const bool rests = v.path.phase_count() == 0;
    if (v.version.base() == 0 && rests && v.number > 0) return Exclusion::kNone;
    return v.version.base() > robot_report.last_executed ? Exclusion::kNone : Exclusion::kLifted;
  }
  if (v.number < robot_report.executing) return Exclusion::kOlder;
  if (v.number > robot_report.executing && v.has_content) {
    if (!begins_later) return Exclusion::kLate;
    if (v.version.incarnation() < robot_report.obeyed_incarnation) return Exclusion::kFenced;
  }
  return Exclusion::kNone;
}

TEST_CASE("a robot report excludes versions for the same reasons as a slow reference") {
  std::map<Exclusion, int> found;
  for (std::uint64_t seed = 1; seed <= 20'000; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    AuditedRobot::ReceivedReport robot_report;
    robot_report.at_ns = static_cast<std::int64_t>(100 + rng.below(3));
    robot_report.is_lifted = rng.chance(0.5);
    robot_report.executing = rng.below(3);
    robot_report.last_executed = rng.below(4);
    robot_report.obeyed_incarnation = 10 + rng.below(3);
    KnownVersion known;
    known.number = rng.below(4);
    known.has_content = rng.chance(0.9);
    known.was_executed = rng.chance(0.2);
    if (known.has_content) {
      known.version.version_number(known.number);
      known.version.base(rng.below(4));
      known.version.start_ns(static_cast<std::int64_t>(100 + rng.below(3)));
      known.version.incarnation(10 + rng.below(3));
      known.version.vx_mps(rng.chance(0.5) ? 1 : 0.001);
      known.version.phase_count(rng.chance(0.5) ? 1 : 0);
      known.version.phases()[0].duration_ns(1'000'000'000);
      known.path = AuditPath(known.version);
    }
    const Exclusion expected = reference_exclusion(robot_report, known);
    ++found[expected];
    CHECK(exclusion_by(robot_report, known) == expected);
  }
  for (const Exclusion e :
       {Exclusion::kNone, Exclusion::kOlder, Exclusion::kLate, Exclusion::kFenced, Exclusion::kLifted})
    CHECK(found[e] > 100);
}

TEST_CASE("live versions are the recent versions with known content, and their disc contains them all") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    AuditedRobot robot;
    for (VersionNumber number = 1; number <= 8; ++number) {
      KnownVersion& known = robot.find_or_insert(number);
      known.has_content = rng.chance(0.7);
      known.version.version_number(number);
      known.version.x_m(rng.uniform(-2, 2));
      known.version.y_m(rng.uniform(-2, 2));
      known.version.vy_mps(rng.uniform(-2, 2));
      known.version.start_ns(static_cast<std::int64_t>(rng.below(100)));
      known.version.phase_count(1);
      known.version.phases()[0].duration_ns(500'000'000);
      known.path = AuditPath(known.version);
      known.executed_until_ns = static_cast<std::int64_t>(rng.below(100));
      known.granted_in = rng.below(2);
      known.granted_by_ns = static_cast<std::int64_t>(rng.below(100));
    }
    robot.first_recent = rng.below(9);
    std::vector<LiveVersion> live(3);
    const BoundingDisc disc = collect_live_versions(robot, live);
    std::size_t count = 0;
    double reach_m = -1;
    for (std::size_t i = robot.first_recent; i < robot.versions.size(); ++i) {
      const KnownVersion& known = robot.versions[i];
      if (!known.has_content) continue;
      REQUIRE(count < live.size());
      const LiveVersion& found = live[count++];
      CHECK(found.index == i);
      CHECK(found.number == known.number);
      CHECK(found.x == known.version.x_m());
      CHECK(found.y == known.version.y_m());
      CHECK(found.reach_m == Approx(std::abs(known.version.vy_mps()) / 2));
      CHECK(found.start_ns == known.version.start_ns());
      CHECK(found.executed_until_ns == known.executed_until_ns);
      CHECK(found.granted_by_ns == (known.granted_in == 0 ? kAlways : known.granted_by_ns));
      // The disc's centre is the first version.
      const double from_first_m = std::hypot(found.x - live.front().x, found.y - live.front().y);
      reach_m = std::max(reach_m, from_first_m + found.reach_m);
    }
    CHECK(live.size() == count);
    CHECK(disc.reach_m == Approx(reach_m));
    if (count == 0) continue;
    CHECK(disc.x == live.front().x);
    CHECK(disc.y == live.front().y);
  }
}

TEST_CASE("after a robot's clock is set back, all times of the old clock are forgotten") {
  AuditedRobot robot;
  robot.forget_times();
  CHECK_FALSE(robot.last_report);
  robot.last_report.emplace().at_ns = 1000;
  robot.drifted_since_ns = 900;
  robot.beyond_bound_since_ns = 950;
  robot.max_drift_m = 0.004;
  for (VersionNumber number = 1; number <= 3; ++number) robot.find_or_insert(number).executed_until_ns = 1000;
  robot.forget_times();
  CHECK(robot.last_report->at_ns == kAlways);
  CHECK(robot.drifted_since_ns == kNever);
  CHECK(robot.beyond_bound_since_ns == kNever);
  CHECK(robot.max_drift_m == 0);
  for (const KnownVersion& known : robot.versions) CHECK(known.executed_until_ns == kAlways);
}

TEST_CASE("after reset() a robot's former motions and proposals are forgotten, but not its last epoch") {
  AuditedRobot robot;
  robot.id = 7;
  robot.registered.emplace().epoch = 5;
  robot.find_or_insert(3);
  propose(robot, 3, 1, 1);
  robot.last_report.emplace();
  robot.reset();
  CHECK(robot.id == 7);
  CHECK(robot.forgotten_until_epoch == 5);
  CHECK(robot.versions.empty());
  CHECK(robot.find_proposal(3) == nullptr);
  CHECK(robot.max_evicted_proposal == 3);
  CHECK_FALSE(robot.last_report);
  CHECK_FALSE(robot.registered);
  robot.registered.emplace().epoch = 4;
  robot.reset();
  CHECK(robot.forgotten_until_epoch == 5);
  robot.registered.emplace().epoch = 6;
  robot.reset();
  CHECK(robot.forgotten_until_epoch == 6);
  AuditedRobot unregistered;
  unregistered.reset();
  CHECK(unregistered.forgotten_until_epoch == 0);
}

}  // namespace sidestep::audited_robot_memory_test
