// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <fastdds/rtps/common/LocatorList.hpp>
#include <fastdds/rtps/common/LocatorsIterator.hpp>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/TransportReceiverInterface.h>
#include <span>
#include <vector>

#include "common/messaging/dds/destinations.hpp"
#include "fast_dds/library.hpp"

namespace sidestep::fast_dds {

/// A transport that handles the datagrams of another transport.
class ChainedTransport : public transport::ChainingTransport {
 public:
  using ChainingTransport::ChainingTransport;

  /// Called before a datagram is sent to all participants (to a multicast address, or to all ports at which
  /// peers may be), as announcements are. `first_part` is the beginning of the datagram. Returns another
  /// datagram to be sent to the same destinations first; empty: none.
  virtual std::vector<std::uint8_t> before_announcement(std::span<const std::uint8_t> first_part) = 0;
  /// Called when a datagram has arrived. `next` processes it unless it is dropped here.
  virtual void on_datagram(transport::TransportReceiverInterface& next,
                           std::span<const std::uint8_t> datagram, const rtps::Locator_t& local,
                           const rtps::Locator_t& remote) = 0;

  void receive(transport::TransportReceiverInterface* next, const rtps::octet* data, std::uint32_t size,
               const rtps::Locator_t& local, const rtps::Locator_t& remote) final {
    on_datagram(*next, {data, size}, local, remote);
  }

  bool send(rtps::SenderResource* sender, const rtps::octet* data, std::uint32_t size,
            transport::LocatorsIterator* begin, transport::LocatorsIterator* end,
            const std::chrono::steady_clock::time_point& timeout) final {
    if (*begin == *end || !is_discovery(**begin)) return sender->send(data, size, begin, end, timeout);
    transport::LocatorList destinations;
    for (; *begin != *end; ++*begin) destinations.push_back(**begin);
    const auto send_to_all = [&](const rtps::octet* bytes, std::uint32_t count) {
      transport::Locators from(destinations.begin()), to(destinations.end());
      return sender->send(bytes, count, &from, &to, timeout);
    };
    if (!is_for_all_participants(destinations)) return send_to_all(data, size);
    const std::vector<std::uint8_t> first = before_announcement({data, size});
    if (!first.empty()) send_to_all(first.data(), static_cast<std::uint32_t>(first.size()));
    return send_to_all(data, size);
  }
};

}  // namespace sidestep::fast_dds
