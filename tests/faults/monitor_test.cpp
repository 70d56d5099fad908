// SPDX-License-Identifier: Apache-2.0
// The monitor with real processes and a real browser.
#include <arpa/inet.h>
#include <atomic>
#include <fmt/format.h>
#include <fstream>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <signal.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include "common/config/scenario_loader.hpp"
#include "common/file/temporary_folder.hpp"
#include "common/messaging/senders.hpp"
#include "tests/catch.hpp"
#include "tests/faults/browser.hpp"
#include "tests/faults/launched_run.hpp"
#include "tests/faults/process_usage.hpp"
#include "tests/unit/deploy/monitor/server/web_client.hpp"

namespace sidestep::monitor_faults_test {

using namespace std::chrono_literals;
using Json = nlohmann::json;

/// A monitor beside a run.
struct MonitorProcess {
  LaunchedRun& run;
  std::string name;
  std::uint16_t port = 0;
  std::string token;
  pid_t pid = 0;

  MonitorProcess(LaunchedRun& launched, const std::vector<std::string>& extra = {},
                 std::uint16_t wanted_port = 0, const std::string& process_name = "monitor")
      : run(launched), name(process_name) {
    std::vector<std::string> arguments{"monitor", run.scenario_file(), "--port", std::to_string(wanted_port)};
    for (const std::string& argument : run.dds_arguments()) arguments.push_back(argument);
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    pid = run.start(name, "sidestep", arguments);
    const std::string begin = name + ": monitor: http://127.0.0.1:";
    REQUIRE(run.wait_until([&] { return run.printed(begin); }));
    std::string line = run.output().substr(run.output().rfind(begin) + begin.size());
    line.resize(line.find('\n'));
    port = static_cast<std::uint16_t>(std::stoi(line));
    const std::size_t hash = line.find("#token=");
    if (hash != std::string::npos) token = line.substr(hash + 7);
  }
  std::string url() const {
    return fmt::format("http://127.0.0.1:{}/{}", port, token.empty() ? "" : "#token=" + token);
  }
  Json state() const { return Json::parse(http_request(port, "GET", "/api/state").body); }
};

/// Keeps the bus of the run from falling behind while a browser is waited for.
std::function<void()> polling(LaunchedRun& run) {
  return [&run] { (void)run.wait_until([] { return true; }); };
}

/// Robots that wait for orders, with two coordinators.
const std::string kWaitingRobots =
    "coordinators: 2\nrobots:\n  - {id: 0, start_m: [-2, 0]}\n  - {id: 1, start_m: [2, 0.5]}\n  - {id: 2, "
    "start_m: [0, 2]}\n";

TEST_CASE("the page shows a run and gives orders to its robots", "[both-cores]") {
  LaunchedRun run(kWaitingRobots);
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  const MonitorProcess monitor(run, {"--control"});
  Browser page;
  page.open(monitor.url());
  REQUIRE(page.wait_until("window.monitor && monitor.panels && monitor.panels.promise.state === 'kept'"));
  CHECK(page.text("lamp-text") == "promise kept");
  CHECK(page.text("connection") == "connected");

  // Where robots are, as ground truth says.
  REQUIRE(page.wait_until("monitor.frame.sections.robots.rows === 3"));
  (void)run.wait_until([&] { return run.truth().robots().size() == 3; });
  for (const msg::TrueRobotState& robot : run.truth().robots()) {
    const Json place = page.run(fmt::format(
        "const s = monitor.frame.sections.robots, c = monitor.scene.layout.columns.robots; return "
        "[s.values[{0} * s.stride + c.true_x], s.values[{0} * s.stride + c.true_y]]",
        robot.robot()));
    CHECK(place[0].get<double>() == Approx(robot.x_m()).margin(0.01));
    CHECK(place[1].get<double>() == Approx(robot.y_m()).margin(0.01));
  }

  // The panels.
  CHECK(page.run("return document.querySelectorAll('#panel-robots tbody tr').length") == 3);
  page.click("tab-coordinators");
  CHECK(page.wait_until("document.querySelector('#panel-coordinators').textContent.includes('granting')"));
  CHECK(page.wait_until("document.querySelector('#panel-coordinators').textContent.includes('standby')"));
  page.click("tab-topics");
  for (const char* topic : {"world", "feedback", "command", "ledger", "truth"})
    CHECK(page.wait_until(fmt::format("document.querySelector('#panel-topics [data-key=\"{}\"]')", topic)));
  page.click("tab-inspect");
  page.run(
      "const c = document.getElementById('inspected'); c.value = 'feedback/1'; c.dispatchEvent(new "
      "Event('change'))");
  CHECK(page.wait_until(
      "document.getElementById('inspected-message').textContent.includes('\"tracking_error_m\"')"));
  page.run(
      "const p = document.getElementById('plotted'); p.value = 'x_m'; p.dispatchEvent(new Event('change'))");

  // An order by drag and drop, and one by HTTP.
  page.click("tab-control");
  page.run(R"(
    const canvas = document.getElementById('floor'), box = canvas.getBoundingClientRect();
    const scale = Math.min(canvas.clientWidth / 10, canvas.clientHeight / 7);
    const at = (x, y) => ({clientX: box.x + box.width / 2 + x * scale, clientY: box.y + box.height / 2 - y * scale, pointerId: 1, bubbles: true});
    canvas.setPointerCapture = () => {};
    canvas.dispatchEvent(new PointerEvent('pointerdown', at(-2, 0)));
    canvas.dispatchEvent(new PointerEvent('pointermove', at(-1, -1)));
    canvas.dispatchEvent(new PointerEvent('pointerup', at(-1, -1)));)");
  CHECK(page.wait_until(
      "document.getElementById('command-result').textContent === '/api/robots/0/order: sent'"));
  CHECK(http_request(monitor.port, "POST", "/api/robots/1/order", {}, R"({"goals": [[3, 1]]})").status ==
        401);
  CHECK(http_request(monitor.port, "POST", "/api/robots/1/order",
                     {{"Authorization", "Bearer " + monitor.token}}, R"({"goals": [[3, 1]]})")
            .status == 200);
  const auto is_at = [&](RobotId robot, double x_m, double y_m) {
    for (const msg::TrueRobotState& r : run.truth().robots())
      if (r.robot() == robot) return std::hypot(r.x_m() - x_m, r.y_m() - y_m) < 0.05;
    return false;
  };
  CHECK(run.wait_until([&] { return is_at(0, -1, -1) && is_at(1, 3, 1); }));
  page.click("tab-topics");
  for (const char* topic : {"proposal", "verdict"})
    CHECK(page.wait_until(fmt::format("document.querySelector('#panel-topics [data-key=\"{}\"]')", topic)));
  page.click("command-hold-all");
  CHECK(page.wait_until("monitor.events.filter((e) => e.kind === 'hold').length === 3", polling(run)));

  // Each order is an event. Each key has a meaning, and what the page asks for is allowed.
  CHECK(page.wait_until("monitor.events.some((e) => e.text === 'operator sends robot 0 to a goal')"));
  for (const char* key : {"1", "2", "m", "t", "f", "[", "]", ",", ".", "l"}) page.press(key);
  CHECK(page.complaints() == "");
}

TEST_CASE("the page shows how a coordinator dies and another takes over, and connects again to a monitor",
          "[both-cores]") {
  LaunchedRun run(kWaitingRobots);
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  auto monitor = std::make_unique<MonitorProcess>(run);
  Browser page;
  page.open(monitor->url());
  REQUIRE(page.wait_until("window.monitor && monitor.panels && monitor.panels.coordinators.length === 2"));
  const Json granting =
      page.run("return monitor.panels.coordinators.find((c) => c.mode === 'granting').name");
  const pid_t pid = run.pid_of(granting);
  REQUIRE(pid > 0);
  REQUIRE(kill(pid, SIGKILL) == 0);
  CHECK(page.wait_until(
      fmt::format("monitor.events.some((e) => e.kind === 'silent' && e.text === '{} is silent')",
                  granting.get<std::string>()),
      polling(run)));
  CHECK(page.wait_until(
      "monitor.events.some((e) => e.kind === 'epoch' && e.text.includes('no heartbeat of coordinator'))"));
  CHECK(page.wait_until(
      "monitor.panels.coordinators.filter((c) => c.mode === 'granting' && c.age_s < 1).length === 1"));

  // Without --control nothing commands.
  CHECK(page.run("return document.getElementById('tab-control')").is_null());
  CHECK(http_request(monitor->port, "POST", "/api/hold", {{"Authorization", "Bearer "}}).status == 401);

  const std::uint16_t port = monitor->port;
  REQUIRE(kill(monitor->pid, SIGINT) == 0);
  CHECK(page.wait_until("monitor.connection === 'lost'", polling(run)));
  CHECK(run.wait_until([&] { return run.exit_reason("monitor").has_value(); }));
  CHECK(*run.exit_reason("monitor") == "exit code 0");
  monitor = std::make_unique<MonitorProcess>(run, std::vector<std::string>{}, port, "monitor again");
  CHECK(page.wait_until("monitor.connection === 'connected' && monitor.panels.robots.length === 3",
                        polling(run)));
}

/// Seeks back by this time while the run goes on.
void seek_back(double back_s) {
  LaunchedRun run(kWaitingRobots);
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  const MonitorProcess monitor(run);
  SocketClient viewer(monitor.port);
  double begin_s = 0, end_s = 0;
  const auto receive_frame = [&]() -> double {
    for (;;) {
      const auto message = viewer.receive();
      REQUIRE(message);
      if (message->is_binary) {
        double time_s = 0;
        std::memcpy(&time_s, message->text.data(), sizeof time_s);
        return time_s;
      }
      const Json json = Json::parse(message->text);
      if (json.at("type") != "time") continue;
      begin_s = json.at("begin_s");
      end_s = json.at("end_s");
    }
  };
  int frames = 0;
  const double first_s = receive_frame();
  double last_s = first_s;
  while (last_s < first_s + back_s + 1) {
    last_s = receive_frame();
    ++frames;
  }
  CHECK(frames >= (back_s + 1) * 30);
  std::vector<double> delays_ms;
  for (int i = 0; i < 20; ++i) {
    const double wanted_s = first_s + 0.05 * i;
    const auto asked = std::chrono::steady_clock::now();
    viewer.send(fmt::format(R"({{"op":"seek","at_s":{:.6f}}})", wanted_s));
    while (std::abs(receive_frame() - wanted_s) > 0.06) {
    }
    delays_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - asked).count());
  }
  std::ranges::sort(delays_ms);
  WARN(fmt::format("{} frames in {} s; seek {} s back: median {:.1f} ms, longest {:.1f} ms", frames,
                   back_s + 1, back_s, delays_ms[10], delays_ms.back()));
  CHECK(begin_s <= first_s + 0.1);
  CHECK(end_s >= last_s - 0.2);
  CHECK(delays_ms.back() < 200);
}

