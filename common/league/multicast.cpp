// SPDX-License-Identifier: Apache-2.0
#include "common/league/multicast.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ifaddrs.h>
#include <memory>
#include <net/if.h>
#include <netinet/in.h>
#include <stdexcept>
#include <sys/socket.h>

namespace sidestep::league {
namespace {

std::string address_text(std::uint32_t address) {
  return fmt::format("{}.{}.{}.{}", address >> 24, address >> 16 & 255, address >> 8 & 255, address & 255);
}

std::uint32_t interface_address(const std::string& text) {
  std::vector<std::string> found;
  for (const NetworkInterface& interface : network_interfaces()) {
    if (interface.address == text) return parse_address(text);
    found.push_back(fmt::format("{} ({})", interface.address, interface.name));
  }
  throw std::invalid_argument(
      fmt::format("no network interface of this machine has the address \"{}\", expected one of {}", text,
                  fmt::join(found, ", ")));
}

template <typename Value>
void set(const FileDescriptor& socket, int level, int option, const Value& value, const Endpoint& group,
         const char* action) {
  if (setsockopt(socket.number(), level, option, &value, sizeof value) != 0) fail(group, action);
}

}  // namespace

std::vector<NetworkInterface> network_interfaces() {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) {
    throw std::runtime_error(fmt::format("cannot list the network interfaces: {}", std::strerror(errno)));
  }
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(list, freeifaddrs);
  std::vector<NetworkInterface> found;
  for (const ifaddrs* entry = list; entry; entry = entry->ifa_next) {
    if (!entry->ifa_addr || entry->ifa_addr->sa_family != AF_INET || !(entry->ifa_flags & IFF_UP)) continue;
    sockaddr_in address{};
    std::memcpy(&address, entry->ifa_addr, sizeof address);
    found.push_back({address_text(ntohl(address.sin_addr.s_addr)), entry->ifa_name});
  }
  return found;
}

MulticastSender::MulticastSender(const Endpoint& group, const std::string& interface)
    : group_(group), socket_(open_udp_socket(group)) {
  const in_addr from{htonl(interface_address(interface))};
  set(socket_, IPPROTO_IP, IP_MULTICAST_IF, from, group, "send over the interface");
  set(socket_, IPPROTO_IP, IP_MULTICAST_LOOP, 1, group, "send to this machine");
}

bool MulticastSender::send(std::span<const std::byte> datagram) {
  const bool is_sent = send_to(socket_.number(), datagram, group_);
  ++(is_sent ? sent_ : failed_);
  return is_sent;
}

MulticastReceiver::MulticastReceiver(const Endpoint& group, const std::string& interface)
    : group_(group), socket_(open_udp_socket(group)), buffer_(kMaxDatagramSize) {
  const ip_mreq membership{{htonl(group.address)}, {htonl(interface_address(interface))}};
  constexpr int kBufferSize = 1 << 20;  // enough for one second of packets from eight cameras
  set(socket_, SOL_SOCKET, SO_REUSEADDR, 1, group, "share the port");
  set(socket_, SOL_SOCKET, SO_RCVBUF, kBufferSize, group, "set the size of the receive buffer");
  // Without IP_MULTICAST_ALL = 0 and binding to the group's address, the socket would also receive unicast
  // datagrams, and datagrams of groups that other processes have joined.
  set(socket_, IPPROTO_IP, IP_MULTICAST_ALL, 0, group, "receive only this group");
  const sockaddr_in address = socket_address(group);
  if (bind(socket_.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    fail(group, "listen");
  }
  set(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, membership, group, "join the group");
}

void MulticastReceiver::receive(const DatagramHandler& handler) {
  receive_all(socket_.number(), buffer_, handler);
}

}  // namespace sidestep::league
