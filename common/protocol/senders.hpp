// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "common/motion/version.hpp"
#include "common/protocol/roles.hpp"

namespace sidestep {

/// Values of Header.sender. A robot and its agents use the robot's number. Other processes use the values
/// below, plus their own number if there are several of the kind.
enum class Sender : std::uint32_t {
  kCoordinator = 10000,
  kVision = 20000,
  kSimulator = 30000,
  kRobots = 35000,  ///< a process that drives third-party robots
  kOperator = 40000,
  kReferee = 50000,
  kScenario = 60000,  ///< orders from the scenario file
  kClient = 1000000,  ///< lowest id of clients other than those above
};

/// Coordinators are numbered 0 .. kMaxCoordinators - 1.
inline constexpr std::uint32_t kMaxCoordinators = 8;

constexpr bool is_coordinator(std::uint32_t sender) {
  const auto first = static_cast<std::uint32_t>(Sender::kCoordinator);
  return sender >= first && sender < first + kMaxCoordinators;
}

/// The roles of processes that may use this Header.sender. A robot's feedback carries its agent's number, and
/// an operator may use a client's id.
constexpr Roles roles_of(std::uint32_t sender) {
  if (sender < kMaxRobots) return Role::kAgent | Role::kSimulator | Role::kRobot;
  if (is_coordinator(sender)) return Role::kCoordinator;
  if (sender >= static_cast<std::uint32_t>(Sender::kClient)) return Role::kClient | Role::kOperator;
  switch (static_cast<Sender>(sender)) {
    case Sender::kVision:
      return Role::kVision;
    case Sender::kSimulator:
      return Role::kSimulator;
    case Sender::kRobots:
      return Role::kRobot;
    case Sender::kOperator:
      return Role::kOperator;
    case Sender::kReferee:
      return Role::kReferee;
    default:
      return {};
  }
}

/// The id of the client with this name. Collisions between different names are unlikely.
constexpr std::uint32_t client_id(std::string_view name) {
  std::uint32_t hash = 2166136261;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<std::uint8_t>(c)) * 16777619;
  const auto first = static_cast<std::uint32_t>(Sender::kClient);
  return first + hash % (4294967295 - first);
}

/// NetworkFault.target value that addresses every process.
inline constexpr std::uint32_t kEveryProcess = 4294967295;

}  // namespace sidestep
