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

constexpr std::size_t kMaxQueued = 1 << 16;  ///< datagrams; further ones are lost
constexpr std::size_t kHeaderBytes = 20;     ///< RTPS 2.2, 9.4.4: protocol, version, vendor, GUID prefix
constexpr std::size_t kPrefixOffset = 8;
constexpr octet kOperatorMark[] = {'s', 's', 'o', 'p'};

/// Ports are 7400 + 250 domain + an offset: 0 and 10 + 2 i for discovery, 1 and 11 + 2 i for messages (RTPS
/// 2.2, 9.6.1).
bool is_discovery(const Locator_t& local) { return local.port % 2 == 0; }

/// Holds delayed datagrams. Its own thread passes each one on when the delay is over.
class DelayedDatagrams {
 public:
  DelayedDatagrams() : thread_([this] { run(); }) {}
  ~DelayedDatagrams() {
    {
      const std::lock_guard lock(mutex_);
      is_stopping_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  DelayedDatagrams(const DelayedDatagrams&) = delete;
  DelayedDatagrams& operator=(const DelayedDatagrams&) = delete;

  void add(Duration delay, fast::TransportReceiverInterface* receiver, const octet* data, std::uint32_t size,
           const Locator_t& local, const Locator_t& remote) {
    {
      const std::lock_guard lock(mutex_);
      if (queue_.size() >= kMaxQueued || closed_.count(local.port)) return;
      queue_.push_back({SteadyClock::now() + delay, order_++, receiver, {data, data + size}, local, remote});
      std::push_heap(queue_.begin(), queue_.end());
    }
    changed_.notify_all();
  }

  /// Drops the port's datagrams. Once this returns, none is being passed on, and none will be.
  void close(std::uint32_t port) {
    std::unique_lock lock(mutex_);
    closed_.insert(port);
    std::erase_if(queue_, [port](const Datagram& datagram) { return datagram.local.port == port; });
    std::make_heap(queue_.begin(), queue_.end());
    changed_.wait(lock, [&] { return delivering_port_ != port; });
  }

 private:
  struct Datagram {
    SteadyClock::time_point when;
    std::uint64_t order;
    fast::TransportReceiverInterface* receiver;
    std::vector<octet> bytes;
    Locator_t local, remote;

    /// Puts the earliest on top of a heap.
    bool operator<(const Datagram& other) const {
      return when != other.when ? when > other.when : order > other.order;
    }
  };

  void run() {
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
      const Datagram next = std::move(queue_.back());
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

  std::mutex mutex_;  ///< guards all other members but the thread
  std::condition_variable changed_;
  std::vector<Datagram> queue_;  ///< heap
  std::set<std::uint32_t> closed_;
  std::uint64_t order_ = 0;
  std::uint32_t delivering_port_ = 0;
  bool is_stopping_ = false;
  std::thread thread_;
};

struct FaultTransportDescriptor : fast::ChainingTransportDescriptor {
  FaultTransportDescriptor(std::shared_ptr<fast::TransportDescriptorInterface> udp,
                           std::shared_ptr<Impairment> impairment_of_process)
      : ChainingTransportDescriptor(std::move(udp)), impairment(std::move(impairment_of_process)) {}

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
    if (size >= kHeaderBytes) std::memcpy(sender.data(), data + kPrefixOffset, sender.size());
    const MessageCopies copies = descriptor_.impairment->receive(sender);
    for (std::size_t i = 0; i < copies.count; ++i) {
      if (copies.delays[i] <= Duration::zero()) {
        receiver->OnDataReceived(data, size, local, remote);
      } else {
        delayed_.add(copies.delays[i], receiver, data, size, local, remote);
      }
    }
  }

  bool CloseInputChannel(const Locator_t& locator) override {
    delayed_.close(locator.port);
    return ChainingTransport::CloseInputChannel(locator);
  }

 private:
  static bool is_from_operator(const octet* data, std::uint32_t size) {
    return size >= kHeaderBytes &&
           std::memcmp(data + kPrefixOffset, kOperatorMark, sizeof kOperatorMark) == 0;
  }

  FaultTransportDescriptor descriptor_;
  DelayedDatagrams delayed_;
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
  const std::uint64_t unique = static_cast<std::uint64_t>(SteadyClock::now().time_since_epoch().count()) ^
                               (static_cast<std::uint64_t>(getpid()) << 40);
  std::memcpy(prefix.value, kOperatorMark, sizeof kOperatorMark);
  std::memcpy(prefix.value + sizeof kOperatorMark, &unique, sizeof unique);
  return prefix;
}

}  // namespace sidestep