TEST_CASE("a viewer seeks back while the run goes on", "[both-cores]") { seek_back(5); }

TEST_CASE("a viewer seeks 60 seconds back while the run goes on", "[.][figures]") { seek_back(60); }

/// A simulated run that was recorded, and a monitor that shows it.
class ShownRecording {
 public:
  ShownRecording(const std::string& scenario, const std::vector<std::string>& extra = {})
      : group_(folder_.file("log")) {
    const std::string program = sibling_program_path("sidestep"), recording = folder_.file("run.mcap");
    std::vector<std::string> simulate{program,
                                      "simulate",
                                      SIDESTEP_SOURCE_DIR "/deploy/scenarios/" + scenario,
                                      "--record",
                                      recording,
                                      "--report",
                                      folder_.file("report.json")};
    simulate.insert(simulate.end(), extra.begin(), extra.end());
    group_.start({"simulate", simulate, false});
    bool is_recorded = false;
    for (int i = 0; i < 5000 && !is_recorded; ++i) is_recorded = !group_.poll(20ms).empty();
    REQUIRE(is_recorded);
    group_.start({"monitor", {program, "monitor", recording, "--port", "0"}, false});
    std::string line;
    for (int i = 0; i < 500 && line.find("http://") == std::string::npos; ++i) {
      (void)group_.poll(20ms);
      std::ifstream log(folder_.file("log"));
      while (std::getline(log, line) && line.find("http://") == std::string::npos) {
      }
    }
    url_ = line.substr(line.find("http://"));
  }
  const std::string& url() const { return url_; }
  void end() { CHECK(group_.terminate(5s).empty()); }

