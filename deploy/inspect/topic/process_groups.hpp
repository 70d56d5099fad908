// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "deploy/inspect/topic/graph.hpp"

namespace sidestep {

/// Processes of one kind on one host.
struct GraphGroup {
  std::string host;
  std::string kind;                           ///< "agent", "coordinator", "tool", or the name of a process
  std::vector<std::string> members;           ///< names of the processes, in the order of their numbers
  std::map<std::string, std::size_t> writes;  ///< number of members that write each topic
  std::map<std::string, std::size_t> reads;
};

/// Groups the processes of each host by kind: agents, coordinators, the other parts of the system, tools
/// (`sidestep …`), and processes of others, those whose names differ in a number only together.
[[nodiscard]] std::vector<GraphGroup> groups_of(const ProcessGraph& graph);

/// "22 agents", "coordinator", "3 tools".
[[nodiscard]] std::string title_of(const GraphGroup& group);

/// What distinguishes the members, with ranges of numbers: "0-10, 16-26"; empty if there is one member.
[[nodiscard]] std::string members_text(const GraphGroup& group);

}  // namespace sidestep
