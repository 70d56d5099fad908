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

constexpr std::size_t kHeaderSize = 20;  // of an RTPS datagram

/// The positions at which the submessages of a datagram begin (RTPS 2.2, 8.3.3).
std::vector<std::size_t> submessages(std::span<const std::uint8_t> datagram) {
  std::vector<std::size_t> result;
  for (std::size_t at = kHeaderSize; at + 4 <= datagram.size();) {
    result.push_back(at);
    const bool is_little_endian = (datagram[at + 1] & 1) != 0;
    const std::size_t length = is_little_endian ? datagram[at + 2] + 256U * datagram[at + 3]
                                                : datagram[at + 3] + 256U * datagram[at + 2];
    if (length == 0) break;
    at += 4 + length;
  }
  return result;
}

void send_to(int socket, in_addr address, std::uint16_t port, std::span<const std::uint8_t> bytes) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr = address;
  to.sin_port = htons(port);
  // The result is ignored, because datagrams may be lost anyway.
  (void)!sendto(socket, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

}  // namespace

std::vector<std::uint16_t> open_ports(int domain) {
  std::ifstream file("/proc/net/udp");
  std::vector<std::uint16_t> result;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    // Columns: "sl", then "local_address" such as 0100007F:1CE8.
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
  // The file has two lines for each protocol: names, then values.
  while (file >> protocol && protocol != "Udp:") std::getline(file, names);
  std::getline(file, names);
  std::uint64_t result = 0;
  if (!names.starts_with(" InDatagrams ") || !(file >> protocol >> result))
    throw std::runtime_error("cannot read the number of received datagrams");
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

std::vector<std::uint8_t> altered(std::span<const std::uint8_t> datagram, std::span<const std::uint8_t> other,
                                  Rng& rng) {
  std::vector<std::uint8_t> result(datagram.begin(), datagram.end());
  const std::vector<std::size_t> starts = submessages(datagram);
  if (starts.empty()) return result;
  const auto any_of = [&rng](const auto& values) { return values[rng.below(std::size(values))]; };
  const auto any_byte = [&rng] { return static_cast<std::uint8_t>(rng.below(256)); };
  const std::size_t start = any_of(starts);
  switch (rng.below(7)) {
    case 0:
      for (int left = 1 << rng.below(4); left > 0; --left)
        result[kHeaderSize + rng.below(result.size() - kHeaderSize)] = any_byte();
      break;
    case 1:
      result[start + rng.below(std::min<std::size_t>(40, result.size() - start))] =
          any_of(std::array<std::uint8_t, 6>{0, 1, 127, 128, 255, any_byte()});
      break;
    case 2:
      result.resize(kHeaderSize + rng.below(result.size() - kHeaderSize));
      break;
    case 3:
      if (const auto others = submessages(other); !others.empty())
        result.insert(result.end(), other.begin() + static_cast<std::ptrdiff_t>(any_of(others)), other.end());
      break;
    case 4: {
      const auto length =
          any_of(std::array<std::size_t, 7>{0, 1, 4, 20, 56, 65535, result.size() - kHeaderSize});
      result[start + 2] = static_cast<std::uint8_t>(length);
      result[start + 3] = static_cast<std::uint8_t>(length >> 8);
      break;
    }
    case 5:
      // Overwrites a sequence number of a heartbeat, a gap or an acknowledgement, high half first, with a
      // number of any magnitude.
      if (const std::size_t at = start + 12 + 8 * rng.below(2); at + 8 <= result.size()) {
        const std::uint64_t number = rng.bits() >> rng.below(64), halves = number >> 32 | number << 32;
        for (std::size_t i = 0; i < 8; ++i) result[at + i] = static_cast<std::uint8_t>(halves >> 8 * i);
      }
      break;
    default:
      result[start] =
          any_of(std::array<std::uint8_t, 17>{0x01, 0x06, 0x07, 0x08, 0x09, 0x0c, 0x0e, 0x0f, 0x12, 0x13,
                                              0x15, 0x16, 0x30, 0x31, 0x32, 0x33, 0x80});
  }
  return result;
}

DatagramSender::DatagramSender() : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  if (socket_ < 0) throw std::runtime_error("cannot create a socket");
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