 private:
  TemporaryFolder folder_;
  ProcessGroup group_;
  std::string url_;
};

TEST_CASE("the page shows a recording, and a moment by its link") {
  ShownRecording recording("crossing.yaml");
  Browser page;
  page.open(recording.url());
  REQUIRE(page.wait_until(
      "window.monitor && monitor.frame && document.getElementById('clock').textContent.startsWith('00:')"));
  page.click("live");
  REQUIRE(page.wait_until("monitor.panels.promise.state === 'kept'"));
  CHECK(page.run("return monitor.panels.promise.contacts") == 0);
  CHECK(page.run("return monitor.events.filter((e) => e.kind === 'arrived').length") ==
        page.run("return monitor.panels.robots.length"));
  const Json at_s = page.run("return monitor.events.find((e) => e.kind === 'arrived').at_s");
  page.press("]");
  page.press("[");
  page.open("about:blank");
  page.open(fmt::format("{}#t={:.3f}", recording.url(), at_s.get<double>()));
  CHECK(page.wait_until(
      fmt::format("window.monitor && monitor.frame && Math.abs(monitor.frame.time - {:.3f}) < 0.05",
                  at_s.get<double>())));
  // Messages of the moment that is shown.
  page.click("tab-inspect");
  page.run(
      "const c = document.getElementById('inspected'); c.value = 'feedback/0'; c.dispatchEvent(new "
      "Event('change'))");
  const std::string message = "JSON.parse(document.getElementById('inspected-message').textContent || '{}')";
  CHECK(page.wait_until(
      fmt::format("Math.abs({}.header?.stamp_ns * 1e-9 - {:.3f}) < 0.1", message, at_s.get<double>())));
  page.click("step-back");
  page.run(
      "document.getElementById('time').value = 1.5; document.getElementById('time').dispatchEvent(new "
      "Event('input'))");
  CHECK(
      page.wait_until(fmt::format("Math.abs({}.header?.stamp_ns * 1e-9 - monitor.frame.time) < 0.1 && "
                                  "monitor.frame.time < {:.3f}",
                                  message, at_s.get<double>())));
  CHECK(page.complaints() == "");

  // The floor is drawn also when nothing moves, and after it was resized and moved.
  const std::string drawn =
      "(() => { const c = document.getElementById('floor'); return c.getContext('2d').getImageData(0, 0, "
      "c.width, "
      "c.height).data.some((v) => v > 0); })()";
  CHECK(page.wait_until(drawn));
  page.run("document.getElementById('side').hidden = true");
  CHECK(page.wait_until("document.getElementById('floor').clientWidth > 1000 && " + drawn));
  page.run("document.getElementById('floor').dispatchEvent(new WheelEvent('wheel', {deltaY: 50}))");
  CHECK(page.wait_until(drawn));
  page.run("document.getElementById('side').hidden = false");
  recording.end();
}

