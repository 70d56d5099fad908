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

/// Runs timers, and sources that other threads report as ready, in one thread. The thread sleeps in the
/// kernel while there is nothing to do.
class EventLoop {
 public:
  /// A source of work that becomes ready in another thread and is drained in the loop's thread. Must outlive
  /// the loop's last iteration.
  class Source {
   public:
    virtual ~Source() = default;
    /// Processes what has arrived, up to a bound so that timers are not starved. True: more may be left.
    virtual bool drain() = 0;

   private:
    friend class EventLoop;
    std::atomic<bool> ready_{false};
  };

  /// Throws std::system_error if no file descriptor is available.
  EventLoop();
  ~EventLoop();
  EventLoop(const EventLoop&) = delete;
  EventLoop& operator=(const EventLoop&) = delete;

  /// The process's clock, shared by all its loops. It is the host's clock at the first call or at the last
  /// adopt_host_clock(), plus the time that has passed since. Setting the host's clock does not affect it.
  static Time now();
  /// The host's clock minus the process's clock. It changes only when the host's clock is set: a time daemon
  /// that slews the host's clock slews both clocks.
  static Duration host_clock_ahead();
  /// Sets the process's clock to the host's. Precondition: no loop exists, because its timers would be wrong.
  static void adopt_host_clock();

  /// Calls back once at or after `when`; callbacks for equal times are made in the order of scheduling. Call
  /// it in the loop's thread, or before the loop runs.
  void at(Time when, std::function<void()> callback);
  /// Reports that the source is ready. Thread-safe.
  void notify(Source& source);
  /// Calls back soon; callbacks are made in the order of the calls. Thread-safe.
  void post(std::function<void()> callback);
  /// Calls back in every iteration in which the descriptor is readable. It must stay open until the loop's
  /// last iteration. Call it in the loop's thread, or before the loop runs.
  void watch(int descriptor, std::function<void()> readable);
  /// Runs until `when` or stop(). Timers that are due and sources that are ready at the call are always
  /// served.
  void run_until(Time when);
  /// Makes the current and all later calls of run_until() return soon. Thread-safe and async-signal-safe.
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
  void call_posted();
  void serve_watched();
  void fire_due();
  void sleep_until(Time when);
  void wake();

  int event_fd_ = -1;
  std::atomic<bool> stopped_{false};
  std::uint64_t order_ = 0;
  std::vector<pollfd> polled_;                   ///< event_fd_, then the watched descriptors
  std::vector<std::function<void()>> readable_;  ///< parallel to polled_; empty for event_fd_
  std::vector<Timer> timers_;                    ///< heap, the earliest first
  std::vector<Source*> draining_;                ///< used only by the loop's thread
  std::mutex mutex_;                             ///< guards the members below
  std::vector<Source*> ready_;
  std::vector<std::function<void()>> posted_;
  bool sleeping_ = false;
};

}  // namespace sidestep
