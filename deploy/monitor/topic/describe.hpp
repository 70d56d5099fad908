// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "idl/disturbance.h"
#include "idl/monitor.h"
#include "idl/negotiation.h"
#include "idl/robot.h"
#include "idl/vision.h"

namespace sidestep {

/// A message for people's eyes: its members by their IDL names and in their order, enumerators as words,
/// arrays that come with a count only as far as it goes, histograms as quantiles, pixels as their number.
nlohmann::ordered_json describe(const msg::CameraImage& m);
nlohmann::ordered_json describe(const msg::DetectionFrame& m);
nlohmann::ordered_json describe(const msg::WorldState& m);
nlohmann::ordered_json describe(const msg::Command& m);
nlohmann::ordered_json describe(const msg::Feedback& m);
nlohmann::ordered_json describe(const msg::Registration& m);
nlohmann::ordered_json describe(const msg::Proposal& m);
nlohmann::ordered_json describe(const msg::Verdict& m);
nlohmann::ordered_json describe(const msg::LedgerPage& m);
nlohmann::ordered_json describe(const msg::CoordinatorState& m);
nlohmann::ordered_json describe(const msg::AgentStatus& m);
nlohmann::ordered_json describe(const msg::GroundTruth& m);
nlohmann::ordered_json describe(const msg::Disturbance& m);
nlohmann::ordered_json describe(const msg::NetworkFault& m);

}  // namespace sidestep