TEST_CASE("a roadmap adapts while obstacles are dragged on the page") {
  ShownRecording recording("crossing.yaml", {"--seconds", "1"});
  Browser page;
  page.open(recording.url() + "planning.html");
  REQUIRE(page.wait_until("window.planning && planning.plan && planning.plan.nodes.length > 100"));
  for (const auto& [planner, y_m] : {std::pair{"dynamic-prm", 0}, std::pair{"errt", 1}}) {
    page.run(fmt::format(
        "const p = document.getElementById('planner'); p.value = '{}'; p.dispatchEvent(new Event('change'))",
        planner));
    REQUIRE(page.wait_until(fmt::format("planning.plan.planner === '{}'", planner)));
    // Drags obstacle 0 along the floor, in 30 steps.
    page.run(fmt::format("const y_m = {};", y_m) + R"(
      const canvas = document.getElementById('floor'), box = canvas.getBoundingClientRect(), plan = planning.plan;
      canvas.setPointerCapture = () => {};
      const scale = Math.min(canvas.clientWidth / (plan.field[0] + 0.4), canvas.clientHeight / (plan.field[1] + 0.4));
      const event = (type, x, y) => canvas.dispatchEvent(new PointerEvent(type, {clientX: box.x + box.width / 2 + x * scale,
          clientY: box.y + box.height / 2 - y * scale, pointerId: 1, bubbles: true}));
      planning.before = planning.plans;
      const [x, y] = plan.obstacles[0];
      event('pointerdown', x, y);
      let step = 0;
      const timer = setInterval(() => {
        if (++step <= 30) return event('pointermove', -3 + 0.2 * step, y_m);
        event('pointerup', 3, y_m);
        clearInterval(timer);
      }, 10);)");
    CHECK(page.wait_until(fmt::format(
        "Math.hypot(planning.plan.obstacles[0][0] - 3, planning.plan.obstacles[0][1] - {}) < 0.05", y_m)));
    CHECK(page.run("return planning.plans - planning.before") >= 5);
  }
  page.click("next");
  CHECK(page.wait_until("Math.abs(planning.plan.obstacles[0][0] - 3) > 0.05"));
  CHECK(page.complaints() == "");
  recording.end();
}

