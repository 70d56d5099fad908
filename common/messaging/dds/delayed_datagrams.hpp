// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <set>
#include <span>
#include <thread>
#include <vector>

#include "common/messaging/dds/transport_counts.hpp"
#include "common/time/time.hpp"
#include "fast_dds/chained_transport.hpp"

namespace sidestep {

/// Holds delayed datagrams. A thread of this object passes each datagram on after its delay.
class DelayedDatagrams {
 public:
  /// `counts` must outlive this object.
  explicit DelayedDatagrams(TransportCounts& counts);
  ~DelayedDatagrams();
  DelayedDatagrams(const DelayedDatagrams&) = delete;
  DelayedDatagrams& operator=(const DelayedDatagrams&) = delete;

  /// Delays a datagram. If too many are waiting, it is dropped and counted.
  void add(Duration delay, fast_dds::transport::TransportReceiverInterface& receiver,
           std::span<const std::uint8_t> datagram, const fast_dds::rtps::Locator_t& local,
           const fast_dds::rtps::Locator_t& remote);
  /// Drops the port's datagrams. After this call, no datagram of the port is passed on.
  void close(std::uint32_t port);

 private:
  struct Delayed {
    std::chrono::steady_clock::time_point when;
    std::uint64_t order;
    fast_dds::transport::TransportReceiverInterface* receiver;
    std::vector<std::uint8_t> bytes;
    fast_dds::rtps::Locator_t local, remote;

    /// Inverted, so that the earliest is at the top of a heap.
    bool operator<(const Delayed& other) const {
      return when != other.when ? when > other.when : order > other.order;
    }
  };

  void run();

  TransportCounts& counts_;
  std::mutex mutex_;  ///< guards all members below except the thread
  std::condition_variable changed_;
  std::vector<Delayed> queue_;  ///< heap
  std::set<std::uint32_t> closed_;
  std::uint64_t order_ = 0;
  std::uint32_t delivering_port_ = 0;
  bool is_stopping_ = false;
  std::thread thread_;
};

}  // namespace sidestep
