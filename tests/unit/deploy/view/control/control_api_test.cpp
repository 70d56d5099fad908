// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/control/control_api.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "common/config/scenario_loader.hpp"
#include "common/json/json_text.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::control_api_test {

using namespace std::chrono_literals;
using Json = nlohmann::json;

struct ControlledRun {
  Scenario scenario =
      parse_scenario("robots:\n  - {id: 3, start_m: [-2, 0]}\n  - {id: 4, start_m: [2, 1]}\n", "two.yaml");
  SimSystem system{scenario, 1};
  SimBus bus{system.network()};
  std::string bookmarks;
  std::string recordings;
  ControlApi api{bus,
                 {[this](const std::string& text) { bookmarks += text; },
                  [this](bool begins) -> std::optional<std::string> {
                    if (recordings == "full") throw std::runtime_error("the disk is full");
                    if (recordings.empty() && !begins) return std::nullopt;
                    recordings += begins ? "begin " : "end ";
                    return "a.mcap";
                  }}};
  msg::GroundTruth truth;

  ControlledRun() {
    system.observer_bus().subscribe(topics::kTruth, [this](const msg::GroundTruth& t) { truth = t; });
    system.run_for(2s);
  }
  WebResponse request(const std::string& method, const std::string& path, const std::string& body = "",
                      const std::string& refusal = "") {
    std::optional<WebResponse> response;
    if (!api.respond({method, path, {}, body, refusal},
                     [&response](WebResponse given) { response = std::move(given); }))
      return {404, "", ""};
    for (int i = 0; i < 100 && !response; ++i) system.run_for(100ms);
    return response.value();
  }
  /// The state of an order; `answer` is the one to the request that gave the order.
  Json state(const WebResponse& answer) {
    const auto order = std::to_string(parse_json(answer.body).at("order").get<int>());
    return parse_json(request("GET", "/api/orders/" + order).body);
  }
  std::string phase(const WebResponse& answer) { return state(answer).at("phase"); }
  double x_m(std::size_t index) const { return truth.robots()[index].x_m(); }
};

TEST_CASE("an HTTP request sends a robot to a place, and the state of its order can be read") {
  ControlledRun run;
  const WebResponse answer =
      run.request("POST", "/api/robots/3/order", R"({"goals": [[0, -1], [1, -1, 1.57]]})");
  REQUIRE(answer.status == 200);
  CHECK(run.phase(answer) == "sent");
  run.system.run_for(1s);
  CHECK(run.phase(answer) == "driving");
  run.system.run_for(10s);
  CHECK(run.phase(answer) == "arrived");
  CHECK(run.x_m(0) == Approx(1).margin(0.03));
}

TEST_CASE("HTTP requests hold robots, resume robots and cancel orders") {
  ControlledRun run;
  (void)run.request("POST", "/api/robots/3/order", R"({"goals": [[2, -1]]})");
  run.system.run_for(500ms);
  CHECK(run.request("POST", "/api/hold").status == 200);
  run.system.run_for(1s);
  const double held_m = run.x_m(0);
  run.system.run_for(1s);
  CHECK(run.x_m(0) == Approx(held_m).margin(0.005));
  CHECK(run.request("POST", "/api/resume").status == 200);
  run.system.run_for(1s);
  CHECK(run.x_m(0) > held_m + 0.2);
  CHECK(run.request("POST", "/api/robots/3/cancel").status == 200);
  run.system.run_for(1s);
  const double canceled_m = run.x_m(0);
  run.system.run_for(1s);
  CHECK(run.x_m(0) == Approx(canceled_m).margin(0.005));
}

TEST_CASE("HTTP requests set zones, remove zones and cause faults") {
  ControlledRun run;
  CHECK(run.phase(run.request("POST", "/api/zones/1",
                              R"({"corners": [[0, 0], [1, 0], [1, 1]], "radius_m": 0.1})")) == "sent");
  run.system.run_for(500ms);
  CHECK(run.phase(run.request("DELETE", "/api/zones/1")) == "sent");
  CHECK(run.request("POST", "/api/robots/4/fault", R"({"kind": "push", "vx_mps": 1, "vy_mps": 0})").status ==
        200);
  run.system.run_for(100ms);
  CHECK(run.x_m(1) > 2.02);
  CHECK(run.request("POST", "/api/bookmark", R"({"text": "here"})").status == 200);
  CHECK(run.bookmarks == "here");
}

