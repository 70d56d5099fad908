// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include "common/motion/version.hpp"
#include "common/time/time.hpp"
#include "idl/header.hpp"

namespace sidestep {

/// Decides whether the time stamps of a process's messages show their order. The stamps do not show it if the
/// process's clock was set back: a later message then has an earlier stamp, and between different topics,
/// message numbers show no order either.
class ComparableStamps {
 public:
  /// Records a stamp. `channel` distinguishes the streams that one sender numbers separately.
  void record(std::uint64_t channel, const msg::Header& header);
  /// Whether the messages of this run of a process have been stamped in the order of their numbers so far.
  /// False if no message of the run was recorded recently.
  [[nodiscard]] bool are_in_order(std::uint32_t sender, Incarnation incarnation) const;

 private:
  static constexpr std::size_t kMaxRuns = 4096, kMaxChannels = 2048;

  struct Newest {
    std::uint64_t number = 0;
    std::int64_t stamp_ns = 0;
  };
  struct Run {
    std::map<std::uint64_t, Newest> newest;  // indexed by channel
    bool was_set_back = false;
    std::uint64_t used = 0;
  };
  std::map<std::pair<std::uint32_t, Incarnation>, Run> runs_;
  std::uint64_t uses_ = 0;
};

}  // namespace sidestep
