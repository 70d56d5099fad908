// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/datagrams.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <charconv>
#include <fstream>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <netinet/ip.h>
#include <netinet/udp.h>
#include <poll.h>
#include <sstream>
#include <stdexcept>
#include <string>
#include <sys/socket.h>
#include <unistd.h>

namespace sidestep {
namespace {

constexpr std::size_t kMaxCaptured = 100'000;
constexpr std::uint16_t kPortsOfDomain = 250;

std::uint16_t first_port(int domain) { return static_cast<std::uint16_t>(7400 + kPortsOfDomain * domain); }

void send_to(int socket, in_addr address, std::uint16_t port, std::span<const std::uint8_t> bytes) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr = address;
  to.sin_port = htons(port);
  // Whether it arrives is the receiver's affair.
  (void)!sendto(socket, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

}  // namespace

std::vector<std::uint16_t> open_ports(int domain) {
  std::ifstream file("/proc/net/udp");
  std::vector<std::uint16_t> result;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    // "  sl  local_address", the latter as 0100007F:1CE8
    std::istringstream words(line);
    std::string slot, local;
    words >> slot >> local;
    const auto colon = local.find(':');
    std::uint16_t port = 0;
    std::from_chars(local.data() + colon + 1, local.data() + local.size(), port, 16);
    if (port >= first_port(domain) && port < first_port(domain) + kPortsOfDomain) result.push_back(port);
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::uint64_t datagrams_read() {
  std::ifstream file("/proc/net/snmp");
  std::string protocol, names;
  // Two lines for each protocol: names, and values.
  while (file >> protocol && protocol != "Udp:") std::getline(file, names);
  std::getline(file, names);
  std::uint64_t result = 0;
  if (!names.starts_with(" InDatagrams ") || !(file >> protocol >> result))
    throw std::runtime_error("cannot read how many datagrams arrived");
  return result;
}

Capture::Capture(int domain)
    : socket_(socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC, htons(ETH_P_IP))),
      first_port_(first_port(domain)),
      last_port_(static_cast<std::uint16_t>(first_port(domain) + kPortsOfDomain - 1)) {
  sockaddr_ll address{};
  address.sll_family = AF_PACKET;
  address.sll_protocol = htons(ETH_P_IP);
  address.sll_ifindex = static_cast<int>(if_nametoindex("lo"));
  if (socket_ < 0 || bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("cannot capture packets");
  thread_ = std::thread([this] { run(); });
}

Capture::~Capture() {
  is_stopped_ = true;
  thread_.join();
  close(socket_);
}

std::vector<CapturedDatagram> Capture::datagrams() const {
  const std::lock_guard lock(mutex_);
  return datagrams_;
}

void Capture::run() {
  std::array<std::uint8_t, 65536> packet{};
  while (!is_stopped_) {
    pollfd ready{socket_, POLLIN, 0};
    if (poll(&ready, 1, 50) != 1) continue;
    sockaddr_ll from{};
    socklen_t from_size = sizeof from;
    const ssize_t received =
        recvfrom(socket_, packet.data(), packet.size(), 0, reinterpret_cast<sockaddr*>(&from), &from_size);
    // The loopback interface shows each packet twice.
    if (received < static_cast<ssize_t>(sizeof(iphdr) + sizeof(udphdr)) ||
        from.sll_pkttype == PACKET_OUTGOING)
      continue;
    const auto* const ip = reinterpret_cast<const iphdr*>(packet.data());
    const std::size_t header = ip->ihl * 4U;
    const bool is_fragment = (ntohs(ip->frag_off) & 0x3fff) != 0;
    const auto size = static_cast<std::size_t>(received);
    if (ip->protocol != IPPROTO_UDP || is_fragment || header + sizeof(udphdr) > size) continue;
    const auto* const udp = reinterpret_cast<const udphdr*>(packet.data() + header);
    const std::uint16_t port = ntohs(udp->dest);
    if (port < first_port_ || port > last_port_) continue;
    const std::lock_guard lock(mutex_);
    if (datagrams_.size() >= kMaxCaptured) continue;
    datagrams_.push_back({port, {packet.data() + header + sizeof(udphdr), packet.data() + size}});
  }
}

DatagramSender::DatagramSender() : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  if (socket_ < 0) throw std::runtime_error("cannot make a socket");
  in_addr loopback{htonl(INADDR_LOOPBACK)};
  setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback);
}

DatagramSender::~DatagramSender() { close(socket_); }

void DatagramSender::send(std::uint16_t port, std::span<const std::uint8_t> bytes) {
  send_to(socket_, {htonl(INADDR_LOOPBACK)}, port, bytes);
}

void DatagramSender::announce(int domain, std::span<const std::uint8_t> bytes) {
  send_to(socket_, {inet_addr("239.255.0.1")}, first_port(domain), bytes);
}

}  // namespace sidestep
