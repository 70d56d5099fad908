// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/delayed_datagrams.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {

namespace rtps = fast_dds::rtps;
using SteadyClock = std::chrono::steady_clock;

DelayedDatagrams::DelayedDatagrams(TransportCounts& counts) : counts_(counts), thread_([this] { run(); }) {}

DelayedDatagrams::~DelayedDatagrams() {
  {
    const std::lock_guard lock(mutex_);
    is_stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void DelayedDatagrams::add(Duration delay, fast_dds::transport::TransportReceiverInterface& receiver,
                           std::span<const std::uint8_t> datagram, const rtps::Locator_t& local,
                           const rtps::Locator_t& remote) {
  constexpr std::size_t kMaxQueued = 1 << 16;
  {
    const std::lock_guard lock(mutex_);
    if (closed_.count(local.port)) return;
    if (queue_.size() >= kMaxQueued) {
      ++counts_.overflowed;
      return;
    }
    queue_.push_back(
        {SteadyClock::now() + delay, order_++, &receiver, {datagram.begin(), datagram.end()}, local, remote});
    std::push_heap(queue_.begin(), queue_.end());
  }
  changed_.notify_all();
}

void DelayedDatagrams::close(std::uint32_t port) {
  std::unique_lock lock(mutex_);
  closed_.insert(port);
  std::erase_if(queue_, [port](const Delayed& delayed) { return delayed.local.port == port; });
  std::make_heap(queue_.begin(), queue_.end());
  changed_.wait(lock, [&] { return delivering_port_ != port; });
}

void DelayedDatagrams::run() {
  std::unique_lock lock(mutex_);
  while (!is_stopping_) {
    if (queue_.empty()) {
      changed_.wait(lock);
      continue;
    }
    if (const auto when = queue_.front().when; when > SteadyClock::now()) {
      changed_.wait_until(lock, when);
      continue;
    }
    std::pop_heap(queue_.begin(), queue_.end());
    const Delayed next = std::move(queue_.back());
    queue_.pop_back();
    delivering_port_ = next.local.port;
    lock.unlock();
    next.receiver->OnDataReceived(next.bytes.data(), static_cast<std::uint32_t>(next.bytes.size()),
                                  next.local, next.remote);
    lock.lock();
    delivering_port_ = 0;
    changed_.notify_all();
  }
}

}  // namespace sidestep
