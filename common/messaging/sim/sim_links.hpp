// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/messaging/impaired_link.hpp"

namespace sidestep {

/// A simulated process over all its lives, as SimNetwork::process numbers them.
using ProcessId = std::uint32_t;

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
    ImpairedLink burst;
  };
  const Link& at(ProcessId from, ProcessId to) const { return links_[from * width_ + to]; }

  std::size_t width_ = 0;
  std::vector<Link> links_;  // by sender, then receiver
};

}  // namespace sidestep
