// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>

#include "common/league/endpoint.hpp"
#include "common/league/vision_packet.hpp"

namespace sidestep {

/// A second sender of vision packets in a simulator's multicast group, on the loopback interface. Its source
/// is a chosen endpoint: any address 127.x.x.x, and any free port if the port is 0.
class SecondSender {
 public:
  /// Throws std::runtime_error if another socket has the endpoint.
  SecondSender(const league::Endpoint& group, const league::Endpoint& from)
      : group_(group), socket_(league::open_udp_socket(group)) {
    const sockaddr_in address = league::socket_address(from);
    if (bind(socket_.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      league::fail(from, "send from this endpoint");
    const in_addr loopback{htonl(INADDR_LOOPBACK)};
    if (setsockopt(socket_.number(), IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback) != 0)
      league::fail(group, "send over the loopback interface");
  }

  /// False, with errno set, if the system did not accept the packet.
  [[nodiscard]] bool send(const league::VisionPacket& packet) {
    return league::send_to(socket_.number(), encode(packet), group_);
  }

 private:
  league::Endpoint group_;
  league::FileDescriptor socket_;
};

}  // namespace sidestep
