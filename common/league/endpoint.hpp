// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <netinet/in.h>
#include <span>
#include <string>

namespace sidestep::league {

/// An IPv4 address and a port in host byte order: 127.0.0.1 is 0x7f000001.
struct Endpoint {
  std::uint32_t address = 0;
  std::uint16_t port = 0;
  auto operator<=>(const Endpoint&) const = default;
};

/// Formats an endpoint, for example "224.5.23.2:10006".
std::string to_text(const Endpoint& endpoint);

/// Parses ADDRESS:PORT with a multicast address (224.0.0.0 to 239.255.255.255) and a port (1 to 65535).
/// Throws std::invalid_argument that says what was expected.
[[nodiscard]] Endpoint parse_multicast_endpoint(const std::string& text);
/// Parses ADDRESS:PORT with a unicast address. Throws std::invalid_argument that says what was expected.
[[nodiscard]] Endpoint parse_unicast_endpoint(const std::string& text);
/// Parses an IPv4 address such as 127.0.0.1. Throws std::invalid_argument that says what was expected.
[[nodiscard]] std::uint32_t parse_address(const std::string& text);

/// An owned file descriptor.
class FileDescriptor {
 public:
  explicit FileDescriptor(int number) : number_(number) {}
  ~FileDescriptor();
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

/// Called with a datagram and its source.
using DatagramHandler = std::function<void(std::span<const std::byte>, const Endpoint&)>;

/// Opens a non-blocking UDP socket. Throws std::runtime_error that names the endpoint.
[[nodiscard]] int open_udp_socket(const Endpoint& endpoint);
/// Throws std::runtime_error with the endpoint, the action and the reason in errno.
[[noreturn]] void fail(const Endpoint& endpoint, const char* action);
sockaddr_in socket_address(const Endpoint& endpoint);
/// Calls `handler` for each datagram that has arrived, up to a bound, so that other work is not starved.
void receive_all(int socket, std::span<std::byte> buffer, const DatagramHandler& handler);
/// Whether the system accepted the datagram; otherwise errno says why not.
[[nodiscard]] bool send_to(int socket, std::span<const std::byte> datagram, const Endpoint& to);

}  // namespace sidestep::league
