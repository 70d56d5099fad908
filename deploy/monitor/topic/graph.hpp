// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "common/messaging/dds/listener.hpp"

namespace sidestep {

/// The processes and topics of a domain, and who writes and reads what.
struct ProcessGraph {
  struct Process {
    std::string name;
    std::string host;  ///< the part of the process's GUID that tells hosts apart
    std::set<std::string> writes, reads;
  };
  std::vector<Process> processes;       ///< by host and name
  std::vector<std::string> topics;      ///< sorted; channels of one topic are one: "feedback/*"
  std::vector<std::string> mismatches;  ///< "feedback/3: reason (writer -> reader)"
};

[[nodiscard]] ProcessGraph graph_of(const std::vector<DiscoveredEndpoint>& endpoints);

/// A paragraph per host and a line per process.
[[nodiscard]] std::string to_text(const ProcessGraph& graph);

/// A picture: processes on the left, topics on the right, lines between them; hosts as boxes.
[[nodiscard]] std::string to_svg(const ProcessGraph& graph);

}  // namespace sidestep
