// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "common/random/rng.hpp"
#include "common/time/time.hpp"

namespace sidestep {

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

/// One sender's messages to one receiver, with a memory of the burst of losses that they are in.
class ImpairedLink {
 public:
  /// What becomes of a message.
  Copies send(const LinkQuality& quality, Rng& rng);

 private:
  bool is_lost(const LinkQuality& quality, Rng& rng);

  bool is_losing_ = false;  // within a burst
};

/// The delay of one message.
Duration sample_delay(const LinkQuality& quality, Rng& rng);

}  // namespace sidestep
