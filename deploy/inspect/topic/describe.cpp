// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/describe.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string>

#include "common/messaging/histogram_codec.hpp"
#include "common/protocol/disturbance_text.hpp"
#include "common/protocol/drop_reasons.hpp"
#include "common/protocol/reason_text.hpp"
#include "deploy/inspect/topic/describe_parts.hpp"

namespace sidestep {

using namespace description;

namespace {

constexpr const char* kCoordinatorModes[] = {"standby", "registering", "granting"};
constexpr const char* kRoleReasons[] = {"started",        "no coordinator",       "heartbeats lost",
                                        "returned",       "epoch of coordinator", "epoch of agent",
                                        "epoch of robot", "shared epoch"};
constexpr const char* kAgentStates[] = {"fencing", "registering", "waiting",
                                        "driving", "arrived",     "clock out of bound",
                                        "absent",  "held",        "without order"};
constexpr const char* kImageFormats[] = {"yuv422", "rgb"};

Json notice(const msg::RobotNotice& m) {
  return {{"robot", m.robot()},
          {"is_missing", m.is_missing()},
          {"is_quarantined", m.is_quarantined()},
          {"is_displaced", m.is_displaced()},
          {"is_silent", m.is_silent()},
          {"observed_at_ns", m.observed_at_ns()},
          {"x_m", m.x_m()},
          {"y_m", m.y_m()},
          {"vx_mps", m.vx_mps()},
          {"vy_mps", m.vy_mps()},
          {"position_variance_m2", m.position_variance_m2()}};
}

Json phase(const msg::MotionPhase& m) {
  return {{"duration_ns", m.duration_ns()}, {"ax_mps2", m.ax_mps2()}, {"ay_mps2", m.ay_mps2()}};
}

Json intent(const msg::Intent& m) {
  return {{"vx_mps", m.vx_mps()},
          {"vy_mps", m.vy_mps()},
          {"velocity_duration_s", m.velocity_duration_s()},
          {"via_x_m", m.via_x_m()},
          {"via_y_m", m.via_y_m()},
          {"goal_x_m", m.goal_x_m()},
          {"goal_y_m", m.goal_y_m()},
          {"target_x_m", m.target_x_m()},
          {"target_y_m", m.target_y_m()}};
}

Json version(const msg::Version& m) {
  return {{"robot", m.robot()},
          {"incarnation", m.incarnation()},
          {"version_number", m.version_number()},
          {"base", m.base()},
          {"start_ns", m.start_ns()},
          {"x_m", m.x_m()},
          {"y_m", m.y_m()},
          {"vx_mps", m.vx_mps()},
          {"vy_mps", m.vy_mps()},
          {"inflation_m", m.inflation_m()},
          {"has_intent", m.has_intent()},
          {"intent", intent(m.intent())},
          {"phase_count", m.phase_count()},
          {"phases", list(m.phases(), m.phase_count(), phase)}};
}

Json quantiles(const msg::DurationCounts& m) {
  const DurationHistogram histogram = decode(m);
  const auto us = [](Duration d) { return static_cast<double>(d.count()) * 1e-3; };
  return {{"count", histogram.count()},
          {"p50_us", us(histogram.quantile(0.5))},
          {"p99_us", us(histogram.quantile(0.99))},
          {"max_us", us(histogram.max())}};
}

}  // namespace

Json describe(const msg::CameraImage& m) {
  return {{"camera", m.camera()},
          {"header", header(m.header())},
          {"captured_at_ns", m.captured_at_ns()},
          {"image_format", word(m.image_format(), kImageFormats)},
          {"width_px", m.width_px()},
          {"height_px", m.height_px()},
          {"pixels", fmt::format("{} bytes", m.pixels().size())}};
}

Json describe(const msg::DetectionFrame& m) {
  const auto ball = [](const msg::BallDetection& b) -> Json {
    return {{"x_m", b.x_m()}, {"y_m", b.y_m()}, {"confidence", b.confidence()}};
  };
  const auto robot = [](const msg::RobotDetection& r) -> Json {
    return {{"robot", r.robot()},
            {"x_m", r.x_m()},
            {"y_m", r.y_m()},
            {"heading_rad", r.heading_rad()},
            {"confidence", r.confidence()}};
  };
  const auto obstacle = [](const msg::ObstacleDetection& o) -> Json {
    return {{"x_m", o.x_m()}, {"y_m", o.y_m()}, {"radius_m", o.radius_m()}};
  };
  return {{"camera", m.camera()},
          {"header", header(m.header())},
          {"captured_at_ns", m.captured_at_ns()},
          {"ball_count", m.ball_count()},
          {"balls", list(m.balls(), m.ball_count(), ball)},
          {"obstacles_complete_within_m", m.obstacles_complete_within_m()},
          {"obstacle_count", m.obstacle_count()},
          {"obstacles", list(m.obstacles(), m.obstacle_count(), obstacle)},
          {"robots", list(m.robots(), robot)}};
}

Json describe(const msg::WorldState& m) {
  const auto robot = [](const msg::TrackedRobot& r) -> Json {
    return {{"robot", r.robot()},
            {"x_m", r.x_m()},
            {"y_m", r.y_m()},
            {"heading_rad", r.heading_rad()},
            {"vx_mps", r.vx_mps()},
            {"vy_mps", r.vy_mps()},
            {"angular_radps", r.angular_radps()},
            {"position_variance_m2", r.position_variance_m2()},
            {"velocity_variance_m2ps2", r.velocity_variance_m2ps2()},
            {"observed_at_ns", r.observed_at_ns()},
            {"observed_x_m", r.observed_x_m()},
            {"observed_y_m", r.observed_y_m()},
            {"observed_heading_rad", r.observed_heading_rad()}};
  };
  const msg::TrackedBall& b = m.ball();
  const Json ball = {{"is_visible", b.is_visible()},
                     {"x_m", b.x_m()},
                     {"y_m", b.y_m()},
                     {"vx_mps", b.vx_mps()},
                     {"vy_mps", b.vy_mps()}};
  return {{"vision", m.vision()},
          {"header", header(m.header())},
          {"valid_at_ns", m.valid_at_ns()},
          {"frames", m.frames()},
          {"ball", ball},
          {"robots", list(m.robots(), robot)}};
}

Json describe(const msg::ObstacleList& m) {
  const auto obstacle = [](const msg::TrackedObstacle& o) -> Json {
    return {{"obstacle", o.obstacle()}, {"observed_at_ns", o.observed_at_ns()},
            {"x_m", o.x_m()},           {"y_m", o.y_m()},
            {"vx_mps", o.vx_mps()},     {"vy_mps", o.vy_mps()},
            {"radius_m", o.radius_m()}, {"position_variance_m2", o.position_variance_m2()}};
  };
  return {{"vision", m.vision()},
          {"header", header(m.header())},
          {"valid_at_ns", m.valid_at_ns()},
          {"complete_within_m", m.complete_within_m()},
          {"obstacles", list(m.obstacles(), obstacle)}};
}

Json describe(const msg::Command& m) {
  const msg::PoseFix& f = m.fix();
  const Json fix = {{"captured_at_ns", f.captured_at_ns()},
                    {"x_m", f.x_m()},
                    {"y_m", f.y_m()},
                    {"heading_rad", f.heading_rad()}};
  return {{"robot", m.robot()},
          {"header", header(m.header())},
          {"epoch", m.epoch()},
          {"has_version", m.has_version()},
          {"version", version(m.version())},
          {"has_fix", m.has_fix()},
          {"fix", fix},
          {"desired_heading_rad", m.desired_heading_rad()}};
}

Json describe(const msg::Feedback& m) {
  return {{"robot", m.robot()},
          {"header", header(m.header())},
          {"obeyed_incarnation", m.obeyed_incarnation()},
          {"obeyed_epoch", m.obeyed_epoch()},
          {"valid_at_ns", m.valid_at_ns()},
          {"executing", version(m.executing())},
          {"is_off_reference", m.is_off_reference()},
          {"is_lifted", m.is_lifted()},
          {"command_stamp_ns", m.command_stamp_ns()},
          {"command_received_at_ns", m.command_received_at_ns()},
          {"x_m", m.x_m()},
          {"y_m", m.y_m()},
          {"vx_mps", m.vx_mps()},
          {"vy_mps", m.vy_mps()},
          {"heading_rad", m.heading_rad()},
          {"tracking_error_m", m.tracking_error_m()},
          {"position_error_rms_m", m.position_error_rms_m()},
          {"odometry_scale_stddev", m.odometry_scale_stddev()},
          {"has_moved", m.has_moved()},
          {"activated", m.activated()},
          {"lead_ns", m.lead_ns()}};
}

Json describe(const msg::LaserScan& m) {
  // JSON has no numbers for beams without a hit.
  const auto range = [](float r) -> Json {
    if (std::isfinite(r)) return r;
    return std::isnan(r) ? "lost" : r > 0 ? "no hit" : "too near";
  };
  return {{"robot", m.robot()},
          {"header", header(m.header())},
          {"captured_at_ns", m.captured_at_ns()},
          {"x_m", m.x_m()},
          {"y_m", m.y_m()},
          {"heading_rad", m.heading_rad()},
          {"field_of_view_rad", m.field_of_view_rad()},
          {"min_range_m", m.min_range_m()},
          {"max_range_m", m.max_range_m()},
          {"ranges_m", list(m.ranges_m(), range)}};
}

Json describe(const msg::Registration& m) {
  return {{"robot", m.robot()},
          {"header", header(m.header())},
          {"epoch", m.epoch()},
          {"is_absent", m.is_absent()},
          {"has_moved", m.has_moved()},
          {"knows_orders", m.knows_orders()},
          {"version_count", m.version_count()},
          {"versions", list(m.versions(), m.version_count(), version)}};
}

Json describe(const msg::Proposal& m) {
  return {{"robot", m.robot()},
          {"header", header(m.header())},
          {"epoch", m.epoch()},
          {"candidate_count", m.candidate_count()},
          {"candidates", list(m.candidates(), m.candidate_count(), version)}};
}

Json describe(const msg::Verdict& m) {
  const auto reason = [](msg::Reason r) { return word(r, kReasonTexts); };
  const auto robot = [](std::uint32_t id) { return Json(id); };
  return {{"robot", m.robot()},
          {"header", header(m.header())},
          {"epoch", m.epoch()},
          {"proposal_number", m.proposal_number()},
          {"request_stamp_ns", m.request_stamp_ns()},
          {"granted_version", m.granted_version()},
          {"reasons", list(m.reasons(), reason)},
          {"blockers", list(m.blockers(), robot)}};
}

Json describe(const msg::LedgerPage& m) {
  return {{"page_index", m.page_index()},
          {"header", header(m.header())},
          {"epoch", m.epoch()},
          {"page_count", m.page_count()},
          {"min_x_m", m.min_x_m()},
          {"min_y_m", m.min_y_m()},
          {"max_x_m", m.max_x_m()},
          {"max_y_m", m.max_y_m()},
          {"versions", list(m.versions(), version)}};
}

Json describe(const msg::CoordinatorState& m) {
  return {{"coordinator", m.coordinator()},
          {"header", header(m.header())},
          {"epoch", m.epoch()},
          {"coordinator_mode", word(m.coordinator_mode(), kCoordinatorModes)},
          {"role_reason", word(m.role_reason(), kRoleReasons)},
          {"role_peer", m.role_peer()},
          {"role_silence_ns", m.role_silence_ns()},
          {"role_learned_epoch", m.role_learned_epoch()},
          {"proposals", m.proposals()},
          {"grants", m.grants()},
          {"denials", m.denials()},
          {"conflicts", m.conflicts()},
          {"conflict_first", m.conflict_first()},
          {"conflict_second", m.conflict_second()},
          {"absent", m.absent()},
          {"remembers_orders", m.remembers_orders()},
          {"watched_until_ns", m.watched_until_ns()},
          {"notices", list(m.notices(), notice)}};
}

Json describe(const msg::AbsenceAttestation& m) {
  return {{"robot", m.robot()}, {"header", header(m.header())}};
}

Json describe(const msg::AgentStatus& m) {
  return {{"robot", m.robot()},
          {"header", header(m.header())},
          {"agent_state", word(m.agent_state(), kAgentStates)},
          {"goal_index", m.goal_index()},
          {"distance_to_go_m", m.distance_to_go_m()},
          {"speed_mps", m.speed_mps()},
          {"cycles", m.cycles()},
          {"missed_cycles", m.missed_cycles()},
          {"lost_versions", m.lost_versions()},
          {"proposals", m.proposals()},
          {"grants", m.grants()},
          {"denials", m.denials()},
          {"clock_offset_s", m.clock_offset_s()},
          {"clock_uncertainty_s", m.clock_uncertainty_s()},
          {"clock_speed_limit_mps", m.clock_speed_limit_mps()},
          {"reference_losses", m.reference_losses()},
          {"route_changes", m.route_changes()},
          {"negotiation", quantiles(m.negotiation())},
          {"plan", quantiles(m.plan())},
          {"search", quantiles(m.search())}};
}

Json describe(const msg::Counters& m) {
  const auto counter = [](const msg::Counter& c) -> Json {
    const bool is_known = c.reason() < kDropReasonCount;
    return {{"reason",
             is_known ? Json(kDropReasons[c.reason()].name) : Json("unknown " + std::to_string(c.reason()))},
            {"robot", c.robot()},
            {"times", c.times()}};
  };
  return {{"process", m.process()}, {"header", header(m.header())}, {"counts", list(m.counts(), counter)}};
}

Json describe(const msg::GroundTruth& m) {
  const auto robot = [](const msg::TrueRobotState& r) -> Json {
    return {{"robot", r.robot()},
            {"x_m", r.x_m()},
            {"y_m", r.y_m()},
            {"heading_rad", r.heading_rad()},
            {"vx_mps", r.vx_mps()},
            {"vy_mps", r.vy_mps()},
            {"reference_error_m", r.reference_error_m()},
            {"disturbance_end_ns", r.disturbance_end_ns()}};
  };
  const auto contact = [](const msg::ContactPair& c) -> Json {
    return {{"first", c.first()}, {"second", c.second()}};
  };
  return {{"simulator", m.simulator()},
          {"header", header(m.header())},
          {"valid_at_ns", m.valid_at_ns()},
          {"contacts", m.contacts()},
          {"recent_contacts", list(m.recent_contacts(), contact)},
          {"penetration_m_s", m.penetration_m_s()},
          {"min_clearance_m", m.min_clearance_m()},
          {"firmware_violations", m.firmware_violations()},
          {"crashes", m.crashes()},
          {"crashes_while_moving", m.crashes_while_moving()},
          {"recent_moving_crashes", m.recent_moving_crashes()},
          {"max_crash_speed_mps", m.max_crash_speed_mps()},
          {"max_robot_crash_speed_mps", m.max_robot_crash_speed_mps()},
          {"ball_x_m", m.ball_x_m()},
          {"ball_y_m", m.ball_y_m()},
          {"robots", list(m.robots(), robot)}};
}

Json describe(const msg::Disturbance& m) {
  return {{"robot", m.robot()},
          {"header", header(m.header())},
          {"disturbance_kind", word(m.disturbance_kind(), kDisturbanceTexts)},
          {"other_robot", m.other_robot()},
          {"vx_mps", m.vx_mps()},
          {"vy_mps", m.vy_mps()},
          {"grip", m.grip()},
          {"x_m", m.x_m()},
          {"y_m", m.y_m()},
          {"heading_rad", m.heading_rad()},
          {"clock_offset_ns", m.clock_offset_ns()},
          {"duration_ns", m.duration_ns()}};
}

Json describe(const msg::NetworkFault& m) {
  return {{"target", m.target()},
          {"header", header(m.header())},
          {"seed", m.seed()},
          {"loss", m.loss()},
          {"mean_burst", m.mean_burst()},
          {"duplicate", m.duplicate()},
          {"delay_min_ns", m.delay_min_ns()},
          {"delay_mean_ns", m.delay_mean_ns()},
          {"delay_max_ns", m.delay_max_ns()},
          {"is_cut", m.is_cut()}};
}

Json describe(const msg::SharedRules& m) {
  return {{"process", m.process()},
          {"header", header(m.header())},
          {"text", std::string(m.text().begin(), m.text().end())}};
}

}  // namespace sidestep
