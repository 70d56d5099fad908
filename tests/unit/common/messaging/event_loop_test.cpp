// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/event_loop.hpp"

#include <catch2/catch.hpp>
#include <signal.h>
#include <thread>

namespace sidestep {
namespace {

constexpr Duration kMillisecond{1'000'000};
constexpr Duration kLong{30'000'000'000};  ///< beyond it a test fails instead of hanging

class Counter : public EventLoop::Source {
 public:
  explicit Counter(std::function<bool()> drained) : drained_(std::move(drained)) {}
  bool drain() override { return drained_(); }

 private:
  std::function<bool()> drained_;
};

EventLoop* signalled = nullptr;

}  // namespace

TEST_CASE("timers fire by time, and in the order of scheduling when the time is the same") {
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

TEST_CASE("a timer that is always due again leaves the others their turn") {
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

TEST_CASE("a source that never runs dry leaves timers their turn") {
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

TEST_CASE("what other threads report is drained, however often and however late they do") {
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

TEST_CASE("run_until() returns at its time when nothing happens") {
  EventLoop loop;
  const Time until = loop.now() + 2 * kMillisecond;
  loop.run_until(until);
  CHECK(loop.now() >= until);
  CHECK_FALSE(loop.stopped());
}

TEST_CASE("a signal handler may stop the loop while it sleeps") {
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

}  // namespace sidestep
