// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/monitor.hpp"

#include <cstring>
#include <nlohmann/json.hpp>

#include "common/config/scenario_loader.hpp"
#include "common/json/json_text.hpp"
#include "common/protocol/senders.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "deploy/view/monitor/floor_frame.hpp"
#include "tests/catch.hpp"

namespace sidestep::monitor_test {

using namespace std::chrono_literals;
using Json = nlohmann::json;

/// A viewer that remembers the latest message of each state, and all events.
class FakeViewer : public WebSocket {
 public:
  void send_state(unsigned slot, WebMessage message) override {
    if (message.is_binary) {
      frame = *message.payload;
      ++frames;
      return;
    }
    const Json json = parse_json(*message.payload);
    (void)slot;
    states[json.at("type")] = json;
    if (json.at("type") == "messages") inspected += json.at("messages").size();
  }
  void send_event(WebMessage message) override {
    const Json json = parse_json(*message.payload);
    if (json.at("type") == "event")
      events.push_back(json);
    else
      states[json.at("type")] = json;
  }

  double time_s() const {
    double value = 0;
    std::memcpy(&value, frame.data(), sizeof value);
    return value;
  }
  /// The value of a column in a robot's row, decoded by the layout that the scene gives.
  std::optional<double> value(RobotId robot, const std::string& column) const {
    const Json& layout = states.at("scene").at("layout");
    const std::vector<std::string> columns = layout.at("sections")[0].at("columns");
    const auto index = [&](const std::string& name) {
      return static_cast<std::size_t>(std::ranges::find(columns, name) - columns.begin());
    };
    const std::size_t head = 12 + 4 * layout.at("sections").size();
    std::uint32_t rows = 0;
    std::memcpy(&rows, frame.data() + 12, sizeof rows);
    const auto cell = [&](std::size_t row, const std::string& name) {
      float number = 0;
      std::memcpy(&number, frame.data() + head + 4 * (row * columns.size() + index(name)), sizeof number);
      return static_cast<double>(number);
    };
    for (std::size_t row = 0; row < rows; ++row)
      if (cell(row, "id") == robot) return cell(row, column);
    return std::nullopt;
  }

