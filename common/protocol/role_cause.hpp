// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/motion/version.hpp"
#include "common/time/time.hpp"
#include "idl/negotiation.hpp"

namespace sidestep {

/// Why a coordinator is active in its epoch or is a standby; see RoleReason in idl/negotiation.idl.
struct RoleCause {
  msg::RoleReason reason = msg::RoleReason::ROLE_STARTED;
  std::uint32_t peer = 0;  ///< number of the coordinator or robot that the reason refers to
  Duration silence{0};     ///< time without heartbeats
  Epoch learned = 0;       ///< the higher epoch that the coordinator has learned of
};

/// Describes the cause, for example "no heartbeat of coordinator 1 for 151 ms".
std::string describe(const RoleCause& cause);

}  // namespace sidestep
