// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/describe.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/protocol/drop_reasons.hpp"
#include "tests/catch.hpp"

namespace sidestep::describe_test {

using Json = nlohmann::ordered_json;

std::string idl_text() {
  std::ostringstream text;
  for (const char* name : {"header", "trajectory", "robot", "negotiation", "vision", "disturbance", "monitor",
                           "order", "clock", "laser"}) {
    std::ifstream file(std::string(SIDESTEP_IDL_DIR) + "/" + name + ".idl");
    REQUIRE(file);
    text << file.rdbuf();
  }
  return text.str();
}

std::string without_comments(const std::string& idl) {
  std::istringstream lines(idl);
  std::string result;
  for (std::string line; std::getline(lines, line);) result += line.substr(0, line.find("//")) + "\n";
  return result;
}

/// The text between the braces of "struct NAME {" or "enum NAME {".
std::string idl_body(const std::string& idl, const std::string& declaration) {
  const std::size_t begin = idl.find(declaration + " {");
  REQUIRE(begin != std::string::npos);
  const std::size_t open = idl.find('{', begin);
  return idl.substr(open + 1, idl.find('}', open) - open - 1);
}

/// The last word of each piece that ends with the separator, without square brackets and their content.
std::vector<std::string> last_words(const std::string& text, char separator) {
  const std::string blanks = " \n";
  std::istringstream pieces(text);
  std::vector<std::string> result;
  for (std::string piece; std::getline(pieces, piece, separator);) {
    piece.resize(std::min(piece.size(), piece.find('[')));
    const std::size_t end = piece.find_last_not_of(blanks);
    if (end == std::string::npos) continue;
    const std::size_t before = piece.find_last_of(blanks, end);
    result.push_back(piece.substr(before + 1, end - before));
  }
  return result;
}

/// The members of a struct in the IDL, in order.
std::vector<std::string> idl_members(const std::string& idl, const std::string& name) {
  return last_words(idl_body(idl, "struct " + name), ';');
}

std::vector<std::string> idl_enumerators(const std::string& idl, const std::string& name) {
  return last_words(idl_body(idl, "enum " + name), ',');
}

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> result;
  for (const auto& item : object.items()) result.push_back(item.key());
  return result;
}

/// "REASON_NOT_EVALUATED" with prefix "REASON_" as "not evaluated".
std::string to_lines(std::string enumerator, const std::string& prefix) {
  enumerator.erase(0, prefix.size());
  for (char& c : enumerator) c = c == '_' ? ' ' : static_cast<char>(std::tolower(c));
  return enumerator;
}

TEST_CASE("a description contains the members of each message in IDL order") {
  const std::string idl = without_comments(idl_text());
  msg::DetectionFrame frame;
  frame.ball_count(1);
  frame.obstacle_count(1);
  frame.robots().resize(1);
  msg::WorldState world;
  world.robots().resize(1);
  msg::ObstacleList obstacles;
  obstacles.obstacles().resize(1);
  msg::Counters counters;
  counters.counts().resize(1);
  msg::GroundTruth truth;
  truth.robots().resize(1);
  msg::Feedback feedback;
  feedback.executing().phase_count(1);

  CHECK(keys(describe(frame)) == idl_members(idl, "DetectionFrame"));
  CHECK(keys(describe(frame)["header"]) == idl_members(idl, "Header"));
  CHECK(keys(describe(frame)["balls"].at(0)) == idl_members(idl, "BallDetection"));
  CHECK(keys(describe(frame)["robots"].at(0)) == idl_members(idl, "RobotDetection"));
  CHECK(keys(describe(frame)["obstacles"].at(0)) == idl_members(idl, "ObstacleDetection"));
  CHECK(keys(describe(obstacles)) == idl_members(idl, "ObstacleList"));
  CHECK(keys(describe(obstacles)["obstacles"].at(0)) == idl_members(idl, "TrackedObstacle"));
  CHECK(keys(describe(msg::Disturbance())) == idl_members(idl, "Disturbance"));
  CHECK(keys(describe(msg::NetworkFault())) == idl_members(idl, "NetworkFault"));
  CHECK(keys(describe(world)) == idl_members(idl, "WorldState"));
  CHECK(keys(describe(world)["ball"]) == idl_members(idl, "TrackedBall"));
  CHECK(keys(describe(world)["robots"].at(0)) == idl_members(idl, "TrackedRobot"));
  CHECK(keys(describe(msg::Command())) == idl_members(idl, "Command"));
  CHECK(keys(describe(msg::LaserScan())) == idl_members(idl, "LaserScan"));
  CHECK(keys(describe(msg::Command())["fix"]) == idl_members(idl, "PoseFix"));
  CHECK(keys(describe(feedback)) == idl_members(idl, "Feedback"));
  CHECK(keys(describe(feedback)["executing"]) == idl_members(idl, "Version"));
  CHECK(keys(describe(feedback)["executing"]["phases"].at(0)) == idl_members(idl, "MotionPhase"));
  CHECK(keys(describe(msg::Registration())) == idl_members(idl, "Registration"));
  CHECK(keys(describe(msg::Proposal())) == idl_members(idl, "Proposal"));
  CHECK(keys(describe(msg::Verdict())) == idl_members(idl, "Verdict"));
  CHECK(keys(describe(msg::LedgerPage())) == idl_members(idl, "LedgerPage"));
  CHECK(keys(describe(msg::CoordinatorState())) == idl_members(idl, "CoordinatorState"));
  msg::OrderMemory memory;
  memory.order_count(1);
  memory.poses().resize(1);
  CHECK(keys(describe(msg::Order())) == idl_members(idl, "Order"));
  CHECK(keys(describe(msg::Order())["terms"]) == idl_members(idl, "OrderTerms"));
  CHECK(keys(describe(msg::OrderAnswer())) == idl_members(idl, "OrderAnswer"));
  CHECK(keys(describe(memory)) == idl_members(idl, "OrderMemory"));
  CHECK(keys(describe(memory)["orders"].at(0)) == idl_members(idl, "RememberedOrder"));
  CHECK(keys(describe(memory)["poses"].at(0)) == idl_members(idl, "OrderPose"));
  CHECK(keys(describe(msg::OrderStatus())) == idl_members(idl, "OrderStatus"));
  CHECK(keys(describe(msg::ClockProbe())) == idl_members(idl, "ClockProbe"));
  CHECK(keys(describe(msg::ClockReading())) == idl_members(idl, "ClockReading"));
  CHECK(keys(describe(msg::AgentStatus())) == idl_members(idl, "AgentStatus"));
  CHECK(keys(describe(counters)) == idl_members(idl, "Counters"));
  CHECK(keys(describe(counters)["counts"].at(0)) == idl_members(idl, "Counter"));
  CHECK(keys(describe(truth)) == idl_members(idl, "GroundTruth"));
  CHECK(keys(describe(truth)["robots"].at(0)) == idl_members(idl, "TrueRobotState"));
}

