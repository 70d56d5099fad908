// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/event_loop.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <signal.h>
#include <sys/syscall.h>
#include <thread>
#include <time.h>
#include <unistd.h>
#include <vector>

#include "tests/catch.hpp"

namespace {
/// Simulated step of this host's clock.
std::atomic<long> host_clock_step_s{0};
}  // namespace

/// Overrides the C library's function in this program, so that a test can step the host's clock.
extern "C" int clock_gettime(clockid_t clock, timespec* t) noexcept {
  const long result = syscall(SYS_clock_gettime, clock, t);
  if (clock == CLOCK_REALTIME) t->tv_sec += host_clock_step_s.load();
  return static_cast<int>(result);
}

namespace sidestep {
namespace {

constexpr Duration kMillisecond{1'000'000};
constexpr Duration kLong{30'000'000'000};  ///< timeout of a failing test

class Counter : public EventLoop::Source {
 public:
  explicit Counter(std::function<bool()> drained) : drained_(std::move(drained)) {}
  bool drain() override { return drained_(); }

 private:
  std::function<bool()> drained_;
};

EventLoop* signalled = nullptr;

}  // namespace

TEST_CASE("timers fire in order of time, and at equal times in the order of scheduling") {
  EventLoop loop;
  std::vector<int> fired;
  const Time begin = loop.now();
  const auto add = [&](int ms, int number) {
    loop.at(begin + ms * kMillisecond, [&, number] { fired.push_back(number); });
  };
  add(4, 4);
  add(2, 1);
  add(2, 2);
  add(0, 0);
  add(2, 3);
  loop.at(begin + 5 * kMillisecond, [&] { loop.stop(); });
  loop.run_until(begin + kLong);
  CHECK(fired == std::vector<int>{0, 1, 2, 3, 4});
  CHECK(loop.now() >= begin + 5 * kMillisecond);
}

TEST_CASE("a timer never fires early") {
  EventLoop loop;
  const Time due = loop.now() + 3 * kMillisecond;
  Time fired{};
  loop.at(due, [&] {
    fired = loop.now();
    loop.stop();
  });
  loop.run_until(due + kLong);
  CHECK(fired >= due);
}

TEST_CASE("a timer that is always due does not starve sources") {
  EventLoop loop;
  int turns = 0;
  std::function<void()> again = [&] {
    ++turns;
    loop.at(Time{}, again);
  };
  loop.at(Time{}, again);
  int drained = 0;
  Counter source([&] {
    if (++drained == 3) loop.stop();
    return true;
  });
  loop.notify(source);
  loop.run_until(loop.now() + kLong);
  CHECK(drained == 3);
  CHECK(turns >= 2);
}

TEST_CASE("a source that always has more events does not starve timers") {
  EventLoop loop;
  Counter source([] { return true; });
  loop.notify(source);
  bool fired = false;
  loop.at(loop.now() + kMillisecond, [&] {
    fired = true;
    loop.stop();
  });
  loop.run_until(loop.now() + kLong);
  CHECK(fired);
}

TEST_CASE("calls posted by other threads wake the loop and run in order in its thread") {
  EventLoop loop;
  std::vector<int> made;
  std::vector<std::thread::id> threads;
  constexpr int kCalls = 1000;
  std::thread poster([&] {
    for (int i = 0; i < kCalls; ++i) {
      loop.post([&, i] {
        made.push_back(i);
        threads.push_back(std::this_thread::get_id());
        if (i + 1 == kCalls) loop.stop();
      });
    }
  });
  loop.run_until(loop.now() + kLong);
  poster.join();
  REQUIRE(made.size() == kCalls);
  CHECK(std::ranges::is_sorted(made));
  CHECK(std::ranges::count(threads, std::this_thread::get_id()) == kCalls);
}

TEST_CASE("a call that keeps posting itself does not starve timers") {
  EventLoop loop;
  std::function<void()> again = [&] { loop.post(again); };
  loop.post(again);
  bool fired = false;
  loop.at(loop.now() + kMillisecond, [&] {
    fired = true;
    loop.stop();
  });
  loop.run_until(loop.now() + kLong);
  CHECK(fired);
}

TEST_CASE("every report from another thread is processed") {
  EventLoop loop;
  constexpr int kReports = 20000;
  std::atomic<int> pending{0};
  int taken = 0;
  Counter source([&] {
    taken += pending.exchange(0);
    if (taken == kReports) loop.stop();
    return false;
  });
  std::thread reporter([&] {
    for (int i = 0; i < kReports; ++i) {
      ++pending;
      loop.notify(source);
      if (i % 100 == 0) std::this_thread::yield();
    }
  });
  loop.run_until(loop.now() + kLong);
  reporter.join();
  CHECK(taken == kReports);
}

TEST_CASE("a readable descriptor calls back without starving timers and sources") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  EventLoop loop;
  int calls = 0, drained = 0;
  loop.watch(ends[0], [&] { ++calls; });
  Counter source([&] {
    ++drained;
    return false;
  });
  loop.at(loop.now() + 2 * kMillisecond, [&] {
    CHECK(calls == 0);
    REQUIRE(write(ends[1], "x", 1) == 1);
  });
  std::function<void()> again = [&] {
    if (calls >= 100) return loop.stop();
    loop.notify(source);
    loop.at(loop.now() + kMillisecond, again);
  };
  loop.at(loop.now(), again);
  loop.run_until(loop.now() + kLong);
  CHECK(calls >= 100);
  CHECK(drained >= 2);
  close(ends[0]);
  close(ends[1]);
}

TEST_CASE("a readable descriptor wakes a sleeping loop, and a closed descriptor lets it sleep") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  EventLoop loop;
  bool called = false;
  loop.watch(ends[0], [&] {
    called = true;
    loop.stop();
  });
  std::thread writer([&] { CHECK(write(ends[1], "x", 1) == 1); });
  loop.run_until(loop.now() + kLong);
  writer.join();
  CHECK(called);

