// SPDX-License-Identifier: Apache-2.0
#include "vision/league/replay.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <unistd.h>

namespace sidestep {
namespace {

using std::chrono::milliseconds;

const Time kReceived = time_from_ns(1'500'000'000'000'000'000);
const Time kNow = time_from_ns(1'700'000'000'000'000'000);

/// A log with a packet at each of these times after kReceived, whose one byte is its place.
class Log {
 public:
  explicit Log(const std::vector<int>& at_ms) {
    league::LogWriter writer(path_);
    for (const int ms : at_ms) {
      const std::byte place{static_cast<unsigned char>(writer.records())};
      writer.add(kReceived + milliseconds(ms), league::LogType::kVision, {&place, 1});
    }
    writer.close();
  }
  ~Log() { std::filesystem::remove(path_); }
  league::LogReader reader() const { return league::LogReader(path_); }

 private:
  std::string path_ =
      (std::filesystem::temp_directory_path() / ("sidestep-replay-test-" + std::to_string(getpid())))
          .string();
};

struct Sent {
  int place;
  std::int64_t at_ms;
  bool operator==(const Sent&) const = default;
};

/// All that is sent, with whoever calls waking when asked to.
std::vector<Sent> played(league::LogReader& reader, double speed) {
  Replay replay(reader, speed);
  std::vector<Sent> sent;
  Time now = kNow;
  while (const auto next = replay.advance(now, [&](const league::LogRecord& record) {
    sent.push_back({std::to_integer<int>(record.bytes.at(0)), (now - kNow) / milliseconds(1)});
  })) {
    REQUIRE(sent.size() < 1000);
    now = std::max(now, *next);
  }
  return sent;
}

}  // namespace

TEST_CASE("a log is played in the rhythm in which it was received") {
  const Log log({0, 10, 10, 25, 1000});
  league::LogReader reader = log.reader();
  CHECK(played(reader, 1) == std::vector<Sent>{{0, 0}, {1, 10}, {2, 10}, {3, 25}, {4, 1000}});
}

TEST_CASE("a log is played so many times as fast as asked") {
  const Log log({0, 10, 1000});
  league::LogReader fast = log.reader(), slow = log.reader();
  CHECK(played(fast, 10) == std::vector<Sent>{{0, 0}, {1, 1}, {2, 100}});
  CHECK(played(slow, 0.5) == std::vector<Sent>{{0, 0}, {1, 20}, {2, 2000}});
}

TEST_CASE("playing begins where the reader stands") {
  const Log log({0, 10, 500, 510, 520});
  league::LogReader reader = log.reader();
  REQUIRE(reader.seek(milliseconds(500)));
  CHECK(played(reader, 1) == std::vector<Sent>{{2, 0}, {3, 10}, {4, 20}});
}

TEST_CASE("times that run backwards or leap by years hold up nobody but the rest of the log") {
  const Log log({1000, 0, 1010, 5});
  league::LogReader reader = log.reader();
  CHECK(played(reader, 1) == std::vector<Sent>{{0, 0}, {1, 0}, {2, 10}, {3, 10}});
  const Log leap({0, 2'000'000'000});
  league::LogReader leaping = leap.reader();
  const auto sent = played(leaping, 0.001);
  REQUIRE(sent.size() == 2);
  CHECK(sent[1].at_ms == 300'000'000'000);
}

TEST_CASE("many packets of one moment are all sent though not in one turn") {
  const Log log(std::vector<int>(200, 7));
  league::LogReader reader = log.reader();
  Replay replay(reader, 1);
  int count = 0, turns = 0;
  while (replay.advance(kNow, [&](const league::LogRecord&) { ++count; })) ++turns;
  CHECK(count == 200);
  CHECK(turns >= 3);
}

TEST_CASE("an empty log is played at once") {
  const Log log({});
  league::LogReader reader = log.reader();
  CHECK(played(reader, 1).empty());
}

}  // namespace sidestep
