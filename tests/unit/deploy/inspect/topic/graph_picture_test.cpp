// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/graph_picture.hpp"

#include <fmt/format.h>
#include <regex>

#include "deploy/inspect/topic/process_groups.hpp"
#include "tests/catch.hpp"

namespace sidestep::graph_picture_test {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

DiscoveredEndpoint endpoint(const std::string& participant, const std::string& topic, bool is_writer,
                            const std::string& host = "aa") {
  DiscoveredEndpoint result;
  result.guid = "01.0f." + host + ".01.17.00";
  result.participant = participant;
  result.topic = topic;
  result.type = "Type";
  result.is_writer = is_writer;
  return result;
}

/// The system of `two-teams-22`, with robots 0 to 10 and 16 to 26, and tools.
std::vector<DiscoveredEndpoint> two_teams() {
  std::vector<DiscoveredEndpoint> endpoints;
  for (int i = 0; i < 22; ++i) {
    const int robot = i < 11 ? i : i + 5;
    const std::string agent = fmt::format("agent-{}", robot);
    for (const char* topic : {"proposal", "status", "clock"})
      endpoints.push_back(endpoint(agent, topic, true));
    endpoints.push_back(endpoint(agent, fmt::format("command/{}", robot), true));
    for (const char* topic : {"world", "ledger"}) endpoints.push_back(endpoint(agent, topic, false));
    endpoints.push_back(endpoint(agent, fmt::format("verdict/{}", robot), false));
    endpoints.push_back(endpoint("sidestep-simulator", fmt::format("command/{}", robot), false));
    for (const char* coordinator : {"sidestep-coordinator", "coordinator-1"})
      endpoints.push_back(endpoint(coordinator, fmt::format("verdict/{}", robot), true));
  }
  for (const char* coordinator : {"sidestep-coordinator", "coordinator-1"}) {
    endpoints.push_back(endpoint(coordinator, "ledger", true));
    endpoints.push_back(endpoint(coordinator, "proposal", false));
  }
  endpoints.push_back(endpoint("sidestep-vision", "world", true));
  for (const char* tool : {"sidestep-run", "sidestep-monitor", "sidestep-record"})
    endpoints.push_back(endpoint(tool, "status", false));
  endpoints.push_back(endpoint("forklift", "world", false));
  return endpoints;
}

TEST_CASE("processes of one kind are one group with their number, in the order of the system") {
  const std::vector<GraphGroup> groups = groups_of(graph_of(two_teams()));
  std::vector<std::string> titles, members;
  for (const GraphGroup& group : groups) {
    titles.push_back(title_of(group));
    members.push_back(members_text(group));
  }
  CHECK(titles == std::vector<std::string>{"22 agents", "2 coordinators", "sidestep-vision",
                                           "sidestep-simulator", "forklift", "3 tools"});
  CHECK(members == std::vector<std::string>{"0-10, 16-26", "coordinator, coordinator-1", "", "", "",
                                            "monitor, record, run"});
  CHECK(groups[0].writes.at("command/*") == 22);
  CHECK(groups[0].writes.size() == 4);
  CHECK(groups[5].reads.at("status") == 3);
}

TEST_CASE("processes of others that differ in a number are a group, and hosts keep theirs apart") {
  const std::vector<GraphGroup> groups = groups_of(
      graph_of({endpoint("patrol-2", "a", true), endpoint("patrol-10", "a", true),
                endpoint("patrol-1", "a", true, "bb"), endpoint("-3", "a", true), endpoint("", "a", true)}));
  std::vector<std::string> titles;
  for (const GraphGroup& group : groups) titles.push_back(title_of(group));
  REQUIRE(titles.size() == 4);
  CHECK(titles[0] == "-3");
  CHECK(titles[1] == "01.0f.aa.01.17.00");  // without a name
  CHECK(titles[2] == "2 patrols");
  CHECK(members_text(groups[2]) == "2, 10");
  CHECK(titles[3] == "patrol-1");
}

TEST_CASE("the picture of 22 robots has few boxes and lines, none of which overlap") {
  const std::string svg = graph_picture(graph_of(two_teams()));
  CAPTURE(svg);
  CHECK_THAT(svg, ContainsSubstring(">22 agents</text>") && ContainsSubstring(">0-10, 16-26</text>") &&
                      ContainsSubstring(">3 tools</text>") && !ContainsSubstring(">agent-3</text>"));
  CHECK_THAT(svg, ContainsSubstring(">30 processes on 1 host, 7 topics</text>"));
  CHECK(count(svg, ">22 agents</text>") == 2);  // as writers and as readers
  // Four topics of agents, two of coordinators, one of vision; three, one, one, one and one are read.
  CHECK(count(svg, "<path d='M") == 14);
  // Boxes of one column do not overlap.
  std::map<double, double> bottom_px;  // indexed by x
  const std::regex box("<rect x='([0-9.]+)' y='([0-9.]+)' width='[0-9.]+' height='([0-9.]+)'");
  for (std::sregex_iterator match(svg.begin(), svg.end(), box), end; match != end; ++match) {
    double& bottom = bottom_px[std::stod((*match)[1])];
    CHECK(std::stod((*match)[2]) >= bottom);
    bottom = std::stod((*match)[2]) + std::stod((*match)[3]);
  }
  CHECK(bottom_px.size() == 3);
}

TEST_CASE("a line is dashed if not all processes of its box have the topic") {
  std::vector<DiscoveredEndpoint> endpoints = two_teams();
  CHECK_THAT(graph_picture(graph_of(endpoints)), !ContainsSubstring("stroke-dasharray"));
  endpoints.push_back(endpoint("agent-3", "faults", false));
  const std::string svg = graph_picture(graph_of(endpoints));
  CHECK(count(svg, "stroke-dasharray") == 1);
  CHECK_THAT(svg, ContainsSubstring("<title>1 of 22: faults</title>"));
}

TEST_CASE("mismatches are red and listed, and several hosts are boxes") {
  DiscoveredEndpoint reader = endpoint("simulator", "command/3", false, "bb");
  reader.is_reliable = true;
  const std::string svg = graph_picture(graph_of({endpoint("agent-3 <&>", "command/3", true), reader}));
  CAPTURE(svg);
  CHECK_THAT(svg, ContainsSubstring("agent-3 &lt;&amp;&gt;</text>") &&
                      ContainsSubstring(">MISMATCH command/3: ") &&
                      ContainsSubstring("fill='#b3122f'>command/*</text>"));
  CHECK_THAT(svg,
             ContainsSubstring(">host 01.0f.aa.01</text>") && ContainsSubstring(">host 01.0f.bb.01</text>"));
}

TEST_CASE("the picture of an empty domain, and of names of any length, is a picture") {
  CHECK_THAT(graph_picture(graph_of({})), ContainsSubstring(">0 processes on 0 hosts, 0 topics</text>"));
  const std::string name(500, 'x');
  const std::string svg = graph_picture(graph_of({endpoint(name, name, true)}));
  CHECK_THAT(svg, ContainsSubstring("xx\xE2\x80\xA6</text>") && !ContainsSubstring(">" + name + "</text>"));
}

}  // namespace sidestep::graph_picture_test
