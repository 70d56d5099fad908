// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "common/random/rng.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Quality of the link from one process to another.
struct LinkQuality {
  double loss = 0;              ///< fraction of messages that are lost
  double mean_burst = 1;        ///< mean number of consecutive messages lost (Gilbert 1960)
  double duplicate = 0;         ///< probability of a duplicate
  Duration delay_min{200'000};  ///< delays are exponential above the minimum, truncated at the maximum
  Duration delay_mean{400'000};
  Duration delay_max{600'000};
  bool is_cut = false;  ///< no message arrives

  bool operator==(const LinkQuality&) const = default;
};

/// Delays after which the copies of one message arrive: no entry if it is lost, two if it is duplicated.
struct MessageCopies {
  std::array<Duration, 2> delays{};
  std::size_t count = 0;
};

/// Impairs the messages from one sender to one receiver. Remembers whether it is in a burst of losses.
class ImpairedLink {
 public:
  MessageCopies send(const LinkQuality& quality, Rng& rng);

 private:
  /// Decides at random whether the next message is lost.
  bool draw_loss(const LinkQuality& quality, Rng& rng);

  bool is_losing_ = false;  // currently in a burst of losses
};

/// Draws the delay of one message.
Duration sample_delay(const LinkQuality& quality, Rng& rng);

}  // namespace sidestep