TEST_CASE("the page draws 22 robots with all layers and 1,000 robots", "[both-cores]") {
  for (const char* scenario : {"two-teams-22.yaml", "streams-1000.yaml"}) {
    ShownRecording recording(scenario, {"--seconds", "3"});
    Browser page;
    page.open(recording.url());
    REQUIRE(page.wait_until(
        "window.monitor && monitor.scene && monitor.panels && monitor.panels.promise.cycles > 0 || "
        "window.monitor && monitor.scene && (document.getElementById('live').click(), false)"));
    page.run("for (const box of document.querySelectorAll('#layers input')) if (!box.checked) box.click()");
    // Played again and again, from a third on.
    page.run(
        "document.getElementById('time').value = document.getElementById('time').max / 3; "
        "document.getElementById('time').dispatchEvent(new Event('input'));");
    REQUIRE(page.wait_until("document.getElementById('clock').textContent.includes('paused')"));
    page.run(
        "monitor.script_ms.length = 0; document.getElementById('speed').value = '0.25'; "
        "document.getElementById('play').click()");
    REQUIRE(page.wait_until("monitor.script_ms.length >= 40"));
    const Json figures = page.run(
        "const s = monitor.script_ms.slice().sort((a, b) => a - b); return [s.length, s[s.length >> 1], "
        "s[Math.floor(s.length * "
        "0.99)], monitor.frame.sections.robots.rows]");
    WARN(fmt::format(
        "{}: {} robots, all layers: script per frame median {:.1f} ms, p99 {:.1f} ms of {} frames", scenario,
        figures[3].get<int>(), figures[1].get<double>(), figures[2].get<double>(), figures[0].get<int>()));
    CHECK(figures[3] == page.run("return monitor.scene.robots.length"));
    CHECK(page.complaints() == "");
  }
}

