// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/league/endpoint.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Decides whose packets of a multicast group are used, so that two simulators in one group are never mixed.
/// Without a list of senders, the first one that is heard is used until it is silent, and the next one then:
/// a restarted sender has another port.
class SenderChoice {
 public:
  /// The used sender may be replaced after this much silence.
  static constexpr Duration kMaxSilence{500'000'000};

  /// `allowed` are the only senders to use, all of them; port 0 stands for any port. Empty: one, chosen as
  /// described above.
  explicit SenderChoice(std::vector<league::Endpoint> allowed = {}) : allowed_(std::move(allowed)) {}

  /// Whether a packet that arrives now is to be used.
  [[nodiscard]] bool admit(const league::Endpoint& sender, Time now);

  /// The sender of the latest packet that is used.
  const std::optional<league::Endpoint>& used() const { return used_; }
  /// The sender of the latest packet that is not used.
  const std::optional<league::Endpoint>& refused() const { return refused_; }
  std::uint64_t refused_packets() const { return refused_packets_; }

 private:
  bool is_allowed(const league::Endpoint& sender) const;

  std::vector<league::Endpoint> allowed_;
  std::optional<league::Endpoint> used_, refused_;
  Time used_at_{};
  std::uint64_t refused_packets_ = 0;
};

/// Parses ADDRESS or ADDRESS:PORT; without a port, the port is 0. Throws std::invalid_argument that says what
/// was expected.
[[nodiscard]] league::Endpoint parse_sender(const std::string& text);

}  // namespace sidestep
