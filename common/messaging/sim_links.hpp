// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/random/rng.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// A simulated process over all its lives, as SimNetwork::process numbers them.
using ProcessId = std::uint32_t;

/// What a link does to the messages that one process sends to another.
struct LinkQuality {
  double loss = 0;              ///< share of the messages
  double mean_burst = 1;        ///< losses come in bursts of so many messages on average (Gilbert 1960)
  double duplicate = 0;         ///< probability
  Duration delay_min{200'000};  ///< delays are exponential above the least, and cut off at the most
  Duration delay_mean{400'000};
  Duration delay_max{600'000};
  bool is_cut = false;  ///< nothing arrives

  bool operator==(const LinkQuality&) const = default;
};

/// When the copies of one message arrive, after it was sent.
struct Copies {
  std::array<Duration, 2> delays{};
  std::size_t count = 0;
};

/// The directed links between processes, each with a quality and a memory of the burst it is in.
class SimLinks {
 public:
  /// Whether any link has a quality of its own.
  bool any() const { return width_ > 0; }
  void set(ProcessId from, ProcessId to, const LinkQuality& quality);
  /// Links that were never set have no quality of their own: nullptr.
  const LinkQuality* find(ProcessId from, ProcessId to) const;
  /// What becomes of a message. Precondition: find(from, to).
  Copies send(ProcessId from, ProcessId to, Rng& rng);
  /// The delay of a message that is sent again until it arrives. Precondition: find(from, to).
  Duration delay(ProcessId from, ProcessId to, Rng& rng) const;

 private:
  struct Link {
    LinkQuality quality;
    bool is_set = false;
    bool is_losing = false;  // within a burst
  };
  bool is_lost(Link& link, Rng& rng) const;
  const Link& at(ProcessId from, ProcessId to) const { return links_[from * width_ + to]; }

  std::size_t width_ = 0;
  std::vector<Link> links_;  // by sender, then receiver
};

}  // namespace sidestep