/// The scenario two-teams-22, whose teams change sides again and again.
std::string two_teams_for(int changes) {
  const Scenario scenario = load_scenario(SIDESTEP_SOURCE_DIR "/deploy/scenarios/two-teams-22.yaml");
  std::string text =
      "field: {length_m: 12, width_m: 9}\ntime_limit_s: 3000\nvision: {columns: 2, rows: 2}\nball: "
      "{position_m: [0, 0]}\nrobots:\n";
  for (const RobotSpec& robot : scenario.robots) {
    const Vec2 goal = robot.goals.at(0).position_m, start = robot.start_m;
    text += fmt::format("  - {{id: {}, team: {}, start_m: [{}, {}], heading_rad: {}, goals_m: [", robot.id,
                        robot.team == Team::kBlue ? "blue" : "yellow", start.x(), start.y(),
                        robot.start_heading_rad);
    for (int i = 0; i < changes; ++i) {
      const Vec2& next = i % 2 ? start : goal;
      text += fmt::format("{}[{}, {}]", i > 0 ? ", " : "", next.x(), next.y());
    }
    text += "]}\n";
  }
  return text;
}

/// A viewer that counts what it gets, in a thread of its own.
class CountingViewer {
 public:
  explicit CountingViewer(std::uint16_t port)
      : thread_([this, port] {
          SocketClient viewer(port);
          while (!is_over_ && viewer.is_connected()) {
            const auto message = viewer.receive(100ms);
            if (message && message->is_binary) ++frames_;
          }
        }) {}
  ~CountingViewer() {
    is_over_ = true;
    thread_.join();
  }
  int frames() const { return frames_; }

 private:
  std::atomic<bool> is_over_ = false;
  std::atomic<int> frames_ = 0;
  std::thread thread_;
};

TEST_CASE("a run shows itself in the browser, and goes on without the monitor") {
  // Any free port: that of a monitor which has just ended.
  std::uint16_t port = 0;
  {
    LaunchedRun first(kWaitingRobots);
    port = MonitorProcess(first).port;
  }
  LaunchedRun run(kWaitingRobots, {fmt::format("--monitor={}", port), "--seconds", "4"});
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  CHECK(Json::parse(http_request(port, "GET", "/api/state").body).at("robots").size() == 3);
  CHECK(http_request(port, "GET", "/").body.find("<title>Sidestep monitor</title>") != std::string::npos);
  CHECK(run.wait_for_end() == "exit code 0");
  // The port is taken: the run says so.
  LaunchedRun holder(kWaitingRobots);
  const MonitorProcess taken(holder);
  LaunchedRun other(kWaitingRobots, {fmt::format("--monitor={}", taken.port), "--seconds", "2"});
  CHECK(other.wait_for_end() == "exit code 0");
  CHECK(other.printed("the monitor ended: exit code 1"));
  CHECK(other.printed("Address already in use"));
}

