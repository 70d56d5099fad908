// SPDX-License-Identifier: Apache-2.0
#include "common/league/unicast.hpp"

#include <sys/socket.h>

namespace sidestep::league {

UnicastSocket::UnicastSocket(const std::optional<Endpoint>& local)
    : socket_(open_udp_socket(local.value_or(Endpoint{}))), buffer_(kMaxDatagramSize) {
  if (!local) return;
  const sockaddr_in address = socket_address(*local);
  if (bind(socket_.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    fail(*local, "listen");
}

bool UnicastSocket::send(std::span<const std::byte> datagram, const Endpoint& to) {
  const bool is_sent = send_to(socket_.number(), datagram, to);
  if (!is_sent) ++failed_;
  return is_sent;
}

}  // namespace sidestep::league
