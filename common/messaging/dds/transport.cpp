// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/transport.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <mutex>
#include <optional>
#include <unistd.h>
#include <utility>
#include <vector>

#include "common/messaging/dds/datagram.hpp"
#include "common/messaging/dds/datagram_check.hpp"
#include "common/messaging/dds/delayed_datagrams.hpp"
#include "common/messaging/dds/destinations.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "common/messaging/dds/participant_filter.hpp"
#include "common/messaging/dds/presence.hpp"
#include "fast_dds/chained_transport.hpp"

namespace sidestep {
namespace {

namespace rtps = fast_dds::rtps;
namespace transport = fast_dds::transport;
using Bytes = std::span<const std::uint8_t>;
using Receiver = transport::TransportReceiverInterface;

constexpr std::array<std::uint8_t, 4> kOperatorMark{'s', 's', 'o', 'p'};
constexpr Duration kCheckInterval{500'000'000};
/// Fast DDS announces a participant a few milliseconds before it can process the answers.
constexpr Duration kReadyDelay{50'000'000};

/// A number of bytes that writers never reach; they also send periodic heartbeats.
constexpr std::uint32_t kBytesUntilHeartbeat = 1U << 30;

bool has_operator_mark(const ParticipantId& id) {
  return std::equal(kOperatorMark.begin(), kOperatorMark.end(), id.begin());
}

struct UdpDescriptor : transport::ChainingTransportDescriptor {
  UdpDescriptor(std::shared_ptr<transport::TransportDescriptorInterface> udp,
                std::shared_ptr<Impairment> impairment_of_process,
                std::shared_ptr<TransportCounts> counts_of_process,
                std::shared_ptr<ParticipantFilter> filter_of_participant)
      : ChainingTransportDescriptor(std::move(udp)),
        impairment(std::move(impairment_of_process)),
        counts(std::move(counts_of_process)),
        filter(std::move(filter_of_participant)) {}

  transport::TransportInterface* create_transport() const override;
  /// Fast DDS sends a heartbeat to all readers of a writer whenever the writer has sent this many bytes. For
  /// discovery writers the count is far too high (2.9.1 sums running totals), so each new participant would
  /// cause heartbeats from and to all others for every second endpoint. With 25 participants, these
  /// heartbeats are most of the packets at start-up.
  std::uint32_t min_send_buffer_size() const override { return kBytesUntilHeartbeat; }

  std::shared_ptr<Impairment> impairment;
  std::shared_ptr<TransportCounts> counts;
  std::shared_ptr<ParticipantFilter> filter;  ///< null without keys
};

class UdpTransport : public fast_dds::ChainedTransport {
 public:
  explicit UdpTransport(const UdpDescriptor& descriptor)
      : ChainedTransport(descriptor), descriptor_(descriptor) {
    if (descriptor_.impairment) delayed_.emplace(*descriptor_.counts);
  }

  transport::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

  std::vector<std::uint8_t> before_announcement(Bytes first_part) override {
    const std::optional<ParticipantId> self = sender_of(first_part);
    if (!self) return {};
    const std::lock_guard lock(state_);
    if (!self_) announced_at_ = EventLoop::now();
    self_ = self;
    return presence_datagram(*self, presence_.notices(EventLoop::now()));
  }

  void on_datagram(Receiver& next, Bytes datagram, const rtps::Locator_t& local,
                   const rtps::Locator_t& remote) override {
    const std::optional<ParticipantId> sender = sender_of(datagram);
    if (!sender) return;  // Fast DDS would also refuse this datagram
    if (!presence_notices(datagram)) {
      datagram = descriptor_.filter ? checked_datagram(datagram) : without_statistics(datagram);
      descriptor_.counts->malformed += datagram.empty();
      if (datagram.empty()) return;
    }
    if (!passes_gate(*sender, datagram, local, remote)) return;
    if (is_discovery(local))
      on_discovery(next, *sender, datagram, local, remote);
    else if (accept(*sender))
      on_message(next, *sender, datagram, local, remote);
  }

  bool CloseInputChannel(const rtps::Locator_t& locator) override {
    if (delayed_) delayed_->close(locator.port);
    return ChainingTransport::CloseInputChannel(locator);
  }

 private:
  bool passes_gate(const ParticipantId& sender, Bytes datagram, const rtps::Locator_t& local,
                   const rtps::Locator_t& remote) {
    return !descriptor_.filter || descriptor_.filter->passes(sender, datagram, is_discovery(local),
                                                             std::span(remote.address).last<4>());
  }

  bool is_operator(const ParticipantId& id) const {
    return descriptor_.filter ? descriptor_.filter->is_operator(id) : has_operator_mark(id);
  }

  bool accept(const ParticipantId& sender) {
    const std::lock_guard lock(state_);
    const bool is_accepted = presence_.accept(sender, EventLoop::now());
    descriptor_.counts->forgotten += !is_accepted;
    return is_accepted;
  }

