// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/event_loop.hpp"

#include <algorithm>
#include <cerrno>
#include <sys/eventfd.h>
#include <system_error>
#include <time.h>
#include <unistd.h>
#include <utility>

namespace sidestep {

static_assert(std::atomic<bool>::is_always_lock_free, "stop() is called from signal handlers");

namespace {

// This clock cannot be set, and advances while the host is suspended.
constexpr clockid_t kSteady = CLOCK_BOOTTIME;

Duration read_clock(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return Duration{std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec};
}

/// The host's clock minus the steady clock. An interruption between the two readings would cause an error of
/// the same length, so this takes several pairs of readings and uses the quickest.
Duration host_clock_offset() {
  constexpr int kReadings = 20;
  Duration ahead{0}, quickest = Duration::max();
  for (int i = 0; i < kReadings; ++i) {
    const Duration before = read_clock(kSteady), host = read_clock(CLOCK_REALTIME),
                   after = read_clock(kSteady);
    if (after - before >= quickest) continue;
    quickest = after - before;
    ahead = host - before - quickest / 2;
  }
  return ahead;
}

/// The process's clock minus the steady clock.
std::atomic<Duration::rep>& process_clock_offset_ns() {
  static std::atomic<Duration::rep> offset_ns{host_clock_offset().count()};
  return offset_ns;
}

}  // namespace

EventLoop::EventLoop() : event_fd_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (event_fd_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
  polled_.push_back({event_fd_, POLLIN, 0});
  readable_.emplace_back();
}

EventLoop::~EventLoop() { close(event_fd_); }

Time EventLoop::now() {
  const Duration ahead{process_clock_offset_ns().load(std::memory_order_relaxed)};
  return Time{} + ahead + read_clock(kSteady);
}

Duration EventLoop::host_clock_ahead() {
  return host_clock_offset() - Duration{process_clock_offset_ns().load(std::memory_order_relaxed)};
}

void EventLoop::adopt_host_clock() { process_clock_offset_ns().store(host_clock_offset().count()); }

void EventLoop::at(Time when, std::function<void()> callback) {
  timers_.push_back({when, order_++, std::move(callback)});
  std::push_heap(timers_.begin(), timers_.end(), Later{});
}

void EventLoop::notify(Source& source) {
  if (source.ready_.exchange(true)) return;
  const std::lock_guard lock(mutex_);
  ready_.push_back(&source);
  if (std::exchange(sleeping_, false)) wake();
}

void EventLoop::post(std::function<void()> callback) {
  const std::lock_guard lock(mutex_);
  posted_.push_back(std::move(callback));
  if (std::exchange(sleeping_, false)) wake();
}

void EventLoop::watch(int descriptor, std::function<void()> readable) {
  polled_.push_back({descriptor, POLLIN, 0});
  readable_.push_back(std::move(readable));
}

void EventLoop::run_until(Time when) {
  while (!stopped()) {
    const bool more = drain_ready();
    call_posted();
    serve_watched();
    fire_due();
    if (now() >= when) return;
    if (!more && !stopped()) sleep_until(timers_.empty() ? when : std::min(when, timers_.front().when));
  }
}

void EventLoop::stop() {
  const int saved_errno = errno;
  stopped_.store(true);
  wake();
  errno = saved_errno;
}

bool EventLoop::drain_ready() {
  draining_.clear();
  {
    const std::lock_guard lock(mutex_);
    draining_.swap(ready_);
  }
  bool more = false;
  for (Source* source : draining_) {
    source->ready_.store(false);
    if (stopped()) return false;
    if (source->drain()) {
      notify(*source);
      more = true;
    }
  }
  return more;
}

void EventLoop::call_posted() {
  std::vector<std::function<void()>> callbacks;
  {
    const std::lock_guard lock(mutex_);
    callbacks.swap(posted_);
  }
  for (const auto& callback : callbacks) {
    if (stopped()) return;
    callback();
  }
}

void EventLoop::serve_watched() {
  if (polled_.size() == 1 || stopped() || poll(polled_.data(), polled_.size(), 0) <= 0) return;
  for (std::size_t i = 1; i < polled_.size() && !stopped(); ++i) {
    // A closed descriptor would wake the loop continually; poll() ignores negative descriptors.
    if (polled_[i].revents & POLLNVAL)
      polled_[i].fd = -1;
    else if (polled_[i].revents)
      readable_[i]();
  }
}

void EventLoop::fire_due() {
  const Time due = now();
  const std::uint64_t newest = order_;
  while (!stopped() && !timers_.empty() && timers_.front().when <= due && timers_.front().order < newest) {
    std::pop_heap(timers_.begin(), timers_.end(), Later{});
    const std::function<void()> callback = std::move(timers_.back().callback);
    timers_.pop_back();
    callback();
  }
}

void EventLoop::sleep_until(Time when) {
  // ppoll() does not count time during which the host is suspended, but now() does.
  constexpr Duration kMaxSleep{1'000'000'000};
  {
    const std::lock_guard lock(mutex_);
    if (!ready_.empty() || !posted_.empty()) return;
    sleeping_ = true;
  }
  const Time from = now();
  const Duration sleep = when > from + kMaxSleep ? kMaxSleep : std::max(when - from, Duration{0});
  const timespec timeout{sleep.count() / 1'000'000'000, sleep.count() % 1'000'000'000};
  if (ppoll(polled_.data(), polled_.size(), &timeout, nullptr) > 0 && polled_[0].revents) {
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t size = read(event_fd_, &count, sizeof count);
  }
  const std::lock_guard lock(mutex_);
  sleeping_ = false;
}

void EventLoop::wake() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t size = write(event_fd_, &one, sizeof one);
}

}  // namespace sidestep