/// Three viewers watch 22 robots.
void watch_three_times(Duration duration) {
  LaunchedRun run(two_teams_for(20));
  const MonitorProcess monitor(run);
  const std::vector<std::string> dds = run.dds_arguments();
  const pid_t subscriber =
      run.start("subscriber", "discarding_subscriber", {run.scenario_file(), dds[1], dds[3]});
  std::vector<std::unique_ptr<CountingViewer>> viewers;
  for (int i = 0; i < 3; ++i) viewers.push_back(std::make_unique<CountingViewer>(monitor.port));
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  const auto wait = [&](Duration span) {
    const Time end = run.bus().now() + span;
    REQUIRE(run.wait_until([&] { return run.bus().now() > end; }));
  };
  wait(2s);
  const ProcessUsage monitor_before = usage_of(monitor.pid), subscriber_before = usage_of(subscriber);
  std::vector<int> frames_before;
  for (const auto& viewer : viewers) frames_before.push_back(viewer->frames());
  wait(duration);
  const ProcessUsage monitor_after = usage_of(monitor.pid), subscriber_after = usage_of(subscriber);
  double least_rate_hz = 1e9;
  for (std::size_t i = 0; i < viewers.size(); ++i)
    least_rate_hz = std::min(least_rate_hz, (viewers[i]->frames() - frames_before[i]) / to_seconds(duration));
  const Json promise = monitor.state().at("promise");
  viewers.clear();
  const double monitor_cpu = (monitor_after.cpu_s - monitor_before.cpu_s) / to_seconds(duration);
  const double subscriber_cpu = (subscriber_after.cpu_s - subscriber_before.cpu_s) / to_seconds(duration);
  const double missed = promise.at("missed_cycles").get<double>() / promise.at("cycles").get<double>();
  WARN(
      fmt::format("monitor {:.1f} % of a core, a subscriber that discards {:.1f} %, ratio {:.2f}; {:.1f} "
                  "updates a second "
                  "at least; {:.2f} % of the cycles missed; memory {:.0f} MB; {} contacts, coverage {:.1f} %",
                  100 * monitor_cpu, 100 * subscriber_cpu, monitor_cpu / subscriber_cpu, least_rate_hz,
                  100 * missed, monitor_after.memory_mb, promise.at("contacts").get<int>(),
                  100 * promise.at("coverage").get<double>()));
  CHECK(promise.at("contacts") == 0);
  CHECK(promise.at("violations") == 0);
  CHECK(least_rate_hz >= 30);
}

TEST_CASE("a monitor with three viewers does not disturb 22 robots", "[both-cores]") {
  watch_three_times(5s);
}

TEST_CASE("a monitor with three viewers costs little more than a subscriber", "[.][figures]") {
  watch_three_times(30s);
}

/// A viewer that takes 10 kB a second from its connection.
class SlowViewer {
 public:
  explicit SlowViewer(std::uint16_t port) : fd_(socket(AF_INET, SOCK_STREAM, 0)) {
    const int little = 4096;
    setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &little, sizeof little);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
    const std::string request = fmt::format(
        "GET /socket HTTP/1.1\r\nHost: localhost:{}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n",
        port);
    REQUIRE(send(fd_, request.data(), request.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(request.size()));
    thread_ = std::thread([this] {
      char buffer[200];
      while (!is_over_) {
        const ssize_t n = recv(fd_, buffer, sizeof buffer, MSG_DONTWAIT);
        if (n > 0) received_ += n;
        std::this_thread::sleep_for(20ms);
      }
    });
  }
  ~SlowViewer() {
    is_over_ = true;
    thread_.join();
    close(fd_);
  }
  ssize_t received() const { return received_; }

 private:
  int fd_;
  std::atomic<bool> is_over_ = false;
  std::atomic<ssize_t> received_ = 0;
  std::thread thread_;
};

