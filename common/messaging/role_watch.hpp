// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "common/messaging/bus.hpp"
#include "common/motion/version.hpp"

namespace sidestep {

/// Notices other processes with this one's process id, which must be alone: a second simulator, vision,
/// coordinator of one number, or referee. Any of them that started earlier has priority.
class RoleWatch {
 public:
  /// `on_other` is called once for each other process, with its incarnation. Does nothing for processes of
  /// which there may be several.
  RoleWatch(Bus& bus, std::uint32_t process, Incarnation incarnation,
            std::function<void(Incarnation other)> on_other);
  RoleWatch(const RoleWatch&) = delete;
  RoleWatch& operator=(const RoleWatch&) = delete;

  /// Others are believed after this time. Messages of an earlier run of this process may arrive late.
  static constexpr Duration kConfirmation{500'000'000};

 private:
  void on_counters(const msg::Counters& message);

  Bus& bus_;
  std::uint32_t process_;
  Incarnation incarnation_;
  std::function<void(Incarnation)> on_other_;
  struct Other {
    Time first_heard{};
    std::uint64_t first_number = 0;
    bool is_confirmed = false;
  };
  std::map<Incarnation, Other> others_;
};

/// Whether a process with this id ends if one that started earlier is heard. Coordinators of one number agree
/// by themselves which of them works.
[[nodiscard]] bool must_be_alone(std::uint32_t process);

/// Why a process ends, or what it has found: that another one with its id works.
std::string describe_other(std::uint32_t process, Incarnation own, Incarnation other);

/// That two processes write a channel that is for one, for Bus::watch_contests().
std::string describe_contest(const TopicInfo& topic, std::uint32_t robot, const msg::Header& header);

}  // namespace sidestep
