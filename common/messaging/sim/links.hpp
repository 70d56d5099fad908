// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/messaging/impaired_link.hpp"
#include "common/messaging/sim/reachability.hpp"

namespace sidestep {

/// Number of a simulated process, from SimNetwork::new_process(); a restarted process keeps it.
using ProcessId = std::uint32_t;

/// The directed links between processes: their qualities and loss bursts.
class SimLinks {
 public:
  /// Whether set() was ever called.
  bool any() const { return width_ > 0; }
  void set(ProcessId from, ProcessId to, const LinkQuality& quality, Time now);
  /// Returns null for a link that was never set.
  const LinkQuality* find(ProcessId from, ProcessId to) const;
  /// Precondition: find(from, to).
  MessageCopies send(ProcessId from, ProcessId to, Rng& rng);
  /// Draws the delay of a reliable message. Precondition: find(from, to).
  Duration delay(ProcessId from, ProcessId to, Rng& rng) const;
  /// The reachability in both directions.
  Reachability reachability(ProcessId a, ProcessId b) const;

 private:
  struct Link {
    LinkQuality quality;
    bool is_set = false;
    ImpairedLink impaired;
    Reachability reachability;
  };
  const Link& at(ProcessId from, ProcessId to) const { return links_[from * width_ + to]; }

  std::size_t width_ = 0;
  std::vector<Link> links_;  // width_ x width_ links, indexed by sender, then receiver
};

}  // namespace sidestep
