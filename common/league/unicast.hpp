// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/league/decode_error.hpp"
#include "common/league/endpoint.hpp"

namespace sidestep::league {

/// Sends datagrams to single machines and receives datagrams, without blocking. The constructor throws
/// std::runtime_error if the socket cannot be opened.
class UnicastSocket {
 public:
  /// Receives at this endpoint of the machine. nullopt: at any free port, to receive replies.
  explicit UnicastSocket(const std::optional<Endpoint>& local);

  /// Becomes readable when a datagram has arrived.
  int descriptor() const { return socket_.number(); }
  /// Calls `handler` for each datagram that has arrived, up to a bound, so that other work is not starved.
  void receive(const DatagramHandler& handler) { receive_all(socket_.number(), buffer_, handler); }
  /// False, with errno set, if the system did not accept the datagram.
  bool send(std::span<const std::byte> datagram, const Endpoint& to);
  std::uint64_t failed() const { return failed_; }

 private:
  FileDescriptor socket_;
  std::vector<std::byte> buffer_;
  std::uint64_t failed_ = 0;
};

}  // namespace sidestep::league
