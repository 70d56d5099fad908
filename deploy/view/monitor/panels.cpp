// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/panels.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/messaging/enumerator.hpp"
#include "common/messaging/histogram_codec.hpp"
#include "common/protocol/client_text.hpp"
#include "common/protocol/process_names.hpp"
#include "common/protocol/reason_text.hpp"
#include "deploy/view/monitor/unix_time.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

double ms(Duration duration) { return to_seconds(duration) * 1e3; }

Json pair_json(const std::optional<ClosestPair>& pair) {
  if (!pair) return nullptr;
  return {{"clearance_m", pair->clearance_m},
          {"robots", {pair->first, pair->second}},
          {"at_s", unix_seconds(pair->at)}};
}

const char* state_text(msg::AgentState state) {
  constexpr std::array kTexts{"fencing", "registering", "waiting",
                              "driving", "arrived",     "clock out of bound",
                              "absent",  "held",        "without order"};
  return is_enumerator(state, msg::AgentState::AGENT_WITHOUT_ORDER) ? kTexts[static_cast<std::size_t>(state)]
                                                                    : "unknown";
}

const char* order_text(const msg::OrderStatus& order) {
  constexpr std::array kTexts{"accepted", "driving", "blocked", "arrived", "left"};
  if (order.is_held()) return "held";
  if (order.order_number() == 0) return "none";
  if (order.block_reason() != msg::BlockReason::BLOCK_NONE) return "blocked";
  return is_enumerator(order.order_state(), msg::OrderState::ORDER_LEFT)
             ? kTexts[static_cast<std::size_t>(order.order_state())]
             : "unknown";
}

Json goals_json(const OrderBook& orders, RobotId robot) {
  for (std::size_t rank = kRanks; rank-- > 0;) {
    const RememberedOrder* order = orders.drive_order(robot, static_cast<Rank>(rank));
    if (!order || order->order.kind != msg::OrderKind::ORDER_GO || order->progress.is_finished()) continue;
    Json goals = Json::array();
    for (std::size_t i = order->progress.goal_index; i < order->order.goals.size(); ++i)
      goals.push_back({order->order.goals[i].position_m.x(), order->order.goals[i].position_m.y()});
    return goals;
  }
  return Json::array();
}

Json robot_json(RobotId id, const RobotView& robot, const OrderBook& orders, Time now) {
  Json row{{"id", id}};
  if (robot.status) {
    const msg::AgentStatus& status = robot.status->value;
    const DurationHistogram negotiation = decode(status.negotiation());
    row["state"] = state_text(status.agent_state());
    row["age_s"] = to_seconds(now - robot.status->at);
    row["speed_mps"] = status.speed_mps();
    row["distance_to_go_m"] = status.distance_to_go_m();
    row["negotiation_p50_ms"] = ms(negotiation.quantile(0.5));
    row["negotiation_p99_ms"] = ms(negotiation.quantile(0.99));
    row["cycles"] = status.cycles();
    row["missed_cycles"] = status.missed_cycles();
    row["proposals"] = status.proposals();
    row["grants"] = status.grants();
    row["denials"] = status.denials();
    if (status.clock_uncertainty_s() >= 0) {
      row["clock_offset_ms"] = status.clock_offset_s() * 1e3;
      row["clock_uncertainty_ms"] = status.clock_uncertainty_s() * 1e3;
    }
  } else {
    row["state"] = "silent";
  }
  if (robot.feedback) {
    row["tracking_error_mm"] = robot.feedback->value.tracking_error_m() * 1e3;
    row["off_reference"] = robot.feedback->value.is_off_reference();
    row["lifted"] = robot.feedback->value.is_lifted();
  }
  Json reasons = Json::object();
  for (const auto& [reason, times] : robot.denials) reasons[kReasonTexts[reason]] = times;
  row["denials_by_reason"] = reasons;
  if (robot.denial && now - robot.denial->at < std::chrono::seconds(1)) {
    row["denied"] = to_text(robot.denial->value.reason);
    if (robot.denial->value.reason == msg::Reason::REASON_CONFLICT)
      row["blocker"] = robot.denial->value.blocker;
  }
  if (robot.order) {
    row["order"] = order_text(robot.order->value);
    if (robot.order->value.remaining_s() >= 0) row["remaining_s"] = robot.order->value.remaining_s();
  }
  row["goals"] = goals_json(orders, id);
  return row;
}

}  // namespace