TEST_CASE("slow, many and hostile viewers harm neither run nor monitor", "[both-cores]") {
  LaunchedRun run(two_teams_for(20));
  const MonitorProcess monitor(run);
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  const auto wait = [&](Duration duration) {
    const Time end = run.bus().now() + duration;
    REQUIRE(run.wait_until([&] { return run.bus().now() > end; }));
  };
  // What the monitor needs beside the frames that it remembers.
  const auto memory_mb = [&] {
    return usage_of(monitor.pid).memory_mb - monitor.state().at("history_bytes").get<double>() * 1e-6;
  };
  wait(3s);
  const double before_mb = memory_mb();
  const Json promise_before = monitor.state().at("promise");
  const SlowViewer slow(monitor.port);
  std::vector<std::unique_ptr<CountingViewer>> viewers;
  for (int i = 0; i < 50; ++i) viewers.push_back(std::make_unique<CountingViewer>(monitor.port));
  int disconnected = 0;
  for (int i = 0; i < 20; ++i) {
    SocketClient hostile(monitor.port);
    hostile.send(i % 2 ? "garbage" : std::string(100'000, 'x'));
    for (int k = 0; k < 500 && hostile.is_connected(); ++k) (void)hostile.receive(100ms);
    disconnected += !hostile.is_connected();
    wait(500ms);
  }
  wait(5s);
  const double after_mb = memory_mb();
  int least_frames = 1 << 30;
  for (const auto& viewer : viewers) least_frames = std::min(least_frames, viewer->frames());
  viewers.clear();
  const Json promise = monitor.state().at("promise");
  const auto between = [&](const char* key) {
    return promise.at(key).get<double>() - promise_before.at(key).get<double>();
  };
  WARN(fmt::format(
      "memory beside the history {:.1f} MB, then {:.1f} MB; slow viewer {:.1f} kB/s; 50 viewers got at least "
      "{} "
      "frames; {} of 20 hostile ones disconnected; {:.2f} % of the cycles missed, {} contacts",
      before_mb, after_mb, static_cast<double>(slow.received()) / 15e3, least_frames, disconnected,
      100 * between("missed_cycles") / between("cycles"), promise.at("contacts").get<int>()));
  CHECK(disconnected == 20);
  CHECK(least_frames > 50);
  CHECK(after_mb < before_mb + 30);
  CHECK(promise.at("contacts") == 0);
  CHECK(promise.at("violations") == 0);
}

/// Measures how long events take from the writer of a message to the page.
void send_events(std::size_t events) {
  LaunchedRun run(kWaitingRobots);
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  const MonitorProcess monitor(run);
  Browser page;
  page.open(monitor.url());
  REQUIRE(page.wait_until("window.monitor && monitor.panels && monitor.panels.robots.length === 3",
                          polling(run)));
  page.run(
      "monitor.received = []; const push = monitor.events.push; monitor.events.push = function (e) { if "
      "(e.kind === "
      "'attestation') monitor.received.push(Date.now()); return push.call(this, e); }");
  // An attestation of a robot that has registered has no effect, but is an event.
  auto writer = run.bus().advertise(topics::kAttestation);
  REQUIRE(run.wait_until([&, end = run.bus().now() + 2s] { return run.bus().now() > end; }));
  std::vector<double> sent_ms;
  for (std::size_t i = 0; i < events; ++i) {
    msg::AbsenceAttestation attestation;
    attestation.robot(1);
    attestation.header().sender(static_cast<std::uint32_t>(Sender::kOperator));
    attestation.header().incarnation(1);
    sent_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::system_clock::now().time_since_epoch())
            .count());
    writer.publish(attestation, run.bus().now());
    REQUIRE(run.wait_until([&, end = run.bus().now() + 15ms] { return run.bus().now() > end; }));
  }
  REQUIRE(page.wait_until(fmt::format("monitor.received.length >= {}", events), polling(run)));
  const std::vector<double> received_ms = page.run("return monitor.received");
  REQUIRE(received_ms.size() == events);
  std::vector<double> delays_ms;
  for (std::size_t i = 0; i < events; ++i) delays_ms.push_back(received_ms[i] - sent_ms[i]);
  std::ranges::sort(delays_ms);
  WARN(
      fmt::format("from sending to the page: median {:.1f} ms, p99 {:.1f} ms, longest {:.1f} ms of {} events",
                  delays_ms[events / 2], delays_ms[events * 99 / 100], delays_ms.back(), events));
}

TEST_CASE("events reach the page soon", "[both-cores]") { send_events(100); }

TEST_CASE("a thousand events reach the page soon", "[.][figures]") { send_events(1000); }

}  // namespace sidestep::monitor_faults_test