  EventLoop other;
  int wrong_calls = 0;
  close(ends[0]);
  close(ends[1]);
  other.watch(ends[0], [&] { ++wrong_calls; });
  const std::clock_t cpu_before = std::clock();
  other.run_until(other.now() + 100 * kMillisecond);
  CHECK(wrong_calls == 0);
  CHECK(std::clock() - cpu_before < CLOCKS_PER_SEC / 20);
}

TEST_CASE("an idle run_until() returns on time") {
  EventLoop loop;
  const Time until = loop.now() + 2 * kMillisecond;
  loop.run_until(until);
  CHECK(loop.now() >= until);
  CHECK_FALSE(loop.stopped());
}

TEST_CASE("a signal handler can stop a sleeping loop") {
  EventLoop loop;
  signalled = &loop;
  struct sigaction action {};
  struct sigaction old {};
  action.sa_handler = [](int) { signalled->stop(); };
  sigaction(SIGUSR1, &action, &old);
  const Time begin = loop.now();
  std::thread sender([] { kill(getpid(), SIGUSR1); });
  loop.run_until(begin + kLong);
  sender.join();
  sigaction(SIGUSR1, &old, nullptr);
  CHECK(loop.stopped());
  CHECK(loop.now() < begin + kLong);
}

TEST_CASE("setting the host's clock does not affect a running process") {
  const long step_s = GENERATE(-3600, 3600);
  CAPTURE(step_s);
  EventLoop loop;
  const Time begin = loop.now();
  host_clock_step_s = step_s;
  const Time after = loop.now();
  bool fired = false;
  loop.at(begin + 3 * kMillisecond, [&] {
    fired = true;
    loop.stop();
  });
  loop.run_until(begin + kLong);
  const Time end = EventLoop().now();
  host_clock_step_s = 0;
  CHECK(after >= begin);
  CHECK(fired);
  CHECK(end >= begin + 3 * kMillisecond);
  CHECK(end < begin + kLong);
}

TEST_CASE("a process notices a step of its host's clock but adopts it only on request") {
  const long step_s = GENERATE(-86400, -1, 1, 86400);
  CAPTURE(step_s);
  const Duration step = std::chrono::seconds(step_s);
  const auto is_near = [](Duration a, Duration b) { return a - b < kMillisecond && b - a < kMillisecond; };
  EventLoop::adopt_host_clock();
  CHECK(is_near(EventLoop::host_clock_ahead(), Duration{0}));
  const Time before = EventLoop::now();
  host_clock_step_s = step_s;
  CHECK(is_near(EventLoop::host_clock_ahead(), step));
  CHECK(EventLoop::now() - before < kLong);
  EventLoop::adopt_host_clock();
  CHECK(is_near(EventLoop::host_clock_ahead(), Duration{0}));
  CHECK(EventLoop::now() - before >= step);
  CHECK(EventLoop::now() - before < step + kLong);
  host_clock_step_s = 0;
  EventLoop::adopt_host_clock();
}

TEST_CASE("the process's clock never runs backwards, across threads and loops") {
  std::atomic<std::int64_t> latest{0};
  std::atomic<int> backwards{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      EventLoop loop;
      for (int k = 0; k < 20'000; ++k) {
        const std::int64_t seen_before = latest.load();
        const std::int64_t now = to_ns(loop.now());
        if (now < seen_before) ++backwards;
        for (std::int64_t seen = latest; seen < now && !latest.compare_exchange_weak(seen, now);) {
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(backwards == 0);
}

TEST_CASE("the process's clock agrees with the host's clock until the host's clock is set") {
  const auto host = [] { return Time{std::chrono::system_clock::now().time_since_epoch()}; };
  // The clocks may differ only because a time daemon slews the host's clock.
  const Duration slewed = std::chrono::seconds(1);
  const Time before = host(), now = EventLoop::now(), after = host();
  CHECK(now > before - slewed);
  CHECK(now < after + slewed);
}

}  // namespace sidestep