TEST_CASE("an HTTP request cannot remove a zone that is not there, and is told which zones are") {
  ControlledRun run;
  const auto error = [&](const char* path) {
    const WebResponse answer = run.request("DELETE", path);
    CHECK(answer.status == 404);
    return parse_json(answer.body).value("error", "");
  };
  run.system.run_for(2s);  // coordinators tell once a second what they remember
  CHECK(error("/api/zones/1") == "remove zone 1: refused, the operator has no zone 1; there are no zones");
  (void)run.request("POST", "/api/zones/2", R"({"corners": [[0, 1]], "radius_m": 0.1})");
  run.system.run_for(2s);
  CHECK(error("/api/zones/1") ==
        "remove zone 1: refused, the operator has no zone 1; zones: 2 of the operator");
  CHECK(run.request("DELETE", "/api/zones/2").status == 200);
  run.system.run_for(3s);
  CHECK(error("/api/zones/2") == "remove zone 2: refused, the operator has no zone 2; there are no zones");
}

TEST_CASE("an HTTP request can remove a zone that was set a moment before") {
  ControlledRun run;
  (void)run.request("POST", "/api/zones/1", R"({"corners": [[0, 1]], "radius_m": 0.1})");
  CHECK(run.request("DELETE", "/api/zones/1").status == 200);
}

TEST_CASE("an HTTP request starts or stops a recording, and the answer names what is or was recorded") {
  ControlledRun run;
  const WebResponse nothing = run.request("POST", "/api/recording/stop");
  CHECK(nothing.status == 409);
  CHECK(parse_json(nothing.body).at("error") == "nothing is being recorded");
  for (const char* what : {"start", "stop"})
    CHECK(parse_json(run.request("POST", std::string("/api/recording/") + what).body).at("file") == "a.mcap");
  CHECK(run.recordings == "begin end ");
  run.recordings = "full";
  CHECK(parse_json(run.request("POST", "/api/recording/start").body).at("error") == "the disk is full");
}

TEST_CASE("the state of a refused or blocked order gives the reason") {
  ControlledRun run;
  const WebResponse nobody = run.request("POST", "/api/robots/9/order", R"({"goals": [[0, 0]]})");
  const WebResponse outside = run.request("POST", "/api/robots/3/order", R"({"goals": [[100, 0]]})");
  CHECK_FALSE(run.state(nobody).contains("reason"));
  (void)run.request("POST", "/api/zones/1", R"({"corners": [[1, 2]], "radius_m": 0.5})");
  run.system.run_for(1s);
  const WebResponse blocked = run.request("POST", "/api/robots/4/order", R"({"goals": [[1, 2]]})");
  run.system.run_for(2s);
  CHECK(run.state(nobody) == Json{{"order", run.state(nobody).at("order")},
                                  {"robot", 9},
                                  {"phase", "refused"},
                                  {"goal_index", 0},
                                  {"reason", "the scenario has no such robot"}});
  CHECK(run.phase(outside) == "refused");
  CHECK(run.state(outside).at("reason") == "a goal is outside the field");
  CHECK(run.phase(blocked) == "blocked");
  CHECK_THAT(run.state(blocked).at("reason").get<std::string>(), StartsWith("zone 1 covers its goal"));
}

TEST_CASE("an order to all robots names no number") {
  ControlledRun run;
  CHECK(run.state(run.request("POST", "/api/hold")).at("robot") == "all");
  CHECK(run.state(run.request("POST", "/api/resume")).at("robot") == "all");
  CHECK(run.state(run.request("POST", "/api/robots/3/hold")).at("robot") == 3);
}

/// The text between backticks that follows `begin` in a line; empty if there is none.
std::string quoted_after(const std::string& line, const std::string& begin) {
  const std::size_t found = line.find(begin + '`');
  if (found == std::string::npos) return {};
  const std::size_t at = found + begin.size() + 1;
  return line.substr(at, line.find('`', at) - at);
}

std::set<std::string> split_list(const std::string& text) {
  std::set<std::string> words;
  std::size_t at = 0;
  for (std::size_t comma = 0; comma != std::string::npos; at = comma + 2) {
    comma = text.find(", ", at);
    words.insert(text.substr(at, comma == std::string::npos ? comma : comma - at));
  }
  return words;
}

