// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/history.hpp"

#include <tuple>

#include "deploy/view/monitor/viewer_time.hpp"
#include "tests/catch.hpp"

namespace sidestep::history_test {

using namespace std::chrono_literals;

Time at_ms(int ms) { return time_from_ns(std::int64_t{1'000'000} * ms); }

Snapshot snapshot(int ms, std::size_t bytes = 100) {
  return {at_ms(ms), std::make_shared<const std::string>(bytes, 'x'), nullptr};
}

History filled(int count, std::size_t max_bytes = 1 << 20,
               History::WhenFull when_full = History::WhenFull::kForgetOldest) {
  History history(max_bytes, when_full);
  for (int i = 1; i <= count; ++i) history.add(snapshot(10 * i));
  return history;
}

TEST_CASE("a history finds the snapshot at or before a time") {
  const History history = filled(100);
  CHECK(history.at(at_ms(500)).at == at_ms(500));
  CHECK(history.at(at_ms(509)).at == at_ms(500));
  CHECK(history.at(at_ms(0)).at == at_ms(10));
  CHECK(history.at(at_ms(99'999)).at == at_ms(1000));
  CHECK(history.from(at_ms(500)).at == at_ms(500));
  CHECK(history.from(at_ms(501)).at == at_ms(510));
  CHECK(history.from(at_ms(99'999)).at == at_ms(1000));
  CHECK(history.stepped(at_ms(505), 1).at == at_ms(510));
  CHECK(history.stepped(at_ms(505), -3).at == at_ms(470));
  CHECK(history.stepped(at_ms(20), -3).at == at_ms(10));
  CHECK(history.stepped(at_ms(990), 30).at == at_ms(1000));
}

TEST_CASE("a history ignores snapshots that are not later than its end") {
  History history = filled(10);
  history.add(snapshot(100));
  history.add(snapshot(50));
  CHECK(history.size() == 10);
}

TEST_CASE("a full history forgets its oldest snapshots") {
  const History history = filled(1000, 20'000);
  CHECK(history.bytes() <= 20'000);
  CHECK(history.last().at == at_ms(10'000));
  CHECK(history.size() > 100);
  CHECK(history.first().at == at_ms(10'000 - 10 * (static_cast<int>(history.size()) - 1)));
}

TEST_CASE("a full history of a recording keeps its whole time span with fewer snapshots") {
  const History history = filled(1000, 20'000, History::WhenFull::kThinOut);
  CHECK(history.bytes() <= 20'000);
  CHECK(history.first().at == at_ms(10));
  CHECK(history.last().at >= at_ms(9'800));
  // The remaining snapshots are equally spaced.
  const Duration gap = history.stepped(history.first().at, 1).at - history.first().at;
  for (std::size_t i = 1; i + 1 < history.size(); ++i) {
    const Time before = history.stepped(history.first().at, static_cast<int>(i)).at;
    CHECK(history.stepped(before, 1).at - before == gap);
  }
}

TEST_CASE("a history that was thinned out keeps the last snapshot of a recording") {
  for (int count = 1000; count < 1064; ++count) {
    History history = filled(count, 20'000, History::WhenFull::kThinOut);
    history.add_last(snapshot(20'000));
    CHECK(history.last().at == at_ms(20'000));
    history.add_last(snapshot(20'000));
    CHECK(history.stepped(history.last().at, -1).at < at_ms(20'000));
  }
}

TEST_CASE("a viewer sees the newest moment, a paused moment or a playback") {
  History history = filled(100);
  ViewerTime time;
  CHECK(time.update(history, at_ms(0)) == at_ms(1000));
  time.pause_at(at_ms(500));
  CHECK(time.update(history, at_ms(7)) == at_ms(500));
  history.add(snapshot(1010));
  CHECK(time.update(history, at_ms(9)) == at_ms(500));
  time.play(at_ms(500), 2, at_ms(20'000));
  CHECK(time.update(history, at_ms(20'100)) == at_ms(700));
  CHECK(time.mode() == ViewerTime::Mode::kPlaying);
  time.play(at_ms(500), -1, at_ms(30'000));
  CHECK(time.update(history, at_ms(30'100)) == at_ms(400));
  time.go_live();
  CHECK(time.update(history, at_ms(1)) == at_ms(1010));
}

TEST_CASE("a playback stops at either end, and seeking beyond an end shows the end") {
  const History history = filled(100);
  ViewerTime time;
  time.play(at_ms(900), 1, at_ms(0));
  CHECK(time.update(history, at_ms(500)) == at_ms(1000));
  CHECK(time.mode() == ViewerTime::Mode::kPaused);
  time.play(at_ms(100), -5, at_ms(0));
  CHECK(time.update(history, at_ms(500)) == at_ms(10));
  CHECK(time.mode() == ViewerTime::Mode::kPaused);
  time.pause_at(at_ms(123'456));
  CHECK(time.update(history, at_ms(0)) == at_ms(1000));
}

TEST_CASE("a playback starts at the very start, and a backward one at the very end") {
  const History history = filled(100);
  ViewerTime time;
  for (const auto& [start_ms, speed, then_ms] : {std::tuple{10, 1.0, 110}, std::tuple{1000, -1.0, 900}}) {
    time.pause_at(at_ms(start_ms));
    time.play(time.update(history, at_ms(0)), speed, at_ms(0));
    CHECK(time.update(history, at_ms(0)) == at_ms(start_ms));
    CHECK(time.mode() == ViewerTime::Mode::kPlaying);
    CHECK(time.update(history, at_ms(100)) == at_ms(then_ms));
    CHECK(time.mode() == ViewerTime::Mode::kPlaying);
  }
}

TEST_CASE("a playback continues when the history has forgotten the moment that it shows") {
  History history(20'000, History::WhenFull::kForgetOldest);
  history.add(snapshot(10));
  ViewerTime time;
  time.play(at_ms(10), 1, at_ms(0));
  for (int i = 2; i <= 1000; ++i) history.add(snapshot(10 * i));
  REQUIRE(history.first().at > at_ms(100));
  CHECK(time.update(history, at_ms(90)) == history.first().at);
  CHECK(time.mode() == ViewerTime::Mode::kPlaying);
}

}  // namespace sidestep::history_test
