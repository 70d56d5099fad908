// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <span>

#include "deploy/inspect/topic/describe.hpp"
#include "deploy/inspect/topic/describe_parts.hpp"

namespace sidestep {

using namespace description;

namespace {

constexpr const char* kOrderKinds[] = {"go", "cancel", "hold", "resume", "zone", "remove zone"};
constexpr const char* kOrderStates[] = {"accepted", "driving", "blocked", "arrived", "left"};
constexpr const char* kOrderResults[] = {"remembered",    "replaced",      "malformed",
                                         "unknown robot", "outside field", "too many"};
constexpr const char* kBlockReasons[] = {"none", "obstacle", "robot", "zone", "no path", "occluded corner"};

Json terms(const msg::OrderTerms& m) {
  return {{"order_kind", word(m.order_kind(), kOrderKinds)},
          {"order_number", m.order_number()},
          {"zone", m.zone()},
          {"zone_radius_m", m.zone_radius_m()},
          {"zone_speed_limit_mps", m.zone_speed_limit_mps()}};
}

Json pose(const msg::OrderPose& m) {
  return {{"x_m", m.x_m()},
          {"y_m", m.y_m()},
          {"has_heading", m.has_heading()},
          {"heading_rad", m.heading_rad()},
          {"speed_limit_mps", m.speed_limit_mps()},
          {"tolerance_m", m.tolerance_m()}};
}

Json remembered(const msg::RememberedOrder& m) {
  return {{"robot", m.robot()},           {"client", m.client()},
          {"terms", terms(m.terms())},    {"pose_count", m.pose_count()},
          {"pose_index", m.pose_index()}, {"order_state", word(m.order_state(), kOrderStates)}};
}

}  // namespace

Json describe(const msg::Order& m) {
  return {{"robot", m.robot()},
          {"header", header(m.header())},
          {"terms", terms(m.terms())},
          {"poses", list(m.poses(), pose)}};
}

Json describe(const msg::OrderAnswer& m) {
  return {{"client", m.client()},
          {"header", header(m.header())},
          {"order_number", m.order_number()},
          {"result", word(m.result(), kOrderResults)},
          {"newest_number", m.newest_number()}};
}

Json describe(const msg::OrderMemory& m) {
  return {{"process", m.process()},
          {"header", header(m.header())},
          {"is_complete", m.is_complete()},
          {"page_index", m.page_index()},
          {"page_count", m.page_count()},
          {"order_count", m.order_count()},
          {"orders", list(m.orders(), m.order_count(), remembered)},
          {"poses", list(m.poses(), pose)}};
}

Json describe(const msg::OrderStatus& m) {
  return {{"robot", m.robot()},
          {"header", header(m.header())},
          {"client", m.client()},
          {"order_number", m.order_number()},
          {"order_state", word(m.order_state(), kOrderStates)},
          {"pose_index", m.pose_index()},
          {"is_held", m.is_held()},
          {"block_reason", word(m.block_reason(), kBlockReasons)},
          {"blocker", m.blocker()},
          {"blocker_x_m", m.blocker_x_m()},
          {"blocker_y_m", m.blocker_y_m()},
          {"nearest_x_m", m.nearest_x_m()},
          {"nearest_y_m", m.nearest_y_m()},
          {"remaining_s", m.remaining_s()}};
}

}  // namespace sidestep
