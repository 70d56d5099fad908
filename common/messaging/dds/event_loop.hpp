// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <poll.h>
#include <vector>

#include "common/time/time.hpp"

namespace sidestep {

/// One thread's turn-taking between timers and sources that other threads report as ready. The thread sleeps
/// in the kernel while there is nothing to do.
class EventLoop {
 public:
  /// Something that becomes ready in another thread and is emptied in the loop's. Must outlive the loop's
  /// last turn.
  class Source {
   public:
    virtual ~Source() = default;
    /// Hands over what has come, up to a bound so that timers get their turn; true when something may be
    /// left.
    virtual bool drain() = 0;

   private:
    friend class EventLoop;
    std::atomic<bool> ready_{false};
  };

  /// Throws std::system_error when the system has no file descriptor left.
  EventLoop();
  ~EventLoop();
  EventLoop(const EventLoop&) = delete;
  EventLoop& operator=(const EventLoop&) = delete;

  /// The process's clock, the same for all its loops: what the host's clock showed when it was first asked,
  /// and the time that has passed since. Whoever sets the host's clock does not reach it.
  static Time now();

  /// Calls back once at or after the time; callbacks of one time come in the order of scheduling. In the
  /// loop's thread, or before it runs.
  void at(Time when, std::function<void()> callback);
  /// From any thread.
  void notify(Source& source);
  /// Calls back in every turn in which the descriptor can be read, until it is closed or broken, which has to
  /// wait until the loop's last turn. In the loop's thread, or before it runs.
  void watch(int descriptor, std::function<void()> readable);
  /// Takes turns until then, or stop(); what is due or ready at the call still gets its turn.
  void run_until(Time when);
  /// Ends run_until() soon, this one and every later one. From any thread, and from a signal handler.
  void stop();
  bool stopped() const { return stopped_.load(std::memory_order_relaxed); }

 private:
  struct Timer {
    Time when;
    std::uint64_t order;
    std::function<void()> callback;
  };
  struct Later {
    bool operator()(const Timer& a, const Timer& b) const {
      return a.when != b.when ? a.when > b.when : a.order > b.order;
    }
  };

  bool drain_ready();
  void serve_watched();
  void fire_due();
  void sleep_until(Time when);
  void wake();

  int event_fd_ = -1;
  std::atomic<bool> stopped_{false};
  std::uint64_t order_ = 0;
  std::vector<pollfd> polled_;                   ///< event_fd_, and what is watched
  std::vector<std::function<void()>> readable_;  ///< as polled_; none for event_fd_
  std::vector<Timer> timers_;                    ///< a heap, the earliest first
  std::vector<Source*> draining_;                ///< of the loop's thread only
  std::mutex mutex_;                             ///< guards what follows
  std::vector<Source*> ready_;
  bool sleeping_ = false;
};

}  // namespace sidestep
