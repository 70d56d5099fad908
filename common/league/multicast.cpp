// SPDX-License-Identifier: Apache-2.0
#include "common/league/multicast.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ifaddrs.h>
#include <memory>
#include <netinet/in.h>
#include <optional>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>

namespace sidestep::league {
namespace {

std::optional<std::uint32_t> parse_address(const std::string& text) {
  in_addr address{};
  if (inet_pton(AF_INET, text.c_str(), &address) != 1) return std::nullopt;
  return ntohl(address.s_addr);
}

std::string address_text(std::uint32_t address) {
  return fmt::format("{}.{}.{}.{}", address >> 24, address >> 16 & 255, address >> 8 & 255, address & 255);
}

std::uint32_t interface_address(const std::string& text) {
  const auto wanted = parse_address(text);
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) {
    throw std::runtime_error(fmt::format("cannot list the network interfaces: {}", std::strerror(errno)));
  }
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(list, freeifaddrs);
  std::vector<std::string> found;
  for (const ifaddrs* entry = list; entry; entry = entry->ifa_next) {
    if (!entry->ifa_addr || entry->ifa_addr->sa_family != AF_INET) continue;
    sockaddr_in address{};
    std::memcpy(&address, entry->ifa_addr, sizeof address);
    if (wanted && ntohl(address.sin_addr.s_addr) == *wanted) return *wanted;
    found.push_back(fmt::format("{} ({})", address_text(ntohl(address.sin_addr.s_addr)), entry->ifa_name));
  }
  throw std::invalid_argument(
      fmt::format("no network interface of this machine has the address \"{}\", expected one of {}", text,
                  fmt::join(found, ", ")));
}

sockaddr_in socket_address(const Endpoint& endpoint) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(endpoint.port);
  address.sin_addr.s_addr = htonl(endpoint.address);
  return address;
}

[[noreturn]] void fail(const Endpoint& group, const char* action) {
  throw std::runtime_error(fmt::format("{}: cannot {}: {}", to_text(group), action, std::strerror(errno)));
}

int udp_socket(const Endpoint& group) {
  const int number = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (number < 0) fail(group, "open a socket");
  return number;
}

template <typename Value>
void set(const FileDescriptor& socket, int level, int option, const Value& value, const Endpoint& group,
         const char* action) {
  if (setsockopt(socket.number(), level, option, &value, sizeof value) != 0) fail(group, action);
}

}  // namespace

std::string to_text(const Endpoint& endpoint) {
  return fmt::format("{}:{}", address_text(endpoint.address), endpoint.port);
}

Endpoint parse_multicast_endpoint(const std::string& text) {
  const auto fail = [&](const char* expected) {
    throw std::invalid_argument(fmt::format("\"{}\": expected {}", text, expected));
  };
  const auto colon = text.rfind(':');
  if (colon == std::string::npos) fail("ADDRESS:PORT, such as 224.5.23.2:10006");
  const auto address = parse_address(text.substr(0, colon));
  if (!address || *address >> 28 != 14) fail("a multicast address, 224.0.0.0 to 239.255.255.255");
  std::uint16_t port = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + colon + 1, end, port);
  if (error != std::errc{} || rest != end || port == 0) fail("a port, 1 to 65535");
  return {*address, port};
}

FileDescriptor::~FileDescriptor() { close(number_); }

MulticastSender::MulticastSender(const Endpoint& group, const std::string& interface)
    : group_(group), socket_(udp_socket(group)) {
  const in_addr from{htonl(interface_address(interface))};
  set(socket_, IPPROTO_IP, IP_MULTICAST_IF, from, group, "send over the interface");
  set(socket_, IPPROTO_IP, IP_MULTICAST_LOOP, 1, group, "send to this machine");
}

bool MulticastSender::send(std::span<const std::byte> datagram) {
  const sockaddr_in to = socket_address(group_);
  const ssize_t size = sendto(socket_.number(), datagram.data(), datagram.size(), 0,
                              reinterpret_cast<const sockaddr*>(&to), sizeof to);
  const bool is_sent = size == static_cast<ssize_t>(datagram.size());
  ++(is_sent ? sent_ : failed_);
  return is_sent;
}

MulticastReceiver::MulticastReceiver(const Endpoint& group, const std::string& interface)
    : group_(group), socket_(udp_socket(group)), buffer_(kMaxDatagramSize) {
  const ip_mreq membership{{htonl(group.address)}, {htonl(interface_address(interface))}};
  constexpr int kBufferSize = 1 << 20;  // holds one second of packets from eight cameras
  set(socket_, SOL_SOCKET, SO_REUSEADDR, 1, group, "share the port");
  set(socket_, SOL_SOCKET, SO_RCVBUF, kBufferSize, group, "set the size of the receive buffer");
  // Without IP_MULTICAST_ALL = 0 and binding to the group's address, the socket would also receive unicast
  // datagrams, and datagrams of groups that other processes have joined.
  set(socket_, IPPROTO_IP, IP_MULTICAST_ALL, 0, group, "receive this group only");
  const sockaddr_in address = socket_address(group);
  if (bind(socket_.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    fail(group, "listen");
  }
  set(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, membership, group, "join the group");
}

void MulticastReceiver::receive(const DatagramHandler& handler) {
  constexpr int kMaxPerCall = 64;
  for (int i = 0; i < kMaxPerCall; ++i) {
    sockaddr_in from{};
    socklen_t from_size = sizeof from;
    const ssize_t size = recvfrom(socket_.number(), buffer_.data(), buffer_.size(), 0,
                                  reinterpret_cast<sockaddr*>(&from), &from_size);
    if (size < 0) return;
    handler(std::span(buffer_).first(static_cast<std::size_t>(size)),
            {ntohl(from.sin_addr.s_addr), ntohs(from.sin_port)});
  }
}

}  // namespace sidestep::league
