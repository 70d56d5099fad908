// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/describe.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/json/json_text.hpp"
#include "common/messaging/histogram_codec.hpp"
#include "common/protocol/client_name.hpp"
#include "common/protocol/disturbance_text.hpp"
#include "common/protocol/drop_reasons.hpp"
#include "common/protocol/reason_text.hpp"
#include "common/protocol/senders.hpp"
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

/// The last word before each separator.
std::vector<std::string> last_words(const std::string& text, char separator) {
  const std::string blanks = " \n";
  std::istringstream pieces(text);
  std::vector<std::string> result;
  for (std::string piece; std::getline(pieces, piece, separator);) {
    const std::size_t end = piece.find_last_not_of(blanks);
    if (end == std::string::npos) continue;
    const std::size_t before = piece.find_last_of(blanks, end);
    result.push_back(piece.substr(before + 1, end - before));
  }
  return result;
}

std::vector<std::string> idl_enumerators(const std::string& idl, const std::string& name) {
  return last_words(idl_body(idl, "enum " + name), ',');
}

/// Turns "REASON_NOT_EVALUATED" with the prefix "REASON_" into "not evaluated".
std::string to_lines(std::string enumerator, const std::string& prefix) {
  enumerator.erase(0, prefix.size());
  for (char& c : enumerator) c = c == '_' ? ' ' : static_cast<char>(std::tolower(c));
  return enumerator;
}

