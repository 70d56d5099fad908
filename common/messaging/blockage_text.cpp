// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/blockage_text.hpp"

#include <fmt/format.h>

namespace sidestep {
namespace {

std::string place(const Vec2& p) { return fmt::format("{:.2f},{:.2f}", p.x(), p.y()); }

std::string cause(const Blockage& blockage) {
  switch (blockage.reason) {
    case msg::BlockReason::BLOCK_OBSTACLE:
      return "an obstacle at " + place(blockage.blocker_m) + " covers its goal";
    case msg::BlockReason::BLOCK_ROBOT:
      return fmt::format("robot {} stands on its goal", blockage.blocker);
    case msg::BlockReason::BLOCK_ZONE:
      return fmt::format("zone {} covers its goal", blockage.blocker);
    case msg::BlockReason::BLOCK_OCCLUDED_CORNER:
      return "a person may step out from behind the corner at " + place(blockage.blocker_m);
    case msg::BlockReason::BLOCK_STRANGER:
      return fmt::format("a stranger {:.2f} m away, who may move at {:.1f} m/s",
                         (blockage.blocker_m - blockage.nearest_m).norm(), blockage.blocker_speed_mps);
    case msg::BlockReason::BLOCK_PASSING_ROBOT:
      return fmt::format("robot {} has to pass first", blockage.blocker);
    case msg::BlockReason::BLOCK_NONE:
    case msg::BlockReason::BLOCK_NO_PATH:
      break;
  }
  return "no path leads to its goal";
}

}  // namespace

std::string to_text(const Blockage& blockage) {
  if (blockage.reason == msg::BlockReason::BLOCK_STRANGER) return cause(blockage);
  return cause(blockage) + "; it goes to " + place(blockage.nearest_m) + " instead";
}

}  // namespace sidestep
