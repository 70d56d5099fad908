// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "common/random/rng.hpp"

namespace sidestep {

/// A captured UDP datagram, sent to a port of this machine's loopback interface.
struct CapturedDatagram {
  std::uint16_t port = 0;
  std::vector<std::uint8_t> bytes;
};

/// The UDP ports of a DDS domain on which processes of this network namespace listen (RTPS 2.2, 9.6.1.1).
std::vector<std::uint16_t> open_ports(int domain);

/// Number of UDP datagrams that the processes of this network namespace have read so far.
std::uint64_t datagrams_read();

/// Captures the datagrams of a DDS domain on the loopback interface from its construction on. Needs root.
class Capture {
 public:
  /// Throws std::runtime_error.
  explicit Capture(int domain);
  ~Capture();
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  /// The datagrams captured so far, oldest first; at most the first hundred thousand.
  std::vector<CapturedDatagram> datagrams() const;

 private:
  void run();

  int socket_;
  std::uint16_t first_port_, last_port_;
  std::atomic<bool> is_stopped_{false};
  mutable std::mutex mutex_;
  std::vector<CapturedDatagram> datagrams_;
  std::thread thread_;
};

/// Alters a DDS process's datagram like an attacker without keys: changes single bytes or the kind, length or
/// content of a submessage, cuts off the end, or appends submessages of another datagram.
std::vector<std::uint8_t> altered(std::span<const std::uint8_t> datagram, std::span<const std::uint8_t> other,
                                  Rng& rng);

/// Sends datagrams to ports of the loopback interface from a port of its own.
class DatagramSender {
 public:
  DatagramSender();
  ~DatagramSender();
  DatagramSender(const DatagramSender&) = delete;
  DatagramSender& operator=(const DatagramSender&) = delete;

  void send(std::uint16_t port, std::span<const std::uint8_t> bytes);
  /// Sends to the multicast group in which participants of a DDS domain find each other.
  void announce(int domain, std::span<const std::uint8_t> bytes);

 private:
  int socket_;
};

}  // namespace sidestep
