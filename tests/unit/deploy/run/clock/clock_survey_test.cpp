// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/clock/clock_survey.hpp"

#include "common/protocol/senders.hpp"
#include "deploy/run/clock/clock_text.hpp"
#include "tests/catch.hpp"
#include "tests/drawn_text.hpp"

namespace sidestep::clock_survey_test {

using namespace std::chrono_literals;

constexpr std::uint32_t kClient = 1'000'001;
constexpr auto kCoordinator = static_cast<std::uint32_t>(Sender::kCoordinator);

struct Scene {
  ClockSurvey survey{kClient};
  Time now = time_from_ns(1'700'000'000'000'000'000);

  /// A probe, and the answer from a clock that is ahead by this much; both messages take `delay`.
  void ask(std::uint32_t process, Duration ahead, Duration delay = 100us, Incarnation incarnation = 1) {
    ClockAnswer answer{process, incarnation, kClient, now,       now + delay + ahead, now + delay + ahead,
                       0s,      0.0005,      "host",  "scenario"};
    survey.on_probe(now);
    now += 2 * delay;
    survey.on_answer(answer, now);
  }
  ClockRow row(std::uint32_t process, std::optional<std::uint32_t> reference = {}) const {
    for (const ClockRow& row : survey.rows(now, reference)) {
      if (row.process == process) return row;
    }
    FAIL("there is no row of this process");
    return {};
  }
};

TEST_CASE("a process's clock is compared with the clock of this machine or of another process") {
  Scene scene;
  scene.ask(3, 10ms);
  scene.ask(kCoordinator, 9ms);
  const ClockRow row = scene.row(3);
  CHECK(row.offset->low <= Duration(10ms));
  CHECK(row.offset->high >= Duration(10ms));
  CHECK(row.offset->uncertainty() < Duration(150us));
  CHECK(row.round_trip == Duration(200us));
  CHECK(row.host == "host");
  CHECK(row.verdict == ClockVerdict::kBeyond);
  const ClockRow from_coordinator = scene.row(3, kCoordinator);
  CHECK(from_coordinator.offset->low <= Duration(1ms));
  CHECK(from_coordinator.offset->high >= Duration(1ms));
  CHECK(from_coordinator.verdict == ClockVerdict::kBeyond);
  CHECK(scene.row(kCoordinator, kCoordinator).offset->uncertainty() == Duration{0});
  CHECK(scene.row(3, 77).verdict == ClockVerdict::kNotMeasured);
}

TEST_CASE("a clock is reported as within the bound, beyond the bound or too uncertain to tell") {
  Scene scene;
  scene.ask(0, 0s);
  scene.ask(1, 300us);
  scene.ask(2, -700us);
  scene.ask(3, 0s, 2ms);
  scene.survey.on_heard(4, scene.now);
  CHECK(scene.row(0).verdict == ClockVerdict::kWithin);
  CHECK(scene.row(1).verdict == ClockVerdict::kWithin);
  CHECK(scene.row(2).verdict == ClockVerdict::kBeyond);
  CHECK(scene.row(3).verdict == ClockVerdict::kUnclear);
  CHECK(scene.row(4).verdict == ClockVerdict::kNotMeasured);
}

TEST_CASE("clocks agree if each is measured and none is proven to be beyond the bound") {
  Scene scene;
  CHECK_FALSE(all_agree(scene.survey.rows(scene.now, {})));
  scene.ask(0, 0s);
  scene.ask(1, 0s, 2ms);
  CHECK(all_agree(scene.survey.rows(scene.now, {})));
  scene.survey.on_heard(2, scene.now);
  CHECK_FALSE(all_agree(scene.survey.rows(scene.now, {})));
  scene.ask(2, 0s);
  CHECK(all_agree(scene.survey.rows(scene.now, {})));
  scene.ask(1, 1h);
  CHECK_FALSE(all_agree(scene.survey.rows(scene.now, {})));
}

TEST_CASE("answers to other clients, to unsent probes and from earlier runs of a process are ignored") {
  Scene scene;
  const auto answer = [&](std::uint32_t client, Time sent) {
    return ClockAnswer{3, 1, client, sent, scene.now, scene.now, 0s, 0.0005, "host", "scenario"};
  };
  scene.survey.on_probe(scene.now);
  scene.survey.on_answer(answer(kClient + 1, scene.now), scene.now + 1ms);
  scene.survey.on_answer(answer(kClient, scene.now + 1ns), scene.now + 1ms);
  scene.survey.on_answer(answer(kClient, Time{}), scene.now + 1ms);
  CHECK(scene.survey.rows(scene.now, {}).empty());
  scene.ask(3, 1s, 100us, 7);
  scene.ask(3, 0s, 100us, 6);
  CHECK(scene.row(3).offset->low > Duration(900ms));
  scene.ask(3, 0s, 100us, 8);
  CHECK(scene.row(3).offset->high < Duration(1ms));
}

TEST_CASE("a process that falls silent is first marked as not measured and then removed") {
  Scene scene;
  scene.ask(3, 0s);
  scene.now += 3s;
  CHECK(scene.row(3).verdict == ClockVerdict::kNotMeasured);
  scene.now += 3s;
  CHECK(scene.survey.rows(scene.now, {}).empty());
}

TEST_CASE("the table names processes, offsets, verdicts, robots' clocks and hosts whose clock has been set") {
  Scene scene;
  scene.ask(3, 20s);
  scene.survey.on_robot_clock(3, OffsetInterval{-100us, 300us}, scene.now);
  scene.survey.on_heard(kCoordinator, scene.now);
  std::vector<ClockRow> rows = scene.survey.rows(scene.now, {});
  rows[0].host_ahead = 90s;
  const std::string table = to_table(rows, "this machine");
  CAPTURE(table);
  CHECK_THAT(table, ContainsSubstring("offsets from the clock of this machine"));
  CHECK_THAT(table, ContainsSubstring("agent 3        beyond  "));
  CHECK_THAT(table, ContainsSubstring("+20.0 s"));
  CHECK_THAT(table, ContainsSubstring("beyond"));
  CHECK_THAT(table, ContainsSubstring("+0.100 ± 0.200 ms"));
  CHECK_THAT(table, ContainsSubstring("its host's clock has been set by +90.000 s since it started"));
  CHECK_THAT(table, ContainsSubstring("not measured"));
}

TEST_CASE(
    "in a terminal of 60 columns the table of clocks shows the verdicts, and with 80 the robots' clocks") {
  const int columns = GENERATE(60, 80, 120);
  Scene scene;
  scene.ask(3, 20s);
  scene.survey.on_robot_clock(3, OffsetInterval{-100us, 300us}, scene.now);
  scene.survey.on_heard(kCoordinator, scene.now);
  const Screen screen = screen_of(to_table(scene.survey.rows(scene.now, {}), "this machine"), columns);
  CAPTURE(columns);
  INFO(screen.text());
  const std::vector<std::string> lines = screen.lines();
  REQUIRE(lines.size() == 4);
  CHECK_THAT(lines[1], StartsWith("process        clock bound                    offset"));
  CHECK_THAT(lines[2], StartsWith("agent 3        beyond                        +20.0 s"));
  CHECK_THAT(lines[3], StartsWith("coordinator    not measured"));
  CHECK((screen.count("+0.100 ? 0.200 ms") == 1) == (columns >= 80));
  CHECK((screen.count("round trip ms") == 1) == (columns >= 120));
  CHECK(screen.wraps() == 0);
  CHECK(screen.unknown().empty());
}

}  // namespace sidestep::clock_survey_test
