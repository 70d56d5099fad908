// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "common/messaging/bus.hpp"
#include "common/motion/version.hpp"

namespace sidestep {

/// Detects other processes with this process's id if only one may run: a second simulator, vision, referee,
/// or coordinator with the same number. The process that started first has priority.
class RoleWatch {
 public:
  /// `on_other` is called once for each other process, with its incarnation. Has no effect for kinds of
  /// processes that may run several times.
  RoleWatch(Bus& bus, std::uint32_t process, Incarnation incarnation,
            std::function<void(Incarnation other)> on_other);
  RoleWatch(const RoleWatch&) = delete;
  RoleWatch& operator=(const RoleWatch&) = delete;

  /// Another process is reported only after this time, because messages from an earlier run of this process
  /// may arrive late.
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

/// Whether a process with this id exits when it hears another process with the same id that started earlier.
/// Coordinators with the same number instead agree which of them is active.
[[nodiscard]] bool must_be_alone(std::uint32_t process);

/// The message with which a process reports that another process with its id is running. It also explains an
/// exit.
std::string describe_other(std::uint32_t process, Incarnation own, Incarnation other);

/// The message for Bus::watch_conflicts(): two processes write a single-writer channel.
std::string describe_conflict(const TopicInfo& topic, std::uint32_t robot, const msg::Header& header);

}  // namespace sidestep