TEST_CASE("an enumerator is described by the words of its IDL name, an unknown one by its number") {
  const std::string idl = without_comments(idl_text());
  const auto check = [&](const char* name, const std::string& prefix, auto describe_value) {
    const std::vector<std::string> enumerators = idl_enumerators(idl, name);
    REQUIRE_FALSE(enumerators.empty());
    for (std::uint32_t i = 0; i < enumerators.size(); ++i) {
      CHECK(describe_value(i) == to_lines(enumerators[i], prefix));
    }
    const auto unknown_value = static_cast<std::uint32_t>(enumerators.size());
    CHECK(describe_value(unknown_value) == "unknown " + std::to_string(unknown_value));
    CHECK(describe_value(0xffffffffu) == "unknown 4294967295");
  };
  check("Reason", "REASON_", [](std::uint32_t value) -> std::string {
    msg::Verdict verdict;
    verdict.reasons()[0] = static_cast<msg::Reason>(value);
    return describe(verdict)["reasons"][0];
  });
  check("DisturbanceKind", "DISTURBANCE_", [](std::uint32_t value) -> std::string {
    msg::Disturbance disturbance;
    disturbance.disturbance_kind(static_cast<msg::DisturbanceKind>(value));
    return describe(disturbance)["disturbance_kind"];
  });
  check("AgentState", "AGENT_", [](std::uint32_t value) -> std::string {
    msg::AgentStatus status;
    status.agent_state(static_cast<msg::AgentState>(value));
    return describe(status)["agent_state"];
  });
  check("OrderKind", "ORDER_", [](std::uint32_t value) -> std::string {
    msg::Order order;
    order.terms().order_kind(static_cast<msg::OrderKind>(value));
    return describe(order)["terms"]["order_kind"];
  });
  check("OrderResult", "RESULT_", [](std::uint32_t value) -> std::string {
    msg::OrderAnswer answer;
    answer.result(static_cast<msg::OrderResult>(value));
    return describe(answer)["result"];
  });
  check("OrderState", "ORDER_", [](std::uint32_t value) -> std::string {
    msg::OrderStatus status;
    status.order_state(static_cast<msg::OrderState>(value));
    return describe(status)["order_state"];
  });
  check("BlockReason", "BLOCK_", [](std::uint32_t value) -> std::string {
    msg::OrderStatus status;
    status.block_reason(static_cast<msg::BlockReason>(value));
    return describe(status)["block_reason"];
  });
  check("RoleReason", "ROLE_", [](std::uint32_t value) -> std::string {
    msg::CoordinatorState state;
    state.role_reason(static_cast<msg::RoleReason>(value));
    return describe(state)["role_reason"];
  });
  check("CoordinatorMode", "COORDINATOR_", [](std::uint32_t value) -> std::string {
    msg::CoordinatorState state;
    state.coordinator_mode(static_cast<msg::CoordinatorMode>(value));
    return describe(state)["coordinator_mode"];
  });
}

TEST_CASE("a counter is described by the name of its reason, an unknown reason by its number") {
  msg::Counters message;
  for (std::size_t i = 0; i <= kDropReasonCount; ++i)
    message.counts().emplace_back().reason(static_cast<std::uint16_t>(i));
  const Json description = describe(message);
  for (std::size_t i = 0; i < kDropReasonCount; ++i)
    CHECK(description["counts"][i]["reason"] == kDropReasons[i].name);
  CHECK(description["counts"].back()["reason"] == "unknown " + std::to_string(kDropReasonCount));
}

TEST_CASE("the README of the monitor has the table of reasons") {
  std::ifstream file(SIDESTEP_IDL_DIR "/../deploy/audit/README.md");
  const std::string readme{std::istreambuf_iterator<char>(file), {}};
  for (const DropReasonInfo& info : kDropReasons) {
    const std::string row = std::string("| `") + info.name + "` | " + info.description + " | " +
                            (info.is_unusual ? "yes |" : "|");
    CAPTURE(row);
    CHECK(readme.find(row) != std::string::npos);
  }
}

TEST_CASE("a count beyond its array shows the whole array and the unmodified count") {
  msg::Proposal proposal;
  proposal.candidate_count(255);
  proposal.candidates()[0].phase_count(200);
  const Json description = describe(proposal);
  CHECK(description["candidate_count"] == 255);
  CHECK(description["candidates"].size() == proposal.candidates().size());
  CHECK(description["candidates"][0]["phases"].size() == proposal.candidates()[0].phases().size());
  CHECK(description["candidates"][1]["phases"].empty());
}

}  // namespace sidestep::describe_test
