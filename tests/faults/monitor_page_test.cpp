// SPDX-License-Identifier: Apache-2.0
// The monitor's page in a real browser, with real processes.
#include <chrono>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <signal.h>
#include <thread>

#include "common/file/temporary_folder.hpp"
#include "common/json/json_text.hpp"
#include "common/protocol/senders.hpp"
#include "tests/catch.hpp"
#include "tests/faults/browser.hpp"
#include "tests/faults/monitored_run.hpp"
#include "tests/faults/shown_recording.hpp"
#include "tests/unit/deploy/view/server/web_client.hpp"

namespace sidestep::monitor_page_test {

using namespace std::chrono_literals;
using Json = nlohmann::json;

TEST_CASE("the page shows a run and gives orders to its robots", "[both-cores]") {
  LaunchedRun run(kWaitingRobots);
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  const MonitorProcess monitor(run, {"--control"});
  Browser page;
  page.open(monitor.url());
  REQUIRE(page.wait_until("window.monitor && monitor.panels && monitor.panels.promise.state === 'kept'"));
  CHECK(page.text("lamp-text") == "promise kept");
  CHECK(page.text("connection") == "connected");

  // The page shows the robots' true positions.
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

  // The panels have the expected contents.
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

  // Gives one order by drag and drop, and one by HTTP.
  page.click("tab-control");
  page.run(R"(
    const canvas = document.getElementById('floor'), box = canvas.getBoundingClientRect();
    const at = (x, y) => {
      const pixel = monitor.floor.toPixels({x, y});
      return {clientX: box.x + pixel.x, clientY: box.y + pixel.y, pointerId: 1, bubbles: true};
    };
    canvas.setPointerCapture = () => {};
    canvas.dispatchEvent(new PointerEvent('pointerdown', at(-2, 0)));
    canvas.dispatchEvent(new PointerEvent('pointermove', at(-1, -1)));
    canvas.dispatchEvent(new PointerEvent('pointerup', at(-1, -1)));)");
  CHECK(page.wait_until(
      "/^Robot 0: order (\\d+ "
      ")?(sent|accepted|driving)/.test(document.getElementById('command-result').textContent)"));
  CHECK(http_request(monitor.port(), "POST", "/api/robots/1/order", {}, R"({"goals": [[3, 1]]})").status ==
        401);
  CHECK(http_request(monitor.port(), "POST", "/api/robots/1/order",
                     {{"Authorization", "Bearer " + monitor.token()}}, R"({"goals": [[3, 1]]})")
            .status == 200);
  const auto is_at = [&](RobotId robot, double x_m, double y_m) {
    for (const msg::TrueRobotState& r : run.truth().robots())
      if (r.robot() == robot) return std::hypot(r.x_m() - x_m, r.y_m() - y_m) < 0.05;
    return false;
  };
  // The page shows the planning fields of the selected robot.
  for (const char* layer : {"navigation", "band", "local"}) page.click(std::string("layer-") + layer);
  page.run("document.querySelector('#panel-robots [data-key=\"1\"]').click()");
  // The monitor knows the robot's goal once it has received the order.
  Json fields;
  REQUIRE(run.wait_until([&] {
    fields = parse_json(http_request(monitor.port(), "GET", "/api/fields/1").body);
    return fields.contains("navigation");
  }));
  CHECK(fields.at("navigation").at("values").size() > 1000);
  CHECK(http_request(monitor.port(), "GET", "/api/fields/x").status == 404);
  CHECK(run.wait_until([&] { return is_at(0, -1, -1) && is_at(1, 3, 1); }));
  page.click("tab-topics");
  for (const char* topic : {"proposal", "verdict"})
    CHECK(page.wait_until(fmt::format("document.querySelector('#panel-topics [data-key=\"{}\"]')", topic)));
  page.click("command-hold-all");
  CHECK(page.wait_until("monitor.events.filter((e) => e.kind === 'hold').length === 3", polling(run)));

  // Each order appears as an event. No keyboard shortcut causes an error, and no request of the page is
  // refused.
  CHECK(page.wait_until("monitor.events.some((e) => e.text === 'the operator sends robot 0 to a goal')"));
  for (const char* key : {"1", "2", "m", "t", "f", "[", "]", ",", ".", "l"}) page.press(key);
  CHECK(page.logged_errors() == "");
}

TEST_CASE("the page shows a takeover between coordinators, and reconnects to a restarted monitor",
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

  // Without --control no request can give commands.
  CHECK(page.run("return document.getElementById('tab-control')").is_null());
  CHECK(http_request(monitor->port(), "POST", "/api/hold", {{"Authorization", "Bearer "}}).status == 401);

  const std::uint16_t port = monitor->port();
  REQUIRE(kill(monitor->pid(), SIGINT) == 0);
  CHECK(page.wait_until("monitor.connection === 'lost'", polling(run)));
  CHECK(run.wait_until([&] { return run.exit_reason("monitor").has_value(); }));
  CHECK(*run.exit_reason("monitor") == "exit code 0");
  monitor = std::make_unique<MonitorProcess>(run, std::vector<std::string>{}, port, "monitor again");
  CHECK(page.wait_until("monitor.connection === 'connected' && monitor.panels.robots.length === 3",
                        polling(run)));
}

TEST_CASE("the page shows a recording, and a link to a time opens the recording at that time") {
  ShownRecording recording("crossing.yaml");
  Browser page;
  page.open(recording.url());
  REQUIRE(page.wait_until(
      "window.monitor && monitor.frame && document.getElementById('clock').textContent.startsWith('00:')"));
  // It opens at the first granted moment, with the verdict on the whole recording, and plays from there.
  CHECK(page.wait_until("document.getElementById('lamp-whole').textContent.includes('promise kept')"));
  CHECK(page.wait_until(
      "document.getElementById('clock').textContent.includes('paused at the first granted motion')"));
  CHECK(page.run("return monitor.frame.sections.robots.rows") ==
        page.run("return monitor.scene.robots.length"));
  const Json opened_s = page.run("return monitor.frame.time");
  page.click("play");
  CHECK(page.wait_until(fmt::format("monitor.frame.time > {:.3f}", opened_s.get<double>() + 0.2)));
  page.click("live");
  CHECK(page.wait_until("document.getElementById('clock').textContent.includes('end of the recording')"));
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
  // The inspected message is from the displayed time.
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
  CHECK(page.logged_errors() == "");

  // The floor is drawn even if nothing moves, and again after it has been resized and zoomed.
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

TEST_CASE("the page shows camera images with the robots that vision detects", "[both-cores]") {
  LaunchedRun run(crossing_images(30));
  const MonitorProcess monitor(run);
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  Browser page;
  page.open(monitor.url());
  REQUIRE(page.wait_until("window.monitor && monitor.scene && document.getElementById('tab-cameras')"));
  page.click("tab-cameras");
  CHECK(page.wait_until(
      "Array.from(document.querySelectorAll('.camera')).every((image) => image.naturalWidth > 100)",
      polling(run)));
  CHECK(page.run("return document.querySelectorAll('.camera').length") ==
        page.run("return monitor.scene.cameras"));
  for (const char* path :
       {"/api/cameras/99.jpg", "/api/cameras/x.jpg", "/api/cameras/.jpg", "/api/cameras/-1.jpg"})
    CHECK(http_request(monitor.port(), "GET", path).status == 404);
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
  CHECK(page.logged_errors() == "");
  recording.end();
}

TEST_CASE("the page draws all layers for 22 robots and for 1,000 robots", "[both-cores][slow]") {
  for (const char* scenario : {"two-teams-22.yaml", "streams-1000.yaml"}) {
    ShownRecording recording(scenario, {"--seconds", "3"});
    Browser page;
    page.open(recording.url());
    REQUIRE(page.wait_until(
        "window.monitor && monitor.scene && monitor.panels && monitor.panels.promise.cycles > 0 || "
        "window.monitor && monitor.scene && (document.getElementById('live').click(), false)"));
    page.run("for (const box of document.querySelectorAll('#layers input')) if (!box.checked) box.click()");
    // Plays the recording repeatedly, starting after a third of it.
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
    CHECK(page.logged_errors() == "");
  }
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
  // An attestation of a registered robot has no effect, but appears as an event.
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

TEST_CASE("events reach the page without delay", "[both-cores]") { send_events(100); }

TEST_CASE("a thousand events reach the page without delay", "[.figures][slow]") { send_events(1000); }

}  // namespace sidestep::monitor_page_test
