// SPDX-License-Identifier: Apache-2.0
#include "vision/league/replay.hpp"

#include <filesystem>
#include <unistd.h>

#include "tests/catch.hpp"

namespace sidestep::replay_test {

using std::chrono::milliseconds;

const Time kReceived = time_from_ns(1'500'000'000'000'000'000);
const Time kNow = time_from_ns(1'700'000'000'000'000'000);

/// A log with a packet at each of these times after kReceived. Each packet is one byte, its index.
class Log {
 public:
  explicit Log(const std::vector<int>& at_ms) {
    league::LogWriter writer(path_);
    for (const int ms : at_ms) {
      const std::byte index{static_cast<unsigned char>(writer.records())};
      writer.add(kReceived + milliseconds(ms), league::LogType::kVision, {&index, 1});
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
  int index;
  std::int64_t at_ms;
  bool operator==(const Sent&) const = default;
};

/// All packets that are sent if advance() is called at the requested times.
std::vector<Sent> replayed(league::LogReader& reader, double speed) {
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

TEST_CASE("a log is replayed with the timing of its reception") {
  const Log log({0, 10, 10, 25, 1000});
  league::LogReader reader = log.reader();
  CHECK(replayed(reader, 1) == std::vector<Sent>{{0, 0}, {1, 10}, {2, 10}, {3, 25}, {4, 1000}});
}

TEST_CASE("a log is replayed with a speed factor") {
  const Log log({0, 10, 1000});
  league::LogReader fast = log.reader(), slow = log.reader();
  CHECK(replayed(fast, 10) == std::vector<Sent>{{0, 0}, {1, 1}, {2, 100}});
  CHECK(replayed(slow, 0.5) == std::vector<Sent>{{0, 0}, {1, 20}, {2, 2000}});
}

TEST_CASE("a replay starts at the reader's position") {
  const Log log({0, 10, 500, 510, 520});
  league::LogReader reader = log.reader();
  REQUIRE(reader.seek(milliseconds(500)));
  CHECK(replayed(reader, 1) == std::vector<Sent>{{2, 0}, {3, 10}, {4, 20}});
}

TEST_CASE("timestamps that run backwards or jump by years only delay the rest of the log") {
  const Log log({1000, 0, 1010, 5});
  league::LogReader reader = log.reader();
  CHECK(replayed(reader, 1) == std::vector<Sent>{{0, 0}, {1, 0}, {2, 10}, {3, 10}});
  const Log leap({0, 2'000'000'000});
  league::LogReader leaping = leap.reader();
  const auto sent = replayed(leaping, 0.001);
  REQUIRE(sent.size() == 2);
  CHECK(sent[1].at_ms == 300'000'000'000);
}

TEST_CASE("many simultaneous packets are sent in several batches") {
  const Log log(std::vector<int>(200, 7));
  league::LogReader reader = log.reader();
  Replay replay(reader, 1);
  int count = 0, batches = 0;
  while (replay.advance(kNow, [&](const league::LogRecord&) { ++count; })) ++batches;
  CHECK(count == 200);
  CHECK(batches >= 3);
}

TEST_CASE("the replay of an empty log ends immediately") {
  const Log log({});
  league::LogReader reader = log.reader();
  CHECK(replayed(reader, 1).empty());
}

}  // namespace sidestep::replay_test
