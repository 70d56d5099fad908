// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deploy/inspect/topic/graph.hpp"

namespace sidestep {

/// Draws the graph as SVG: writers on the left, topics in the middle, readers on the right. Processes of one
/// kind are one box with their number. Topics with a QoS mismatch are red, and the mismatches are listed.
[[nodiscard]] std::string graph_picture(const ProcessGraph& graph);

}  // namespace sidestep
