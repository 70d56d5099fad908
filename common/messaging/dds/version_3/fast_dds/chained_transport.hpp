// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <fastdds/rtps/common/LocatorList.hpp>
#include <fastdds/rtps/common/LocatorsIterator.hpp>
#include <fastdds/rtps/transport/ChainingTransport.hpp>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.hpp>
#include <fastdds/rtps/transport/TransportReceiverInterface.hpp>
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

  bool send(rtps::SenderResource* sender, const std::vector<rtps::NetworkBuffer>& buffers, std::uint32_t size,
            transport::LocatorsIterator* begin, transport::LocatorsIterator* end,
            const std::chrono::steady_clock::time_point& timeout) final {
    if (*begin == *end || !is_discovery(**begin) || buffers.empty())
      return sender->send(buffers, size, begin, end, timeout);
    transport::LocatorList destinations;
    for (; *begin != *end; ++*begin) destinations.push_back(**begin);
    const auto send_to_all = [&](const std::vector<rtps::NetworkBuffer>& parts, std::uint32_t count) {
      transport::Locators from(destinations.begin()), to(destinations.end());
      return sender->send(parts, count, &from, &to, timeout);
    };
    if (!is_for_all_participants(destinations)) return send_to_all(buffers, size);
    const std::vector<std::uint8_t> first =
        before_announcement({static_cast<const std::uint8_t*>(buffers[0].buffer), buffers[0].size});
    const auto first_size = static_cast<std::uint32_t>(first.size());
    if (!first.empty()) send_to_all({{first.data(), first_size}}, first_size);
    return send_to_all(buffers, size);
  }
};

}  // namespace sidestep::fast_dds