/// A version whose members all differ.
msg::Version some_version() {
  msg::Version version;
  version.robot(3);
  version.incarnation(18'000'000'000'000'000'000u);
  version.version_number(12);
  version.base(11);
  version.start_ns(-5);
  version.x_m(1.5);
  version.y_m(-2.25);
  version.vx_mps(0.5);
  version.vy_mps(0.125);
  version.inflation_m(0.0625);
  version.has_intent(true);
  version.intent().vx_mps(0.25F);
  version.intent().vy_mps(-0.25F);
  version.intent().velocity_duration_s(2);
  version.intent().via_x_m(3);
  version.intent().via_y_m(4);
  version.intent().goal_x_m(5);
  version.intent().goal_y_m(6);
  version.intent().target_x_m(7);
  version.intent().target_y_m(8);
  version.intent().due_ns(9);
  version.phase_count(1);
  version.phases()[0].duration_ns(1'000'000'000);
  version.phases()[0].ax_mps2(-0.5);
  version.phases()[0].ay_mps2(9);
  return version;
}

constexpr const char* kSomeVersion =
    R"({"robot":3,"incarnation":18000000000000000000,"version_number":12,"base":11,"start_ns":-5,"x_m":1.5,)"
    R"("y_m":-2.25,"vx_mps":0.5,"vy_mps":0.125,"inflation_m":0.0625,"has_intent":true,"intent":{"vx_mps":0.25,)"
    R"("vy_mps":-0.25,"velocity_duration_s":2.0,"via_x_m":3.0,"via_y_m":4.0,"goal_x_m":5.0,"goal_y_m":6.0,)"
    R"("target_x_m":7.0,"target_y_m":8.0,"due_ns":9},"phase_count":1,)"
    R"("phases":[{"duration_ns":1000000000,"ax_mps2":-0.5,"ay_mps2":9.0}]})";

template <typename Message>
void fill_header(Message& message) {
  message.header().sender(1003);
  message.header().incarnation(77);
  message.header().rules(0x00c0ffee);
  message.header().message_number(4);
  message.header().stamp_ns(1'700'000'000'123'456'789);
}

constexpr const char* kSomeHeader =
    R"({"sender":1003,"incarnation":77,"rules":"0000000000c0ffee","message_number":4,)"
    R"("stamp_ns":1700000000123456789})";

TEST_CASE("a description has the message's members in IDL order with the generated code's values") {
  msg::Feedback feedback;
  feedback.robot(3);
  fill_header(feedback);
  feedback.obeyed_incarnation(76);
  feedback.obeyed_epoch(5);
  feedback.valid_at_ns(8);
  feedback.executing() = some_version();
  feedback.is_lifted(true);
  feedback.command_stamp_ns(9);
  feedback.command_received_at_ns(10);
  feedback.x_m(0.1);
  feedback.y_m(0.2);
  feedback.vx_mps(0.3);
  feedback.vy_mps(0.4);
  feedback.heading_rad(0.5);
  feedback.tracking_error_m(0.6);
  feedback.position_error_rms_m(0.7);
  feedback.odometry_scale_stddev(0.8);
  feedback.has_moved(true);
  feedback.activated(13);
  feedback.lead_ns(14);
  CHECK(json_text(describe(topics::kFeedback, &feedback)) ==
        std::string(R"({"robot":3,"header":)") + kSomeHeader +
            R"(,"obeyed_incarnation":76,"obeyed_epoch":5,"valid_at_ns":8,"executing":)" + kSomeVersion +
            R"(,"is_off_reference":false,"is_lifted":true,"command_stamp_ns":9,"command_received_at_ns":10,)"
            R"("x_m":0.1,"y_m":0.2,"vx_mps":0.3,"vy_mps":0.4,"heading_rad":0.5,"tracking_error_m":0.6,)"
            R"("position_error_rms_m":0.7,"odometry_scale_stddev":0.8,"has_moved":true,"activated":13,)"
            R"("lead_ns":14})");
}

TEST_CASE("a client's name is described as text") {
  msg::Order order;
  order.terms().client_name(client_name("kitchen"));
  CHECK(describe(topics::kOrder, &order)["terms"]["client_name"] == "kitchen");
  msg::OrderStatus status;
  CHECK(describe(topics::kOrderStatus, &status)["client_name"] == "");
}

TEST_CASE("a description has the used elements of arrays and all elements of sequences") {
  msg::DetectionFrame frame;
  frame.camera(2);
  fill_header(frame);
  frame.captured_at_ns(6);
  frame.ball_count(1);
  frame.balls()[0].x_m(0.5);
  frame.balls()[0].y_m(1);
  frame.balls()[0].confidence(0.75);
  frame.obstacles_complete_within_m(1e9);
  frame.obstacle_count(2);
  frame.obstacles()[0].x_m(2);
  frame.obstacles()[1].y_m(3);
  frame.obstacles()[1].radius_m(0.25);
  frame.robots().resize(2);
  frame.robots()[0].robot(7);
  frame.robots()[1].heading_rad(-1.5);
  CHECK(json_text(describe(topics::kDetections, &frame)) ==
        std::string(R"({"camera":2,"header":)") + kSomeHeader +
            R"(,"captured_at_ns":6,"ball_count":1,"balls":[{"x_m":0.5,"y_m":1.0,"confidence":0.75}],)"
            R"("obstacles_complete_within_m":1000000000.0,"obstacle_count":2,)"
            R"("obstacles":[{"x_m":2.0,"y_m":0.0,"radius_m":0.0},{"x_m":0.0,"y_m":3.0,"radius_m":0.25}],)"
            R"("robots":[{"robot":7,"x_m":0.0,"y_m":0.0,"heading_rad":0.0,"confidence":0.0},)"
            R"({"robot":0,"x_m":0.0,"y_m":0.0,"heading_rad":-1.5,"confidence":0.0}]})");
}

TEST_CASE("arrays without a count are described completely") {
  msg::Verdict verdict;
  verdict.robot(3);
  fill_header(verdict);
  verdict.epoch(5);
  verdict.proposal_number(6);
  verdict.request_stamp_ns(7);
  verdict.reasons()[1] = msg::Reason::REASON_CONFLICT;
  verdict.blockers()[1] = 9;
  CHECK(json_text(describe(topics::kVerdict, &verdict)) ==
        std::string(R"({"robot":3,"header":)") + kSomeHeader +
            R"(,"epoch":5,"proposal_number":6,"request_stamp_ns":7,"granted_version":0,)"
            R"("reasons":["granted","conflict","granted","granted","granted"],"blockers":[0,9,0,0,0]})");
  CHECK(describe(topics::kTruth, std::make_unique<msg::GroundTruth>().get())["recent_contacts"].size() ==
        msg::MAX_CONTACTS);
}

TEST_CASE("a histogram is described by its quantiles") {
  DurationHistogram histogram;
  for (int i = 0; i < 98; ++i) histogram.add(std::chrono::microseconds(10));
  for (int i = 0; i < 2; ++i) histogram.add(std::chrono::milliseconds(5));
  msg::AgentStatus status;
  status.search() = encode(histogram);
  const Json description = describe(topics::kStatus, &status);
  const auto us = [&](double q) { return static_cast<double>(histogram.quantile(q).count()) * 1e-3; };
  CHECK(description["search"] ==
        Json{{"count", 100}, {"p50_us", us(0.5)}, {"p99_us", us(0.99)}, {"max_us", 5000.0}});
  CHECK(description["plan"] == Json{{"count", 0}, {"p50_us", 0.0}, {"p99_us", 0.0}, {"max_us", 0.0}});
}

TEST_CASE("text is described as text and an image by its size") {
  const std::string text = "radius_m: 0.09\n";
  msg::SharedRules rules;
  rules.text().assign(text.begin(), text.end());
  CHECK(describe(topics::kRules, &rules)["text"] == text);
  msg::ClockReading reading;
  reading.place().assign(text.begin(), text.end());
  CHECK(describe(topics::kClockReading, &reading)["place"] == text);
  // An image may have more bytes than other sequences may have elements.
  msg::CameraImage image;
  image.pixels().assign(12'000'000, 'a');
  image.image_format(msg::ImageFormat::IMAGE_RGB);
  CHECK(describe(topics::kImages, &image)["pixels"] == "12000000 bytes");
  CHECK(describe(topics::kImages, &image)["image_format"] == "rgb");
}

TEST_CASE("laser beams without a range are described in words") {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  msg::LaserScan scan;
  scan.ranges_m() = {1.5F, kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()};
  CHECK(describe(topics::kScan, &scan)["ranges_m"] == Json{1.5, "no hit", "too near", "lost"});
}

TEST_CASE("an enumerator is described by the words of its IDL name, and an unknown value by its number") {
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
    return describe(topics::kVerdict, &verdict)["reasons"][0];
  });
  check("DisturbanceKind", "DISTURBANCE_", [](std::uint32_t value) -> std::string {
    msg::Disturbance disturbance;
    disturbance.disturbance_kind(static_cast<msg::DisturbanceKind>(value));
    return describe(topics::kDisturbance, &disturbance)["disturbance_kind"];
  });
  check("AgentState", "AGENT_", [](std::uint32_t value) -> std::string {
    msg::AgentStatus status;
    status.agent_state(static_cast<msg::AgentState>(value));
    return describe(topics::kStatus, &status)["agent_state"];
  });
  check("OrderKind", "ORDER_", [](std::uint32_t value) -> std::string {
    msg::Order order;
    order.terms().order_kind(static_cast<msg::OrderKind>(value));
    return describe(topics::kOrder, &order)["terms"]["order_kind"];
  });
  check("OrderResult", "RESULT_", [](std::uint32_t value) -> std::string {
    msg::OrderAnswer answer;
    answer.result(static_cast<msg::OrderResult>(value));
    return describe(topics::kOrderAnswer, &answer)["result"];
  });
  check("OrderState", "ORDER_", [](std::uint32_t value) -> std::string {
    msg::OrderStatus status;
    status.order_state(static_cast<msg::OrderState>(value));
    return describe(topics::kOrderStatus, &status)["order_state"];
  });
  check("BlockReason", "BLOCK_", [](std::uint32_t value) -> std::string {
    msg::OrderStatus status;
    status.block_reason(static_cast<msg::BlockReason>(value));
    return describe(topics::kOrderStatus, &status)["block_reason"];
  });
  check("RoleReason", "ROLE_", [](std::uint32_t value) -> std::string {
    msg::CoordinatorState state;
    state.role_reason(static_cast<msg::RoleReason>(value));
    return describe(topics::kCoordinator, &state)["role_reason"];
  });
  check("CoordinatorMode", "COORDINATOR_", [](std::uint32_t value) -> std::string {
    msg::CoordinatorState state;
    state.coordinator_mode(static_cast<msg::CoordinatorMode>(value));
    return describe(topics::kCoordinator, &state)["coordinator_mode"];
  });
  check("ImageFormat", "IMAGE_", [](std::uint32_t value) -> std::string {
    msg::CameraImage image;
    image.image_format(static_cast<msg::ImageFormat>(value));
    return describe(topics::kImages, &image)["image_format"];
  });
}

