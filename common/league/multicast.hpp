// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/league/refusal.hpp"

namespace sidestep::league {

/// An IPv4 address and a port, both as numbers: 127.0.0.1 is 0x7f000001.
struct Endpoint {
  std::uint32_t address = 0;
  std::uint16_t port = 0;
  auto operator<=>(const Endpoint&) const = default;
};

/// "224.5.23.2:10006".
std::string to_text(const Endpoint& endpoint);

/// What a user gives as ADDRESS:PORT. Throws std::invalid_argument, saying what was expected, when that is no
/// multicast address (224.0.0.0 to 239.255.255.255) or no port (1 to 65535).
Endpoint multicast_endpoint(const std::string& text);

/// Where the league's packets go unless told otherwise.
inline constexpr const char* kVisionEndpoint = "224.5.23.2:10006";
inline constexpr const char* kTrackedEndpoint = "224.5.23.2:10010";
inline constexpr const char* kRefereeEndpoint = "224.5.23.1:10003";
/// The loopback interface, so that nothing leaves a machine unasked.
inline constexpr const char* kLeagueInterface = "127.0.0.1";

/// A socket of one's own.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor();
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

/// Sends datagrams to a group over one interface, given by its address; never waits. They stay in the local
/// network (a TTL of 1). Throws std::invalid_argument for an interface that this machine does not have and
/// std::runtime_error when the system refuses a socket.
class MulticastSender {
 public:
  MulticastSender(const Endpoint& group, const std::string& interface);

  /// False when the system did not take it, whose reason errno then says.
  bool send(std::span<const std::byte> datagram);
  std::uint64_t sent() const { return sent_; }
  std::uint64_t failed() const { return failed_; }

 private:
  Endpoint group_;
  Descriptor socket_;
  std::uint64_t sent_ = 0;
  std::uint64_t failed_ = 0;
};

/// Receives what is sent to a group over one interface, beside other receivers on this machine, and nothing
/// else. Throws as MulticastSender does.
class MulticastReceiver {
 public:
  /// Gets a datagram and where it came from.
  using Take = std::function<void(std::span<const std::byte>, const Endpoint&)>;

  MulticastReceiver(const Endpoint& group, const std::string& interface);

  /// Becomes readable when something has come.
  int descriptor() const { return socket_.number(); }
  /// Hands over what has come, up to a bound so that others get their turn.
  void receive(const Take& take);

 private:
  Endpoint group_;
  Descriptor socket_;
  std::vector<std::byte> buffer_;
};

}  // namespace sidestep::league