TEST_CASE("every request with a body that the README shows is accepted, and it shows every fault") {
  ControlledRun run;
  std::ifstream readme(SIDESTEP_SOURCE_DIR "/deploy/view/README.md");
  int requests = 0;
  std::set<std::string> faults;
  for (std::string line; std::getline(readme, line);) {
    std::string path = "/api/robots/4/fault", body;
    if (line.starts_with("| `POST /api/")) {
      path = quoted_after(line, "| ").substr(5);
      body = quoted_after(line, "body ");
      if (body.empty()) continue;
      ++requests;
    } else if (line.starts_with(R"(| `{"kind")")) {
      body = quoted_after(line, "| ");
      faults.insert(parse_json(body).at("kind").get<std::string>());
    } else {
      continue;
    }
    CAPTURE(line, path, body);
    CHECK(run.request("POST", path, body).status == 200);
  }
  CHECK(requests == 4);
  const std::string error =
      parse_json(run.request("POST", "/api/robots/4/fault", R"({"kind": "?"})").body).at("error");
  const std::string begin = "kind: expected one of: ";
  REQUIRE(error.starts_with(begin));
  CHECK(faults == split_list(error.substr(begin.size())));
}

TEST_CASE("faults that the simulator refuses are answered with the reason and a status of 4xx") {
  ControlledRun run;
  const auto check_fault = [&](const char* path, const char* body, unsigned status, const char* reason) {
    CAPTURE(body);
    const WebResponse answer = run.request("POST", path, body);
    CHECK(answer.status == status);
    CHECK(parse_json(answer.body).value("error", "") == reason);
  };
  check_fault("/api/robots/4/fault", R"({"kind": "place", "x_m": 0.5, "y_m": 2})", 409,
              "robot 4 is on the floor");
  check_fault("/api/robots/4/fault", R"({"kind": "switch on"})", 409, "robot 4 is switched on");
  check_fault("/api/robots/9/fault", R"({"kind": "lift"})", 404, "no robot 9 in this run");
  check_fault("/api/robots/4/fault", R"({"kind": "lift"})", 200, "");
  check_fault("/api/robots/4/fault", R"({"kind": "place", "x_m": 500, "y_m": 2})", 400,
              "a value is out of range, or the place is outside the field");
  check_fault("/api/robots/4/fault", R"({"kind": "push", "vx_mps": 1, "vy_mps": 0})", 409,
              "robot 4 is off the floor");
  check_fault("/api/robots/4/fault", R"({"kind": "place", "x_m": 0.5, "y_m": 2})", 200, "");
  run.system.kill("simulator");
  check_fault("/api/robots/4/fault", R"({"kind": "reboot"})", 504,
              "the simulator does not answer, so the fault may or may not have been applied");
}

TEST_CASE("a fault that is not answered yet when the control ends is answered with status 504") {
  ControlledRun run;
  SimBus bus(run.system.network());
  std::optional<ControlApi> api(std::in_place, bus, ControlHooks{});
  std::vector<WebResponse> answers;
  const WebReply reply = [&](WebResponse answer) { answers.push_back(std::move(answer)); };
  REQUIRE(api->respond({"POST", "/api/robots/3/hold", {}, "", ""}, reply));
  CHECK(answers.size() == 1);
  REQUIRE(api->respond({"POST", "/api/robots/4/fault", {}, R"({"kind": "lift"})", ""}, reply));
  CHECK(answers.size() == 1);
  api.reset();
  REQUIRE(answers.size() == 2);
  CHECK(answers[1].status == 504);
  CHECK(parse_json(answers[1].body).at("error") ==
        "the simulator does not answer, so the fault may or may not have been applied");
}

TEST_CASE("requests without the token are refused and have no effect") {
  ControlledRun run;
  for (const char* path :
       {"/api/robots/3/order", "/api/hold", "/api/zones/1", "/api/robots/3/fault", "/api/bookmark"}) {
    const WebResponse answer = run.request("POST", path, R"({"goals": [[0, 0]], "text": "x"})", "no token");
    CHECK(answer.status == 401);
    CHECK(parse_json(answer.body).at("error") == "no token");
  }
  run.system.run_for(2s);
  CHECK(run.x_m(0) == Approx(-2).margin(0.01));
  CHECK(run.bookmarks.empty());
}