  /// Processes discovery datagrams one at a time, so that Fast DDS receives no datagram of a participant
  /// while forgetting it.
  void on_discovery(Receiver& next, const ParticipantId& sender, Bytes datagram, const rtps::Locator_t& local,
                    const rtps::Locator_t& remote) {
    const std::lock_guard one_at_a_time(discovery_);
    const auto notices = presence_notices(datagram);
    if (is_ready()) {
      for (const Early& early : std::exchange(early_, {})) {
        if (accept(early.sender)) pass_on(next, early.datagram, early.local, early.remote);
      }
    } else if (!notices && early_.size() < kMaxEarly) {
      early_.push_back({sender, {datagram.begin(), datagram.end()}, local, remote});
    } else if (!notices) {
      ++descriptor_.counts->overflowed;
    }
    for (const ParticipantId& id : to_forget(sender, notices)) {
      const Datagram departure = departure_of(id);
      pass_on(next, departure, local, remote);
    }
    if (!notices && accept(sender)) pass_on(next, datagram, local, remote);
  }

  bool is_ready() {
    const std::lock_guard lock(state_);
    return announced_at_ && EventLoop::now() - *announced_at_ > kReadyDelay;
  }

  std::vector<ParticipantId> to_forget(const ParticipantId& sender,
                                       const std::optional<std::vector<PresenceNotice>>& notices) {
    const std::lock_guard lock(state_);
    const Time now = EventLoop::now();
    std::vector<ParticipantId> result;
    if (notices && self_ && sender != *self_ && presence_.on_announcement(*self_, sender, *notices, now))
      result.push_back(sender);
    // This participant's own announcements also arrive here, so the check runs at least once a second.
    if (now - checked_at_ > kCheckInterval) {
      checked_at_ = now;
      const std::vector<ParticipantId> silent = presence_.newly_silent(now);
      result.insert(result.end(), silent.begin(), silent.end());
      if (descriptor_.filter) {
        const std::vector<ParticipantId> refused = descriptor_.filter->newly_refused();
        result.insert(result.end(), refused.begin(), refused.end());
      }
    }
    return result;
  }

  void on_message(Receiver& next, const ParticipantId& sender, Bytes datagram, const rtps::Locator_t& local,
                  const rtps::Locator_t& remote) {
    static thread_local Datagram copy;
    if (descriptor_.filter && copy_without_timestamp(datagram, copy)) datagram = copy;
    if (!descriptor_.impairment || is_operator(sender)) return pass_on(next, datagram, local, remote);
    const MessageCopies copies = descriptor_.impairment->receive(sender);
    descriptor_.counts->impaired += copies.count == 0;
    for (std::size_t i = 0; i < copies.count; ++i) {
      if (copies.delays[i] <= Duration::zero())
        pass_on(next, datagram, local, remote);
      else
        delayed_->add(copies.delays[i], next, datagram, local, remote);
    }
  }

  static void pass_on(Receiver& next, Bytes datagram, const rtps::Locator_t& local,
                      const rtps::Locator_t& remote) {
    next.OnDataReceived(datagram.data(), static_cast<std::uint32_t>(datagram.size()), local, remote);
  }

  /// A datagram that arrived early, and may have been lost because Fast DDS was not ready.
  struct Early {
    ParticipantId sender;
    Datagram datagram;
    rtps::Locator_t local, remote;
  };
  static constexpr std::size_t kMaxEarly = 1024;

  UdpDescriptor descriptor_;
  std::mutex discovery_;      ///< guards early_ and orders what is passed to Fast DDS
  std::vector<Early> early_;  ///< passed on again once Fast DDS is ready
  std::mutex state_;          ///< guards the members below; never held while Fast DDS is called
  std::optional<ParticipantId> self_;
  std::optional<Time> announced_at_;
  Presence presence_;
  Time checked_at_{};
  std::optional<DelayedDatagrams> delayed_;  ///< nullopt without an impairment
};

transport::TransportInterface* UdpDescriptor::create_transport() const { return new UdpTransport(*this); }

}  // namespace

std::shared_ptr<transport::TransportDescriptorInterface> udp_transport(
    std::shared_ptr<transport::UDPv4TransportDescriptor> udp, std::shared_ptr<Impairment> impairment,
    std::shared_ptr<TransportCounts> counts, std::shared_ptr<ParticipantFilter> filter) {
  return std::make_shared<UdpDescriptor>(std::move(udp), std::move(impairment), std::move(counts),
                                         std::move(filter));
}

rtps::GuidPrefix_t operator_prefix() {
  rtps::GuidPrefix_t prefix;
  const std::uint64_t unique =
      static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count()) ^
      (static_cast<std::uint64_t>(getpid()) << 40);
  std::memcpy(prefix.value, kOperatorMark.data(), kOperatorMark.size());
  std::memcpy(prefix.value + kOperatorMark.size(), &unique, sizeof unique);
  return prefix;
}

}  // namespace sidestep
