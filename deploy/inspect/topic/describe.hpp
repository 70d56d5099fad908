// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "idl/clock.hpp"
#include "idl/disturbance.hpp"
#include "idl/laser.hpp"
#include "idl/monitor.hpp"
#include "idl/negotiation.hpp"
#include "idl/order.hpp"
#include "idl/robot.hpp"
#include "idl/rules.hpp"
#include "idl/vision.hpp"

namespace sidestep {

/// A readable form of a message: members with their IDL names in IDL order, enumerators in words, arrays
/// truncated to their count, histograms as quantiles, and pixels as a byte count.
[[nodiscard]] nlohmann::ordered_json describe(const msg::CameraImage& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::DetectionFrame& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::WorldState& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::ObstacleList& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::Command& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::Feedback& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::LaserScan& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::Registration& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::Proposal& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::Verdict& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::LedgerPage& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::CoordinatorState& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::AbsenceAttestation& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::Order& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::OrderAnswer& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::OrderMemory& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::OrderStatus& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::AgentStatus& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::Counters& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::ClockProbe& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::ClockReading& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::GroundTruth& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::Disturbance& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::NetworkFault& m);
[[nodiscard]] nlohmann::ordered_json describe(const msg::SharedRules& m);

}  // namespace sidestep