TEST_CASE("logs and web pages use the same words for enumerators as describe()") {
  const std::string idl = without_comments(idl_text());
  const auto check = [&](const char* name, const std::string& prefix, const auto& texts) {
    const std::vector<std::string> enumerators = idl_enumerators(idl, name);
    REQUIRE(enumerators.size() == std::size(texts));
    for (std::size_t i = 0; i < enumerators.size(); ++i) CHECK(texts[i] == to_lines(enumerators[i], prefix));
  };
  check("Reason", "REASON_", kReasonTexts);
  check("DisturbanceKind", "DISTURBANCE_", kDisturbanceTexts);
}

TEST_CASE("a counter is described by the name of its reason, and an unknown reason by its number") {
  msg::Counters message;
  for (std::size_t i = 0; i <= kDropReasonCount; ++i)
    message.counts().emplace_back().reason(static_cast<std::uint16_t>(i));
  const Json description = describe(topics::kCounters, &message);
  for (std::size_t i = 0; i < kDropReasonCount; ++i)
    CHECK(description["counts"][i]["reason"] == kDropReasons[i].name);
  CHECK(description["counts"].back()["reason"] == "unknown " + std::to_string(kDropReasonCount));
}

TEST_CASE("numbers that mean every robot, every process or no robot are described in words") {
  msg::Order order;
  order.robot(msg::ALL_ROBOTS);
  CHECK(describe(topics::kOrder, &order)["robot"] == "all");
  order.robot(3);
  CHECK(describe(topics::kOrder, &order)["robot"] == 3);
  const auto memory = std::make_unique<msg::OrderMemory>();
  memory->order_count(1);
  memory->orders()[0].robot(msg::ALL_ROBOTS);
  CHECK(describe(topics::kOrderMemory, memory.get())["orders"][0]["robot"] == "all");
  msg::NetworkFault fault;
  fault.target(kEveryProcess);
  CHECK(describe(topics::kNetworkFault, &fault)["target"] == "all");
  const auto truth = std::make_unique<msg::GroundTruth>();
  truth->recent_contacts()[1].second(msg::NO_ROBOT);
  CHECK(describe(topics::kTruth, truth.get())["recent_contacts"][0]["second"] == 0);
  CHECK(describe(topics::kTruth, truth.get())["recent_contacts"][1]["second"] == "none");
  msg::Counters counters;
  counters.counts().emplace_back().robot(msg::NO_ROBOT);
  CHECK(describe(topics::kCounters, &counters)["counts"][0]["robot"] == "none");
}

TEST_CASE("the README of the audit lists every drop reason") {
  std::ifstream file(SIDESTEP_IDL_DIR "/../deploy/audit/README.md");
  const std::string readme{std::istreambuf_iterator<char>(file), {}};
  for (const DropReasonInfo& info : kDropReasons) {
    const std::string row = std::string("| `") + info.name + "` | " + info.description + " | " +
                            (info.is_unusual ? "yes |" : "|");
    CAPTURE(row);
    CHECK(readme.find(row) != std::string::npos);
  }
}

TEST_CASE("a count larger than its array is shown unchanged, with the whole array") {
  msg::Proposal proposal;
  proposal.candidate_count(255);
  proposal.candidates()[0].phase_count(200);
  const Json description = describe(topics::kProposal, &proposal);
  CHECK(description["candidate_count"] == 255);
  CHECK(description["candidates"].size() == proposal.candidates().size());
  CHECK(description["candidates"][0]["phases"].size() == proposal.candidates()[0].phases().size());
  CHECK(description["candidates"][1]["phases"].empty());
}

}  // namespace sidestep::describe_test
