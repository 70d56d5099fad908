// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor_server.hpp"

#include <atomic>
#include <chrono>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <thread>

#include "common/config/scenario_loader.hpp"
#include "common/json/json_text.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"
#include "tests/unit/deploy/view/server/web_client.hpp"

namespace sidestep::monitor_server_test {

using namespace std::chrono_literals;
using Json = nlohmann::json;

/// A simulated run with a server whose viewers may command with this token; empty: none may.
struct ServedRun {
  Scenario scenario = load_scenario(SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml");
  SimSystem system{scenario, 1};
  SimBus bus{system.network()}, client_bus{system.network()};
  Monitor monitor{(bus.become_observer(), bus), {&scenario, {}, false, true, {}}};
  ControlApi control{client_bus, {}};
  MonitorServer server;

  explicit ServedRun(const std::string& token = "secret")
      : server(AccessSettings{"127.0.0.1", 0, {}, token}, monitor, {token.empty() ? nullptr : &control}) {
    system.run_for(1s);
    monitor.take_snapshot();
  }
  HttpAnswer request(const std::string& method, const std::string& path, const std::string& token) {
    HttpAnswer answer;
    std::atomic<bool> is_answered = false;
    std::thread viewer([&] {
      answer =
          http_request(server.server().access().port, method, path, {{"Authorization", "Bearer " + token}});
      is_answered = true;
    });
    while (!is_answered) server.server().run_for(2ms);
    viewer.join();
    return answer;
  }
  static std::string error(const HttpAnswer& answer) {
    return parse_json(answer.body, false).value("error", answer.body);
  }
};

TEST_CASE("the monitor's server answers errors of its API in JSON") {
  ServedRun run;
  CHECK(run.request("GET", "/api/nothing", "").status == 404);
  CHECK(run.error(run.request("GET", "/api/nothing", "")) == "there is no /api/nothing");
  CHECK(run.request("POST", "/api/hold", "wrong").status == 401);
  CHECK_THAT(run.error(run.request("POST", "/api/hold", "wrong")), StartsWith("the header 'Authorization"));
}

TEST_CASE("without control, every request that needs it is told so, whatever its method") {
  ServedRun run("");
  for (const auto& [method, path] :
       {std::pair("POST", "/api/hold"), std::pair("GET", "/api/hold"), std::pair("GET", "/api/zones/1"),
        std::pair("GET", "/api/robots/3/order"), std::pair("GET", "/api/orders/1")}) {
    CAPTURE(method, path);
    const HttpAnswer answer = run.request(method, path, "");
    CHECK(answer.status == 401);
    CHECK(run.error(answer) == "this monitor refuses commands; start it with --control");
  }
  CHECK(run.request("GET", "/api/robots/3/dance", "").status == 404);
}

TEST_CASE("whatever the monitor's page names is served, and it names an icon") {
  ServedRun run;
  const std::string page = run.request("GET", "/", "").body;
  CHECK_THAT(page, ContainsSubstring("rel=\"icon\""));
  const std::regex reference("(?:href|src)=\"(/[^\"]*)\"");
  int references = 0;
  for (std::sregex_iterator i(page.begin(), page.end(), reference), end; i != end; ++i, ++references) {
    const std::string path = (*i)[1];
    CAPTURE(path);
    CHECK(run.request("GET", path, "").status == 200);
  }
  CHECK(references >= 3);
}

TEST_CASE("when the run is over, its page still shows it, but commands are refused") {
  ServedRun run;
  REQUIRE(run.request("POST", "/api/hold", "secret").status == 200);
  run.server.end_run();
  const HttpAnswer refused = run.request("POST", "/api/hold", "secret");
  CHECK(refused.status == 409);
  CHECK(run.error(refused) == "the run is over");
  CHECK(run.request("POST", "/api/hold", "wrong").status == 401);
  CHECK(run.error(run.request("GET", "/api/orders/1", "")) == "the run is over");
  CHECK(run.error(run.request("GET", "/api/hold", "")) == "the run is over");
  CHECK(run.request("GET", "/", "").status == 200);
  const Json scene = parse_json(run.request("GET", "/api/scene", "").body);
  CHECK(scene.at("is_recording") == true);
  CHECK(scene.at("can_command") == false);
  CHECK(parse_json(run.request("GET", "/api/state", "").body).at("robots").size() ==
        run.scenario.robots.size());
}

}  // namespace sidestep::monitor_server_test
