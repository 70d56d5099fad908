// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/fault_transport.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/TransportReceiverInterface.h>
#include <mutex>
#include <set>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

namespace sidestep {
namespace {

namespace fast = eprosima::fastdds::rtps;
using eprosima::fastrtps::rtps::GuidPrefix_t;
using eprosima::fastrtps::rtps::Locator_t;
using eprosima::fastrtps::rtps::octet;
using SteadyClock = std::chrono::steady_clock;

constexpr std::size_t kMostWaiting = 1 << 16;  ///< datagrams; what comes beyond is lost
constexpr std::size_t kHeaderBytes = 20;       ///< RTPS 2.2, 9.4.4: protocol, version, vendor, prefix
constexpr std::size_t kPrefixAt = 8;
constexpr octet kOperatorMark[] = {'s', 's', 'o', 'p'};

/// Ports are 7400 + 250 domain + 0 and 10 + 2 i for discovery, 1 and 11 + 2 i for messages (RTPS 2.2, 9.6.1).
bool is_discovery(const Locator_t& local) { return local.port % 2 == 0; }

/// One thread that hands datagrams on when their time has come.
class LateCopies {
 public:
  LateCopies() : thread_([this] { run(); }) {}
  ~LateCopies() {
    {
      const std::lock_guard lock(mutex_);
      is_over_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  LateCopies(const LateCopies&) = delete;
  LateCopies& operator=(const LateCopies&) = delete;

  void add(Duration delay, fast::TransportReceiverInterface* receiver, const octet* data, std::uint32_t size,
           const Locator_t& local, const Locator_t& remote) {
    {
      const std::lock_guard lock(mutex_);
      if (waiting_.size() >= kMostWaiting || closed_.count(local.port)) return;
      waiting_.push_back(
          {SteadyClock::now() + delay, order_++, receiver, {data, data + size}, local, remote});
      std::push_heap(waiting_.begin(), waiting_.end());
    }
    changed_.notify_all();
  }

  /// Nothing that came to this port is handed on any more, and none is being when this returns.
  void close(std::uint32_t port) {
    std::unique_lock lock(mutex_);
    closed_.insert(port);
    std::erase_if(waiting_, [port](const Datagram& datagram) { return datagram.local.port == port; });
    std::make_heap(waiting_.begin(), waiting_.end());
    changed_.wait(lock, [&] { return port_in_hand_ != port; });
  }

 private:
  struct Datagram {
    SteadyClock::time_point when;
    std::uint64_t order;
    fast::TransportReceiverInterface* receiver;
    std::vector<octet> bytes;
    Locator_t local, remote;

    /// The earliest on top of a heap.
    bool operator<(const Datagram& other) const {
      return when != other.when ? when > other.when : order > other.order;
    }
  };

  void run() {
    std::unique_lock lock(mutex_);
    while (!is_over_) {
      if (waiting_.empty()) {
        changed_.wait(lock);
        continue;
      }
      if (const auto when = waiting_.front().when; when > SteadyClock::now()) {
        changed_.wait_until(lock, when);
        continue;
      }
      std::pop_heap(waiting_.begin(), waiting_.end());
      const Datagram next = std::move(waiting_.back());
      waiting_.pop_back();
      port_in_hand_ = next.local.port;
      lock.unlock();
      next.receiver->OnDataReceived(next.bytes.data(), static_cast<std::uint32_t>(next.bytes.size()),
                                    next.local, next.remote);
      lock.lock();
      port_in_hand_ = 0;
      changed_.notify_all();
    }
  }

  std::mutex mutex_;  ///< guards all but the thread
  std::condition_variable changed_;
  std::vector<Datagram> waiting_;  ///< a heap
  std::set<std::uint32_t> closed_;
  std::uint64_t order_ = 0;
  std::uint32_t port_in_hand_ = 0;
  bool is_over_ = false;
  std::thread thread_;
};

struct FaultTransportDescriptor : fast::ChainingTransportDescriptor {
  FaultTransportDescriptor(std::shared_ptr<fast::TransportDescriptorInterface> udp,
                           std::shared_ptr<Impairment> impairment_of_all)
      : ChainingTransportDescriptor(std::move(udp)), impairment(std::move(impairment_of_all)) {}

  fast::TransportInterface* create_transport() const override;

  std::shared_ptr<Impairment> impairment;
};

class FaultTransport : public fast::ChainingTransport {
 public:
  explicit FaultTransport(const FaultTransportDescriptor& descriptor)
      : ChainingTransport(descriptor), descriptor_(descriptor) {}

  fast::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

  bool send(eprosima::fastrtps::rtps::SenderResource* sender, const octet* data, std::uint32_t size,
            eprosima::fastrtps::rtps::LocatorsIterator* begin,
            eprosima::fastrtps::rtps::LocatorsIterator* end,
            const SteadyClock::time_point& timeout) override {
    return sender->send(data, size, begin, end, timeout);
  }

  void receive(fast::TransportReceiverInterface* receiver, const octet* data, std::uint32_t size,
               const Locator_t& local, const Locator_t& remote) override {
    if (is_discovery(local) || is_from_operator(data, size)) {
      receiver->OnDataReceived(data, size, local, remote);
      return;
    }
    Impairment::SenderId sender{};
    if (size >= kHeaderBytes) std::memcpy(sender.data(), data + kPrefixAt, sender.size());
    const Copies copies = descriptor_.impairment->receive(sender);
    for (std::size_t i = 0; i < copies.count; ++i) {
      if (copies.delays[i] <= Duration::zero()) {
        receiver->OnDataReceived(data, size, local, remote);
      } else {
        late_copies_.add(copies.delays[i], receiver, data, size, local, remote);
      }
    }
  }

  bool CloseInputChannel(const Locator_t& locator) override {
    late_copies_.close(locator.port);
    return ChainingTransport::CloseInputChannel(locator);
  }

 private:
  static bool is_from_operator(const octet* data, std::uint32_t size) {
    return size >= kHeaderBytes && std::memcmp(data + kPrefixAt, kOperatorMark, sizeof kOperatorMark) == 0;
  }

  FaultTransportDescriptor descriptor_;
  LateCopies late_copies_;
};

fast::TransportInterface* FaultTransportDescriptor::create_transport() const {
  return new FaultTransport(*this);
}

}  // namespace

std::shared_ptr<fast::TransportDescriptorInterface> fault_transport(
    std::shared_ptr<fast::UDPv4TransportDescriptor> udp, std::shared_ptr<Impairment> impairment) {
  return std::make_shared<FaultTransportDescriptor>(std::move(udp), std::move(impairment));
}

GuidPrefix_t operator_prefix() {
  GuidPrefix_t prefix;
  const std::uint64_t life = static_cast<std::uint64_t>(SteadyClock::now().time_since_epoch().count()) ^
                             (static_cast<std::uint64_t>(getpid()) << 40);
  std::memcpy(prefix.value, kOperatorMark, sizeof kOperatorMark);
  std::memcpy(prefix.value + sizeof kOperatorMark, &life, sizeof life);
  return prefix;
}

}  // namespace sidestep
