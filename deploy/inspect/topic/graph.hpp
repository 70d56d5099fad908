// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "common/messaging/dds/listener.hpp"

namespace sidestep {

/// The processes and topics of a domain, and which process writes and reads which topic.
struct ProcessGraph {
  struct Process {
    std::string name;
    std::string
        host;  ///< its name, as `sidestep clock` prints it; without one, the start of the process's GUID
    std::set<std::string> writes, reads;
  };
  std::vector<Process> processes;       ///< sorted by host and name
  std::vector<std::string> topics;      ///< sorted; the channels of one topic are combined: "feedback/*"
  std::vector<std::string> mismatches;  ///< for example "feedback/3: reason (writer -> reader)"
};

[[nodiscard]] ProcessGraph graph_of(const std::vector<DiscoveredEndpoint>& endpoints);

/// Formats the graph as text: a paragraph per host and a line per process.
[[nodiscard]] std::string to_text(const ProcessGraph& graph);

/// Combines the channels of one topic: "feedback/3" becomes "feedback/*".
[[nodiscard]] std::string without_channel(const std::string& topic);

}  // namespace sidestep
