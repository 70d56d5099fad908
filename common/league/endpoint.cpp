// SPDX-License-Identifier: Apache-2.0
#include "common/league/endpoint.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fmt/format.h>
#include <optional>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>

namespace sidestep::league {
namespace {

bool is_multicast(std::uint32_t address) { return address >> 28 == 14; }

std::optional<std::uint32_t> address_of(const std::string& text) {
  in_addr address{};
  if (inet_pton(AF_INET, text.c_str(), &address) != 1) return std::nullopt;
  return ntohl(address.s_addr);
}

[[noreturn]] void reject(const std::string& text, const char* expected) {
  throw std::invalid_argument(fmt::format("\"{}\": expected {}", text, expected));
}

Endpoint parse_endpoint(const std::string& text, bool wants_multicast) {
  const auto colon = text.rfind(':');
  if (colon == std::string::npos)
    reject(text, wants_multicast ? "ADDRESS:PORT, such as 224.5.23.2:10006"
                                 : "ADDRESS:PORT, such as 127.0.0.1:10300");
  const auto address = address_of(text.substr(0, colon));
  if (!address || is_multicast(*address) != wants_multicast)
    reject(text, wants_multicast ? "a multicast address, 224.0.0.0 to 239.255.255.255"
                                 : "the IPv4 address of a machine, such as 127.0.0.1");
  std::uint16_t port = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + colon + 1, end, port);
  if (error != std::errc{} || rest != end || port == 0) reject(text, "a port, 1 to 65535");
  return {*address, port};
}

}  // namespace

std::string to_text(const Endpoint& endpoint) {
  const std::uint32_t address = endpoint.address;
  return fmt::format("{}.{}.{}.{}:{}", address >> 24, address >> 16 & 255, address >> 8 & 255, address & 255,
                     endpoint.port);
}

Endpoint parse_multicast_endpoint(const std::string& text) { return parse_endpoint(text, true); }

Endpoint parse_unicast_endpoint(const std::string& text) { return parse_endpoint(text, false); }

std::uint32_t parse_address(const std::string& text) {
  const auto address = address_of(text);
  if (!address || is_multicast(*address)) reject(text, "the IPv4 address of a machine, such as 127.0.0.1");
  return *address;
}

FileDescriptor::~FileDescriptor() { close(number_); }

void fail(const Endpoint& endpoint, const char* action) {
  throw std::runtime_error(fmt::format("{}: cannot {}: {}", to_text(endpoint), action, std::strerror(errno)));
}

int open_udp_socket(const Endpoint& endpoint) {
  const int number = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (number < 0) fail(endpoint, "open a socket");
  return number;
}

sockaddr_in socket_address(const Endpoint& endpoint) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(endpoint.port);
  address.sin_addr.s_addr = htonl(endpoint.address);
  return address;
}

void receive_all(int socket, std::span<std::byte> buffer, const DatagramHandler& handler) {
  constexpr int kMaxPerCall = 64;
  for (int i = 0; i < kMaxPerCall; ++i) {
    sockaddr_in from{};
    socklen_t from_size = sizeof from;
    const ssize_t size =
        recvfrom(socket, buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr*>(&from), &from_size);
    if (size < 0) return;
    handler(buffer.first(static_cast<std::size_t>(size)),
            {ntohl(from.sin_addr.s_addr), ntohs(from.sin_port)});
  }
}

bool send_to(int socket, std::span<const std::byte> datagram, const Endpoint& to) {
  const sockaddr_in address = socket_address(to);
  const ssize_t size = sendto(socket, datagram.data(), datagram.size(), 0,
                              reinterpret_cast<const sockaddr*>(&address), sizeof address);
  return size == static_cast<ssize_t>(datagram.size());
}

}  // namespace sidestep::league