TEST_CASE("invalid request bodies and paths are rejected with the reason") {
  ControlledRun run;
  const auto error = [&](const std::string& path, const std::string& body) {
    const WebResponse answer = run.request("POST", path, body);
    CHECK(answer.status >= 400);
    return parse_json(answer.body).value("error", "");
  };
  CHECK(error("/api/robots/3/order", "") ==
        "the body: expected a JSON object, nested no deeper than 16 times");
  const std::string nested = std::string(32'000, '[') + std::string(32'000, ']');
  CHECK(error("/api/robots/3/order", R"({"goals": [[1, )" + nested + "]]}") ==
        "the body: expected a JSON object, nested no deeper than 16 times");
  CHECK(error("/api/robots/3/order", "{}") == "goals: expected a list of 1 to 64 points");
  CHECK(error("/api/robots/3/order", R"({"goals": [[1]]})") == "goals[0]: expected a list of 2 or 3 numbers");
  CHECK(error("/api/robots/3/order", R"({"goals": [[0, 0], [1, "x"]]})") ==
        "goals[1][1]: expected a number from -10000 to 10000, got \"x\"");
  CHECK(error("/api/robots/3/order", R"({"goals": [[0, 1e9]]})").starts_with("goals[0][1]"));
  CHECK(error("/api/robots/3/order", R"({"goals": [[0, 0, 90]]})") ==
        "goals[0][2]: expected a heading of -6.28 to 6.28 radians, got 90; 90 degrees are 1.571 radians");
  CHECK(error("/api/robots/3/order", R"({"goals": [[0, 0, "x"]]})") ==
        "goals[0][2]: expected radians, got \"x\"");
  CHECK(error("/api/robots/3/order", R"({"goal": [[0, 0]]})") == "goal: is unknown, expected goals");
  CHECK(error("/api/robots/x/order", R"({"goals": [[0, 0]]})") == "there is no robot x");
  CHECK(error("/api/robots/-1/order", R"({"goals": [[0, 0]]})") == "there is no robot -1");
  CHECK(error("/api/robots/1024/order", R"({"goals": [[0, 0]]})") == "there is no robot 1024");
  CHECK(error("/api/robots/3/dance", "{}") == "there is no /api/robots/3/dance");
  CHECK(error("/api/zones/x", "{}") == "there is no zone x");
  CHECK(error("/api/zones/4294967296", "{}") == "there is no zone 4294967296");
  CHECK(error("/api/robots/3/fault", R"({"kind": "melt"})").starts_with("kind: expected one of: push, slip"));
  CHECK(error("/api/robots/3/fault", R"({"kind": "push"})") == "vx_mps: is missing");
  CHECK(error("/api/robots/3/fault", R"({"kind": "push", "vx_mps": 10.1, "vy_mps": 0})") ==
        "vx_mps: expected a number from -10 to 10, got 10.1");
  CHECK(error("/api/zones/1", R"({"corners": [[0, 0]], "radius": 1})") ==
        "radius: is unknown, expected corners, radius_m, speed_limit_mps");
  CHECK(error("/api/robots/3/order", R"({"goals": [[0, 0]], "speed_limit": 1})") ==
        "speed_limit: is unknown, expected goals");
  CHECK(error("/api/zones/1", R"({"corners": [], "radius_m": 1})") ==
        "corners: expected a list of 1 to 16 points");
  CHECK(error("/api/nothing", "") == "there is no /api/nothing");
  CHECK(run.request("PUT", "/api/hold").status == 405);
  CHECK(run.request("GET", "/api/orders/77").status == 404);
  CHECK(run.request("GET", "/api/orders/x").status == 404);
  CHECK(error("/api/orders/77", "") == "use GET");
  for (const char* path :
       {"/api/robots/3/order", "/api/robots/3/fault", "/api/hold", "/api/recording/start"}) {
    const WebResponse answer = run.request("GET", path);
    CHECK(answer.status == 405);
    CHECK(nlohmann::json::parse(answer.body)["error"] == "use POST");
  }
  CHECK(nlohmann::json::parse(run.request("GET", "/api/zones/1").body)["error"] == "use POST or DELETE");
  CHECK(nlohmann::json::parse(run.request("PUT", "/api/zones/1").body)["error"] == "use POST or DELETE");
  CHECK_FALSE(run.api.respond({"GET", "/api/robots/3/dance", {}, "", ""},
                              [](const WebResponse&) { FAIL_CHECK("an unknown path was answered"); }));
}

}  // namespace sidestep::control_api_test
