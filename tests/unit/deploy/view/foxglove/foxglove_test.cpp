// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>

#include "common/config/scenario_loader.hpp"
#include "common/file/temporary_folder.hpp"
#include "common/json/json_text.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "deploy/view/foxglove/foxglove_server.hpp"
#include "deploy/view/monitor/monitor.hpp"
#include "tests/catch.hpp"

namespace sidestep::foxglove_test {

using namespace std::chrono_literals;
using Json = nlohmann::json;

/// A client that remembers what it receives.
class FakeClient : public WebSocket {
 public:
  void send_state(unsigned, WebMessage message) override { received.push_back(*message.payload); }
  void send_event(WebMessage message) override { texts.push_back(parse_json(*message.payload)); }

  std::vector<std::string> received;
  std::vector<Json> texts;
};

TEST_CASE("Lichtblick's client library decodes the messages of a run by the schemas that it receives") {
  const TemporaryFolder folder;
  for (const char* name : {"package.json", "package-lock.json", "check.mjs"})
    std::filesystem::copy_file(std::string(SIDESTEP_CLIENT_DIR "/") + name, folder.file(name));
  const auto output = [&](const char* name) {
    std::ifstream file(folder.file(name));
    return std::string{std::istreambuf_iterator<char>(file), {}};
  };
  const auto run = [&](const std::string& command) {
    return std::system(("cd '" + folder.path() + "' && " + command + " >out 2>&1").c_str());
  };
  const int installed = run("npm ci --prefer-offline --no-audit --no-fund");
  INFO(output("out"));
  REQUIRE(installed == 0);

  const Scenario scenario = load_scenario(SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml");
  SimSystem system(scenario, 1);
  SimBus bus(system.network());
  bus.become_observer();
  MonitorSettings settings;
  settings.scenario = &scenario;
  Monitor monitor(bus, settings);
  FoxgloveServer foxglove;
  monitor.on_any_message([&](const AnyMessage& message) { foxglove.publish(message, bus.now()); });
  std::atomic<bool> is_over = false;
  WebServer server({"127.0.0.1", 0, {}, ""}, FoxgloveServer::protocols(),
                   {[](const WebRequest&) { return WebResponse{}; },
                    [&](WebSocket& socket, const std::string&) { foxglove.add(socket); },
                    [&](WebSocket& socket, const std::string& m, bool is_binary) {
                      return !is_binary && foxglove.on_message(socket, m);
                    },
                    [&](WebSocket& socket) { foxglove.remove(socket); }});
  int status = -1;
  std::thread client([&] {
    status = run("node check.mjs " + std::to_string(server.access().port));
    is_over = true;
  });
  while (!is_over) {
    system.run_for(5ms);
    foxglove.publish_scene(monitor.floor(), monitor.radius_m(), bus.now());
    server.run_for(5ms);
  }
  client.join();
  INFO(output("out"));
  REQUIRE(status == 0);
  const Json arrived = parse_json(output("out"));
  CHECK(arrived.size() == all_topics().size() - 1 + 2);  // no images, but scene and transforms
  for (const char* topic :
       {"world", "truth", "feedback", "command", "proposal", "verdict", "ledger", "coordinator", "status"}) {
    INFO(topic);
    CHECK(arrived.at(topic).at("messages") > 10);
  }
  CHECK(arrived.at("feedback").at("type") == "sidestep::msg::Feedback");
  CHECK(arrived.at("feedback").at("last").at("robot") < scenario.robots.size());
  CHECK(arrived.at("truth").at("last").at("robots").size() == scenario.robots.size());
  const double x_m = arrived.at("truth").at("last").at("robots")[0].at("x_m");
  CHECK(std::abs(x_m) < 4.5);
  CHECK(x_m != 0);
  // Positions of the robots in the scene and in the transforms.
  const Json& cylinders = arrived.at("scene_update").at("last").at("entities")[0].at("cylinders");
  REQUIRE(cylinders.size() == scenario.robots.size());
  CHECK(cylinders[0].at("pose").at("position").at("x") == Approx(x_m).margin(0.1));
  const Json& transforms = arrived.at("transforms").at("last").at("transforms");
  REQUIRE(transforms.size() == scenario.robots.size());
  CHECK(transforms[0].at("translation").at("x") == Approx(x_m).margin(0.1));
}

TEST_CASE("a client gets messages only from channels that it subscribes to") {
  FoxgloveServer server;
  FakeClient client;
  server.add(client);
  REQUIRE(client.texts.size() == 2);
  CHECK(client.texts[0].at("op") == "serverInfo");
  std::uint32_t feedback = 0;
  for (const Json& channel : client.texts[1].at("channels"))
    if (channel.at("topic") == "feedback") feedback = channel.at("id");
  const auto subscribe =
      json_text(Json{{"op", "subscribe"}, {"subscriptions", {{{"id", 9}, {"channelId", feedback}}}}});
  msg::Feedback message;
  const auto publish = [&] {
    server.publish({topics::kFeedback, 1, "feedback/0", message.header(), &message},
                   time_from_ns(0x0102030405060708));
    const msg::GroundTruth truth;
    server.publish({topics::kTruth, 2, "truth", truth.header(), &truth}, {});
  };
  publish();
  CHECK(client.received.empty());
  CHECK(server.on_message(client, subscribe));
  publish();
  REQUIRE(client.received.size() == 1);
  CHECK(client.received[0].substr(0, 17) ==
        std::string("\x01\x09\0\0\0\x08\x07\x06\x05\x04\x03\x02\x01\0\x01\0\0", 17));
  CHECK(server.on_message(client, R"({"op":"unsubscribe","subscriptionIds":[9]})"));
  publish();
  CHECK(client.received.size() == 1);
  server.remove(client);
  publish();
}

TEST_CASE("invalid messages from clients are rejected, and requests to publish get an error status") {
  FoxgloveServer server;
  FakeClient client;
  server.add(client);
  for (const char* bad :
       {"", "x", "[]", "{}", R"({"op":1})", R"({"op":"subscribe"})",
        R"({"op":"subscribe","subscriptions":[1]})", R"({"op":"subscribe","subscriptions":[{"id":1}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":0}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":9999}]})",
        R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})",
        R"({"op":"unsubscribe","subscriptionIds":3})"})
    CHECK_FALSE(server.on_message(client, bad));
  CHECK(server.on_message(client, R"({"op":"advertise","channels":[]})"));
  CHECK(client.texts.back().at("op") == "status");
  // The operation is quoted in the answer and truncated in the middle of a character.
  CHECK(server.on_message(client, R"({"op":")" + std::string(99, 'a') + "\u00e9\"}"));
  CHECK(client.texts.back().at("op") == "status");
}

}  // namespace sidestep::foxglove_test