  std::string frame;
  int frames = 0;
  std::size_t inspected = 0;
  std::map<std::string, Json> states;
  std::vector<Json> events;
};

/// A simulated run with a monitor and one viewer.
struct MonitoredRun {
  Scenario scenario = load_scenario(SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml");
  SimSystem system{scenario, 1};
  SimBus bus{system.network()};
  Monitor monitor;
  FakeViewer viewer;
  msg::GroundTruth truth;

  explicit MonitoredRun(bool knows_scenario = true, bool is_recording = false)
      : monitor((bus.become_observer(), bus), settings(knows_scenario, is_recording)) {
    system.observer_bus().subscribe(topics::kTruth, [this](const msg::GroundTruth& t) { truth = t; });
    monitor.add_viewer(viewer);
    call_periodically(bus, Monitor::kFramePeriod, [this] {
      monitor.take_snapshot();
      monitor.update_viewers(bus.now());
    });
  }
  MonitorSettings settings(bool knows_scenario, bool is_recording) const {
    MonitorSettings result;
    result.is_recording = is_recording;
    result.scenario = knows_scenario ? &scenario : nullptr;
    result.audit.is_complete = true;
    return result;
  }
  bool send(const std::string& message) { return monitor.on_message(viewer, message, bus.now()); }
  const Json& promise() const { return viewer.states.at("panels").at("promise"); }
};

TEST_CASE("viewers get robots' positions, executed versions and the data of the panels") {
  MonitoredRun run;
  run.system.run_for(2s);
  CHECK(run.viewer.frames >= 60);
  for (const msg::TrueRobotState& robot : run.truth.robots()) {
    CHECK(*run.viewer.value(robot.robot(), "true_x") == Approx(robot.x_m()).margin(0.05));
    CHECK(*run.viewer.value(robot.robot(), "x") == Approx(robot.x_m()).margin(0.08));
    CHECK(*run.viewer.value(robot.robot(), "seen_y") == Approx(robot.y_m()).margin(0.08));
    CHECK(std::isfinite(*run.viewer.value(robot.robot(), "executing_start")));
    CHECK(std::isfinite(*run.viewer.value(robot.robot(), "granted_x")));
    CHECK(*run.viewer.value(robot.robot(), "proposed_phases") >= 0);
  }
  const Json& panels = run.viewer.states.at("panels");
  CHECK(panels.at("robots").size() == run.scenario.robots.size());
  CHECK(panels.at("robots")[0].at("proposals") > 20);
  CHECK(panels.at("coordinators")[0].at("mode") == "granting");
  std::set<std::string> topics;
  for (const Json& topic : panels.at("topics")) {
    topics.insert(topic.at("topic"));
    for (const Json& sender : topic.at("senders")) {
      CHECK(sender.at("lost") == 0);
      CHECK(sender.at("repeated") == 0);
    }
  }
  for (const char* topic : {"world", "truth", "feedback", "command", "verdict", "ledger"})
    CHECK(topics.contains(topic));
}

TEST_CASE("a viewer that sends deeply nested JSON is disconnected") {
  MonitoredRun run(false);
  const std::string nested = std::string(32'000, '[') + std::string(32'000, ']');
  CHECK_FALSE(run.send(R"({"op":"inspect","channel":)" + nested + "}"));
  CHECK_FALSE(run.send(R"({"op":)" + nested + "}"));
}

TEST_CASE("after a run without violations the lamp shows a kept guarantee and the smallest clearance") {
  MonitoredRun run;
  run.system.run_for(6s);
  CHECK(run.promise().at("state") == "kept");
  CHECK(run.promise().at("contacts") == 0);
  CHECK(run.promise().at("with_goal") == run.scenario.robots.size());
  CHECK(run.promise().at("smallest").at("clearance_m") > 0);
  CHECK(run.promise().at("smallest").at("clearance_m") < 1);
  CHECK(run.promise().at("coverage") > 0.95);
}

TEST_CASE("without a scenario the guarantee is not judged, and robots are found from their messages") {
  MonitoredRun run(false);
  run.system.run_for(3s);
  CHECK(run.promise().at("state") == "not judged");
  CHECK(run.viewer.states.at("panels").at("robots").size() == run.scenario.robots.size());
  CHECK(std::isfinite(*run.viewer.value(run.scenario.robots[0].id, "executing_start")));
}

TEST_CASE("a run that breaks the guarantee causes an event and changes the lamp") {
  MonitoredRun run;
  run.system.run_for(1s);
  // The simulator reports a contact, as if a person had carried a robot into another robot.
  msg::GroundTruth touch = run.truth;
  touch.header().message_number(touch.header().message_number() + 1'000'000);
  touch.contacts(touch.contacts() + 1);
  touch.recent_contacts()[0].first(0);
  touch.recent_contacts()[0].second(1);
  SimBus other(run.system.network());
  auto writer = other.relay(topics::kTruth, "truth");
  writer->write(&touch);
  run.system.run_for(1s);
  const auto contact =
      std::ranges::find_if(run.viewer.events, [](const Json& e) { return e["kind"] == "contact"; });
  REQUIRE(contact != run.viewer.events.end());
  CHECK(contact->at("text") == "robots 0 and 1 touch");
  CHECK(contact->at("severity") == "error");
  CHECK(run.promise().at("state") == "broken");
}

TEST_CASE("a viewer can seek back while the run continues") {
  MonitoredRun run;
  run.system.run_for(5s);
  const double end_s = run.viewer.time_s();
  CHECK(run.send(R"({"op":"seek","at_s":)" + std::to_string(end_s - 3) + "}"));
  CHECK(run.viewer.time_s() == Approx(end_s - 3).margin(0.03));
  CHECK(run.viewer.states.at("time").at("mode") == "paused");
  const double x = *run.viewer.value(0, "true_x");
  run.system.run_for(1s);
  CHECK(*run.viewer.value(0, "true_x") == x);
  const double shown_s = run.viewer.time_s();
  CHECK(run.send(R"({"op":"step","frames":1})"));
  CHECK(run.viewer.time_s() == Approx(shown_s + 0.025).margin(0.001));
  CHECK(run.send(R"({"op":"play","speed":2})"));
  run.system.run_for(1s);
  CHECK(run.viewer.time_s() == Approx(shown_s + 2).margin(0.1));
  CHECK(run.send(R"({"op":"pause"})"));
  CHECK(run.send(R"({"op":"live"})"));
  run.system.run_for(100ms);
  CHECK(run.viewer.time_s() == Approx(end_s + 2.1).margin(0.1));
}

TEST_CASE("a recording opens at its first granted moment, beside the verdict on the whole of it") {
  MonitoredRun run(true, true);
  run.system.run_for(6s);
  const Json& time = run.viewer.states.at("time");
  CHECK(time.at("mode") == "paused");
  const double first_grant_s = time.at("first_grant_s");
  CHECK(first_grant_s > time.at("begin_s"));
  CHECK(first_grant_s < time.at("begin_s").get<double>() + 3);
  CHECK(run.viewer.time_s() == first_grant_s);
  const auto is_granted = [&](const RobotSpec& robot) {
    const auto x_m = run.viewer.value(robot.id, "granted_x");
    return x_m && std::isfinite(*x_m);
  };
  CHECK(std::ranges::any_of(run.scenario.robots, is_granted));
  // The panels are of this moment too, but the verdict is on all that was read.
  CHECK(run.viewer.states.at("panels").at("at_s") == first_grant_s);
  const double judged_s = run.promise().at("run_s");
  CHECK(judged_s < 1);
  CHECK(run.viewer.states.at("whole").at("is_over") == false);
  run.monitor.set_progress(1);
  run.monitor.take_last_snapshot();
  run.monitor.update_viewers(run.bus.now());
  CHECK(run.viewer.states.at("whole").at("is_over") == true);
  CHECK(run.viewer.states.at("whole").at("promise").at("state") == "kept");
  CHECK(run.viewer.states.at("whole").at("promise").at("run_s") > 3);
  CHECK(run.promise().at("run_s") == judged_s);
  // From there, it plays.
  CHECK(run.send(R"({"op":"play","speed":1})"));
  run.system.run_for(1s);
  CHECK(run.viewer.time_s() == Approx(first_grant_s + 1).margin(0.1));
}

TEST_CASE("a recording without a grant opens at its start") {
  const Time begin = time_from_ns(5'000'000'000);
  SimNetwork network(1, begin, {});
  SimBus bus(network);
  MonitorSettings settings;
  settings.is_recording = true;
  Monitor monitor(bus, settings);
  FakeViewer viewer;
  monitor.add_viewer(viewer);
  for (int i = 0; i <= 40; ++i) {
    network.run_until(begin + i * Monitor::kFramePeriod);
    monitor.set_progress(i / 40.0);
    monitor.take_snapshot();
    monitor.update_viewers(network.now());
  }
  const Json& time = viewer.states.at("time");
  CHECK(time.at("first_grant_s").is_null());
  CHECK(time.at("mode") == "paused");
  CHECK(time.at("end_s") == 6);
  CHECK(viewer.time_s() == 5);
}

TEST_CASE("a viewer's choice of a moment replaces the first granted one") {
  MonitoredRun run(true, true);
  run.system.run_for(100ms);
  CHECK(run.send(R"({"op":"live"})"));
  run.system.run_for(6s);
  CHECK(run.viewer.states.at("time").at("mode") == "live");
  CHECK(run.viewer.time_s() > run.viewer.states.at("time").at("first_grant_s").get<double>() + 2);
}

TEST_CASE("an epoch that JavaScript would round reaches the page exactly") {
  MonitoredRun run(false);
  msg::CoordinatorState state;
  state.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator) + 1);
  state.coordinator(1);
  state.epoch(9'007'199'254'740'993);
  SimBus other(run.system.network());
  const auto writer = other.relay(topics::kCoordinator, "coordinator");
  writer->write(&state);
  run.system.run_for(1s);
  const Json& coordinators = run.viewer.states.at("panels").at("coordinators");
  const auto found = std::ranges::find_if(coordinators, [](const Json& c) { return c.at("number") == 1; });
  REQUIRE(found != coordinators.end());
  CHECK(found->at("epoch") == "9007199254740993");
}

TEST_CASE("a run that has ended is shown as a recording") {
  MonitoredRun run;
  run.system.run_for(6s);
  const double end_s = run.viewer.time_s();
  CHECK(run.viewer.states.at("scene").at("has_messages") == true);
  run.monitor.end();
  run.monitor.update_viewers(run.bus.now());
  CHECK(run.viewer.states.at("scene").at("is_recording") == true);
  CHECK(run.viewer.states.at("scene").at("can_command") == false);
  CHECK(run.viewer.states.at("scene").at("has_messages") == false);
  CHECK(run.viewer.states.at("whole").at("is_over") == true);
  CHECK(run.viewer.events.back().at("text") == "the run is over");
  CHECK(run.promise().at("state") == "kept");
  CHECK(run.viewer.time_s() == Approx(end_s).margin(0.05));
  FakeViewer late;
  run.monitor.add_viewer(late);
  run.monitor.update_viewers(run.bus.now());
  CHECK(late.states.at("time").at("mode") == "paused");
  CHECK(late.time_s() == late.states.at("time").at("first_grant_s"));
  CHECK(late.states.at("whole").at("promise").at("state") == "kept");
}

TEST_CASE("a viewer gets all messages of the channel that it inspects and no other messages") {
  MonitoredRun run;
  run.system.run_for(500ms);
  CHECK(run.viewer.inspected == 0);
  std::size_t reports = 0;
  run.system.observer_bus().subscribe(topics::kFeedback, RobotId{0},
                                      [&](const msg::Feedback&) { ++reports; });
  CHECK(run.send(R"({"op":"inspect","channel":"feedback/0"})"));
  run.system.run_for(2s);
  const Json& batch = run.viewer.states.at("messages");
  CHECK(batch.at("channel") == "feedback/0");
  CHECK(batch.at("messages")[0].at("message").at("robot") == 0);
  // The last ones may not have been shown yet.
  CHECK(run.viewer.inspected <= reports);
  CHECK(run.viewer.inspected + 5 > reports);
  CHECK(reports > 100);
  CHECK(run.send(R"({"op":"inspect","channel":null})"));
  const std::size_t before = run.viewer.inspected;
  run.system.run_for(500ms);
  CHECK(run.viewer.inspected == before);
}

TEST_CASE("invalid messages from viewers are rejected") {
  MonitoredRun run;
  run.system.run_for(500ms);
  for (const char* bad :
       {"", "x", "[]", "{}", "3", R"({"op":3})", R"({"op":"fly"})", R"({"op":"seek"})",
        R"({"op":"seek","at_s":"1"})", R"({"op":"seek","at_s":1e300})", R"({"op":"play"})",
        R"({"op":"play","speed":0})", R"({"op":"play","speed":1e9})", R"({"op":"step","frames":1e9})",
        R"({"op":"inspect","channel":"secret"})", R"({"op":"inspect","channel":[1]})", "\xff\xfe"})
    CHECK_FALSE(run.send(bad));
}

TEST_CASE("the trails before any moment of the history are where the robots were") {
  MonitoredRun run;
  std::map<std::int64_t, msg::GroundTruth> truths;
  call_periodically(run.bus, 100ms, [&] { truths[to_ns(run.bus.now())] = run.truth; });
  run.system.run_for(12s);
  const auto trails_at = [&](double at_s) {
    return parse_json(
               run.monitor.respond({"GET", "/api/trails", {{"at_s", std::to_string(at_s)}}, "", ""})->body)
        .at("robots");
  };
  const double end_s = run.viewer.time_s();
  for (const double at_s : {end_s, end_s - 4, end_s - 100, end_s + 100}) {
    const Json trails = trails_at(at_s);
    REQUIRE(trails.size() == run.scenario.robots.size());
    const double last_s = std::clamp(at_s, end_s - 12, end_s);
    for (const Json& trail : trails) {
      double previous_s = 0;
      for (const Json& point : trail.at("points")) {
        const double point_s = point[0];
        CHECK(point_s > previous_s);
        CHECK(point_s >= last_s - 5.1);
        CHECK(point_s <= last_s + 0.1);
        previous_s = point_s;
        const auto truth = truths.lower_bound(std::llround(point_s * 1e9));
        if (truth == truths.begin() || truth == truths.end()) continue;
        for (const msg::TrueRobotState& robot : truth->second.robots())
          if (robot.robot() == trail.at("id"))
            CHECK(std::hypot(robot.x_m() - point[1].get<double>(), robot.y_m() - point[2].get<double>()) <
                  0.3);
      }
    }
  }
  CHECK(trails_at(end_s)[0].at("points").size() >= 45);
  for (const char* bad : {"", "x", "1e300", "nan", "1 "})
    CHECK(run.monitor.respond({"GET", "/api/trails", {{"at_s", bad}}, "", ""})->status == 400);
  CHECK(run.monitor.respond({"GET", "/api/trails", {}, "", ""})->status == 400);
}

TEST_CASE("before the first frame there are no trails") {
  MonitoredRun run;
  CHECK(run.monitor.respond({"GET", "/api/trails", {{"at_s", "1"}}, "", ""})->body == R"({"robots":[]})");
}

TEST_CASE("the state, the events and the scene are available over HTTP") {
  MonitoredRun run;
  run.system.run_for(6s);
  const auto get = [&](const std::string& path, std::map<std::string, std::string> query = {}) {
    return run.monitor.respond({"GET", path, std::move(query), "", ""});
  };
  CHECK(parse_json(get("/api/state")->body).at("robots").size() == run.scenario.robots.size());
  CHECK(parse_json(get("/api/scene")->body).at("radius_m") == run.scenario.radius_m);
  const Json events = parse_json(get("/api/events")->body);
  REQUIRE(events.size() >= 3);
  CHECK(parse_json(get("/api/events", {{"since", std::to_string(events.size() - 1)}})->body).size() == 1);
  CHECK(get("/api/events", {{"since", "x"}})->status == 400);
  CHECK_FALSE(get("/api/map"));
  CHECK_FALSE(get("/api/nothing"));
  CHECK_FALSE(run.monitor.respond({"POST", "/api/state", {}, "", ""}));
}

}  // namespace sidestep::monitor_test
