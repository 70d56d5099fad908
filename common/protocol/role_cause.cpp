// SPDX-License-Identifier: Apache-2.0
#include "common/protocol/role_cause.hpp"

#include <fmt/format.h>

namespace sidestep {

std::string describe(const RoleCause& cause) {
  const double silence_ms = to_seconds(cause.silence) * 1e3;
  switch (cause.reason) {
    case msg::RoleReason::ROLE_STARTED:
      return "started";
    case msg::RoleReason::ROLE_NO_COORDINATOR:
      return fmt::format("no coordinator was active for {:.0f} ms after the start", silence_ms);
    case msg::RoleReason::ROLE_HEARTBEATS_LOST:
      return fmt::format("no heartbeat of coordinator {} for {:.0f} ms", cause.peer, silence_ms);
    case msg::RoleReason::ROLE_RETURNED:
      return fmt::format("no heartbeat of a higher epoch for {:.0f} ms after yielding to it", silence_ms);
    case msg::RoleReason::ROLE_EPOCH_OF_COORDINATOR:
      return fmt::format("coordinator {} has the higher epoch {}", cause.peer, cause.learned);
    case msg::RoleReason::ROLE_EPOCH_OF_AGENT:
      if (cause.learned == 0)
        return fmt::format("the agent of robot {} asks for another coordinator", cause.peer);
      return fmt::format("the agent of robot {} knows the higher epoch {}", cause.peer, cause.learned);
    case msg::RoleReason::ROLE_EPOCH_OF_ROBOT:
      return fmt::format("robot {} obeys the higher epoch {}", cause.peer, cause.learned);
    case msg::RoleReason::ROLE_SHARED_EPOCH:
      return fmt::format("another process with number {} started the same epoch", cause.peer);
  }
  return "unknown";
}

}  // namespace sidestep