Json promise_json(const RunAssessment* assessment, bool is_heard, const std::optional<ClosestPair>& closest,
                  const std::optional<ClosestPair>& smallest) {
  Json promise{{"state", "not judged"},
               {"reason", ""},
               {"closest", pair_json(closest)},
               {"smallest", pair_json(smallest)}};
  if (assessment == nullptr) {
    promise["reason"] = "the scenario is not known; name it on the command line";
    return promise;
  }
  const Report report = assessment->metrics.report();
  const AuditTotals audit = assessment->auditor.totals();
  const std::uint64_t violations = audit.violations + report.firmware_violations;
  promise["contacts"] = report.contacts;
  promise["excused_contacts"] = audit.excused_contacts;
  promise["crashes_while_moving"] = report.crashes_while_moving;
  promise["violations"] = violations;
  promise["coverage"] = audit.coverage.share();
  promise["missed_messages"] = audit.missed;
  promise["arrived"] = report.arrived;
  promise["with_goal"] = report.arrivals().with_goal();
  promise["cycles"] = report.cycles;
  promise["missed_cycles"] = report.missed_cycles;
  promise["run_s"] = audit.run_s;
  if (report.unexcused_contacts() > 0 || violations > 0) {
    promise["state"] = "broken";
    promise["reason"] = audit.first.empty()
                            ? fmt::format("{} contacts, {} violations", report.contacts, violations)
                            : to_line(audit.first.front());
  } else if (!is_heard) {
    promise["reason"] = "no messages are received";
  } else if (audit.verdict() == AuditVerdict::kPassed) {
    promise["state"] = "kept";
  } else {
    promise["reason"] = shortfall(audit);
  }
  return promise;
}

Json robots_json(const FloorState& floor, const Waits& waits, Time now) {
  Json rows = Json::array();
  for (const auto& [id, robot] : floor.robots()) {
    Json row = robot_json(id, robot, floor.orders(), now);
    if (const auto wait = waits.find(id); wait != waits.end()) row["waits_for"] = wait->second;
    rows.push_back(std::move(row));
  }
  return rows;
}

Json coordinators_json(const FloorState& floor, Time now) {
  constexpr std::array kModes{"standby", "registering", "granting"};
  Json rows = Json::array();
  for (const auto& [number, received] : floor.coordinators()) {
    const msg::CoordinatorState& state = received.value;
    const auto mode = std::min<std::size_t>(static_cast<std::size_t>(state.coordinator_mode()), 2);
    Json missing = Json::array();
    for (const msg::RobotNotice& notice : state.notices())
      if (notice.is_missing()) missing.push_back(notice.robot());
    rows.push_back({{"number", number},
                    {"name", coordinator_process(static_cast<int>(number))},
                    {"mode", kModes[mode]},
                    {"epoch", state.epoch()},
                    {"age_s", to_seconds(now - received.at)},
                    {"grants", state.grants()},
                    {"denials", state.denials()},
                    {"conflicts", state.conflicts()},
                    {"absent", state.absent()},
                    {"missing", missing}});
  }
  return rows;
}

Json zones_json(const FloorState& floor) {
  Json zones = Json::array();
  for (const Order& order : floor.orders().zones()) {
    Json corners = Json::array();
    for (const Vec2& corner : order.zone.corners_m) corners.push_back({corner.x(), corner.y()});
    Json zone{{"client", client_text(order.client, order.client_name)},
              {"number", order.zone_number},
              {"corners", corners},
              {"radius_m", order.zone.radius_m}};
    if (order.zone.speed_limit_mps) zone["speed_limit_mps"] = *order.zone.speed_limit_mps;
    zones.push_back(zone);
  }
  return zones;
}

Json epochs_json(const RunAssessment* assessment) {
  Json rows = Json::array();
  if (assessment == nullptr) return rows;
  for (const EpochRecord& epoch : assessment->metrics.epochs())
    rows.push_back({{"epoch", epoch.epoch},
                    {"coordinator", epoch.coordinator},
                    {"begun_s", unix_seconds(epoch.begun_at)},
                    {"reason", epoch.reason}});
  return rows;
}

}  // namespace sidestep
