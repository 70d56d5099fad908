// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/league/decode_error.hpp"
#include "common/league/endpoint.hpp"

namespace sidestep::league {

/// The league's default endpoints.
inline constexpr const char* kVisionEndpoint = "224.5.23.2:10006";
inline constexpr const char* kTrackedEndpoint = "224.5.23.2:10010";
inline constexpr const char* kRefereeEndpoint = "224.5.23.1:10003";
/// The default endpoint of simulators. It differs from that of real cameras.
inline constexpr const char* kSimulatedVisionEndpoint = "224.5.23.2:10020";
/// The loopback interface, so that by default no packet leaves the machine.
inline constexpr const char* kLeagueInterface = "127.0.0.1";

/// A network interface of this machine with an IPv4 address.
struct NetworkInterface {
  std::string address, name;
};

/// All interfaces of this machine that are up. Throws std::runtime_error if they cannot be listed.
[[nodiscard]] std::vector<NetworkInterface> network_interfaces();

/// Sends datagrams to a multicast group over one interface, given by its address, without blocking. The TTL
/// is 1, so the datagrams stay in the local network. The constructor throws std::invalid_argument if the
/// machine has no such interface, and std::runtime_error if the socket cannot be opened.
class MulticastSender {
 public:
  MulticastSender(const Endpoint& group, const std::string& interface);

  /// False, with errno set, if the system did not accept the datagram.
  bool send(std::span<const std::byte> datagram);
  std::uint64_t sent() const { return sent_; }
  std::uint64_t failed() const { return failed_; }

 private:
  Endpoint group_;
  FileDescriptor socket_;
  std::uint64_t sent_ = 0;
  std::uint64_t failed_ = 0;
};

/// Receives the datagrams of a multicast group over one interface, and no others. Several receivers on a
/// machine may share a group. The constructor throws in the same cases as MulticastSender's.
class MulticastReceiver {
 public:
  MulticastReceiver(const Endpoint& group, const std::string& interface);

  /// Becomes readable when a datagram has arrived.
  int descriptor() const { return socket_.number(); }
  /// Calls `handler` for each datagram that has arrived, up to a bound, so that other work is not starved.
  void receive(const DatagramHandler& handler);

 private:
  Endpoint group_;
  FileDescriptor socket_;
  std::vector<std::byte> buffer_;
};

}  // namespace sidestep::league
