// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/reception_coverage.hpp"

#include <algorithm>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::reception_coverage_test {

using namespace std::chrono_literals;

constexpr Time kBegin{1000s};
constexpr Duration kEverything = Duration::max();

Time at(Duration since_begin) { return kBegin + since_begin; }

/// One second with a source that is heard every 100 ms.
ReceptionCoverage coverage_of_one_second(std::size_t sources) {
  ReceptionCoverage time(sources);
  time.begin(kBegin);
  for (Duration t = 100ms; t <= 1s; t += 100ms) time.hear(0, at(t), kEverything);
  return time;
}

TEST_CASE("a source that is heard often counts as heard all the time") {
  CHECK(coverage_of_one_second(1).share(at(1s), true) == 1);
}

TEST_CASE("if a source is never heard, nothing is covered") {
  CHECK(coverage_of_one_second(2).share(at(1s), true) == 0);
}

TEST_CASE("the covered share is zero before the beginning and at the beginning") {
  ReceptionCoverage time(1);
  time.hear(0, at(1s), kEverything);
  CHECK(time.share(at(2s), true) == 0);
  time.begin(at(2s));
  CHECK(time.share(at(2s), true) == 0);
}

TEST_CASE("only silence during which messages were missed lowers the coverage") {
  ReceptionCoverage time = coverage_of_one_second(1);
  SECTION("no messages were missed") {
    time.hear(0, at(2s), Duration{0});
    CHECK(time.share(at(2s), true) == 1);
  }
  SECTION("messages of the last half second were missed") {
    time.hear(0, at(2s), 500ms);
    CHECK(time.share(at(2s), true) == Approx(0.75));
  }
  SECTION("messages of a longer time than the silence were missed") {
    time.hear(0, at(2s), 5s);
    CHECK(time.share(at(2s), true) == Approx(0.5));
  }
  SECTION("the silence has not ended") {
    CHECK(time.share(at(2s), true) == Approx(0.5));
    CHECK(time.share(at(2s), false) == 1);
  }
  SECTION("the silence was expected") {
    time.expect_silence(0);
    CHECK(time.share(at(2s), true) == 1);
    time.hear(0, at(2s), kEverything);
    CHECK(time.share(at(2s), true) == 1);
    CHECK(time.share(at(4s), true) == Approx(0.5));
  }
}

TEST_CASE("messages heard before the beginning do not count") {
  ReceptionCoverage time(1);
  time.hear(0, at(-10s), kEverything);
  time.begin(kBegin);
  time.hear(0, at(1s), kEverything);
  time.hear(0, at(1100ms), kEverything);
  CHECK(time.share(at(2s), false) == Approx(0.5));
}

/// The share of milliseconds in which every source counted as heard.
double reference_share(const std::vector<std::vector<Duration>>& heard_at, Duration end) {
  int covered = 0;
  const auto count = static_cast<int>(end / 1ms);
  for (int ms = 0; ms < count; ++ms) {
    const Duration middle = ms * 1ms + 500us;
    covered += std::ranges::all_of(heard_at, [&](const std::vector<Duration>& times) {
      Duration before{0}, after = end;
      for (const Duration t : times) {
        if (t < middle) before = std::max(before, t);
        if (t > middle) after = std::min(after, t);
      }
      return after - before <= ReceptionCoverage::kMaxSilence;
    });
  }
  return covered / static_cast<double>(count);
}

TEST_CASE("the covered share of several sources matches a count of every millisecond") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const std::size_t sources = 1 + rng.below(4);
    const auto max_period_ms = static_cast<int>(150 + rng.below(300));
    const Duration end = 5s;
    std::vector<std::vector<Duration>> heard_at(sources);
    ReceptionCoverage time(sources);
    time.begin(kBegin);
    for (Duration t = 1ms; t <= end; t += 1ms) {
      for (std::size_t i = 0; i < sources; ++i) {
        if (rng.below(static_cast<std::uint64_t>(max_period_ms)) != 0) continue;
        heard_at[i].push_back(t);
        time.hear(i, at(t), kEverything);
      }
    }
    CHECK(time.share(at(end), true) == Approx(reference_share(heard_at, end)).margin(1e-9));
  }
}

TEST_CASE("each of a thousand silences lowers the coverage") {
  ReceptionCoverage time(1);
  time.begin(kBegin);
  for (int i = 1; i <= 1000; ++i) {
    time.hear(0, at(i * 1s - 300ms), kEverything);
    time.hear(0, at(i * 1s - 200ms), kEverything);
    time.hear(0, at(i * 1s), kEverything);
  }
  // 700 ms of each second are silent.
  CHECK(time.share(at(1000s), true) == Approx(0.3));
}

}  // namespace sidestep::reception_coverage_test
