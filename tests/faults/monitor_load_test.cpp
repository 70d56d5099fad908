// SPDX-License-Identifier: Apache-2.0
// Measures the load that the monitor and its viewers put on a run of real
// processes.
#include <arpa/inet.h>
#include <atomic>
#include <csignal>
#include <cstring>
#include <fmt/format.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include "common/config/scenario_loader.hpp"
#include "common/json/json_text.hpp"
#include "tests/catch.hpp"
#include "tests/faults/monitored_run.hpp"
#include "tests/faults/process_usage.hpp"
#include "tests/taken_port.hpp"
#include "tests/unit/deploy/view/server/web_client.hpp"

namespace sidestep::monitor_load_test {

using namespace std::chrono_literals;
using Json = nlohmann::json;

/// Seeks back by this time while the run continues.
void seek_back(double back_s) {
  LaunchedRun run(kWaitingRobots);
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  const MonitorProcess monitor(run);
  SocketClient viewer(monitor.port());
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
      const Json json = parse_json(message->text);
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
    const double wanted_s = first_s + 0.05 * i + (i % 2 ? back_s / 2 : 0);  // far from the previous position
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

TEST_CASE("a viewer can seek back while the run continues", "[both-cores]") { seek_back(5); }

TEST_CASE("a viewer can seek 60 seconds back while the run continues", "[.figures][slow]") { seek_back(60); }

/// The scenario two-teams-22, whose teams change sides repeatedly.
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

/// A viewer in its own thread that counts what it receives.
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

/// A port that is free, because the monitor that used it has just ended.
std::uint16_t free_port() {
  LaunchedRun first(kWaitingRobots);
  return MonitorProcess(first).port();
}

TEST_CASE("a run serves its page to the browser, and with --close until it is over") {
  const std::uint16_t port = free_port();
  LaunchedRun run(kWaitingRobots, {fmt::format("--monitor={}", port), "--close", "--seconds", "4"});
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  CHECK(run.printed(fmt::format("monitor: http://127.0.0.1:{}/\n", port)));
  CHECK(parse_json(http_request(port, "GET", "/api/state").body).at("robots").size() == 3);
  CHECK(http_request(port, "GET", "/").body.find("<title>Sidestep monitor</title>") != std::string::npos);
  CHECK(run.wait_for_end() == "exit code 0");
  CHECK(http_request(port, "GET", "/").status == 0);
}

TEST_CASE("the page of a run stays until Ctrl-C, as a recording of what was, and frees the domain") {
  const std::uint16_t port = free_port();
  LaunchedRun run(kWaitingRobots, {fmt::format("--monitor={}", port), "--control", "--seconds", "3"});
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  const std::string begin = fmt::format("monitor: http://127.0.0.1:{}/#token=", port);
  REQUIRE(run.printed(begin));
  const std::string token = run.output().substr(run.output().find(begin) + begin.size(), 32);
  CHECK_FALSE(run.logged(token));
  const std::map<std::string, std::string> rights{{"Authorization", "Bearer " + token}};
  CHECK(http_request(port, "POST", "/api/hold", rights).status == 200);
  REQUIRE(run.wait_until([&] {
    return run.printed(fmt::format("the monitor shows the run until Ctrl-C: http://127.0.0.1:{}/", port));
  }));
  CHECK(run.report().is_object());
  for (const auto& [name, pid] : run.children()) {
    CAPTURE(name);
    CHECK(is_running(pid) == (name == "monitor"));
  }
  const Json scene = parse_json(http_request(port, "GET", "/api/scene").body);
  CHECK(scene.at("is_recording") == true);
  CHECK(scene.at("can_command") == false);
  CHECK(http_request(port, "POST", "/api/hold", rights).status == 409);
  const Json state = parse_json(http_request(port, "GET", "/api/state").body);
  CHECK(state.at("promise").at("state") == "kept");
  // The same domain can be used again, and the page does not show the other run.
  run.start("second", "sidestep",
            {"run", run.scenario_file(), "--domain", run.dds_arguments()[1], "--seconds", "3", "--report",
             run.scenario_file() + ".json"});
  REQUIRE(run.wait_until([&] { return run.exit_reason("second").has_value(); }));
  CHECK(*run.exit_reason("second") == "exit code 0");
  CHECK(parse_json(http_request(port, "GET", "/api/state").body).at("at_s") == state.at("at_s"));
  REQUIRE(kill(run.pid(), SIGINT) == 0);
  CHECK(run.wait_for_end() == "exit code 0");
  CHECK(http_request(port, "GET", "/").status == 0);
}

TEST_CASE("Ctrl-C ends a run and its page, and a run continues without its monitor") {
  const std::uint16_t port = free_port();
  LaunchedRun run(kWaitingRobots, {fmt::format("--monitor={}", port)});
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  const Time granted = run.bus().now();
  REQUIRE(run.wait_until([&] { return run.bus().now() - granted > std::chrono::seconds(2); }));  // to judge
  SECTION("the user interrupts") {
    REQUIRE(kill(run.pid(), SIGINT) == 0);
    CHECK(run.wait_for_end() == "exit code 0");
    CHECK_FALSE(run.printed("until Ctrl-C"));
  }
  SECTION("the monitor dies") {
    REQUIRE(kill(run.pid_of("monitor"), SIGKILL) == 0);
    CHECK(run.wait_until([&] { return run.printed("the monitor ended: signal 9 (SIGKILL)"); }));
    CHECK(run.command({"hold", "all", "--domain", run.dds_arguments()[1]}) == "exit code 0");
    REQUIRE(kill(run.pid(), SIGINT) == 0);
    CHECK(run.wait_for_end() == "exit code 0");
  }
}

TEST_CASE(
    "Ctrl-C before the page of a run can be opened starts nothing else, and ends even a page that hangs") {
  const std::uint16_t port = free_port();
  bool was_in_time = false;
  for (int attempt = 0; attempt < 5 && !was_in_time; ++attempt) {
    LaunchedRun run(kWaitingRobots, {fmt::format("--monitor={}", port)});
    REQUIRE(run.wait_until([&] { return run.pid_of("monitor") > 0; }));
    REQUIRE(kill(run.pid_of("monitor"), SIGSTOP) == 0);
    REQUIRE(kill(run.pid(), SIGINT) == 0);
    CHECK_FALSE(run.wait_for_end().empty());
    was_in_time = !run.printed("monitor: http");
    if (!was_in_time) continue;
    CHECK_FALSE(run.printed("started simulator"));
    CHECK_FALSE(run.printed("until Ctrl-C"));
  }
  CHECK(was_in_time);
}

TEST_CASE("a run whose port is taken is refused before anything starts") {
  const TakenPort port;
  LaunchedRun run(kWaitingRobots, {"--monitor=" + port.number()});
  CHECK(run.wait_for_end() == "exit code 2");
  CHECK(run.printed("uses port " + port.number()));
  CHECK_FALSE(run.printed("monitor: http"));
  CHECK_FALSE(run.printed("started"));
}

/// Measures the load of a monitor while three viewers watch 22 robots.
void measure_three_viewers(Duration duration) {
  LaunchedRun run(two_teams_for(20));
  const MonitorProcess monitor(run);
  const std::vector<std::string> dds = run.dds_arguments();
  const pid_t subscriber =
      run.start("subscriber", "discarding_subscriber", {run.scenario_file(), dds[1], dds[3]});
  std::vector<std::unique_ptr<CountingViewer>> viewers;
  for (int i = 0; i < 3; ++i) viewers.push_back(std::make_unique<CountingViewer>(monitor.port()));
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  wait(run, 2s);
  const ProcessUsage monitor_before = usage_of(monitor.pid()), subscriber_before = usage_of(subscriber);
  std::vector<int> frames_before;
  for (const auto& viewer : viewers) frames_before.push_back(viewer->frames());
  wait(run, duration);
  const ProcessUsage monitor_after = usage_of(monitor.pid()), subscriber_after = usage_of(subscriber);
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
  measure_three_viewers(5s);
}

TEST_CASE("a monitor with three viewers costs little more than a plain subscriber", "[.figures][slow]") {
  measure_three_viewers(30s);
}

/// A viewer that reads only 10 kB per second from its connection.
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

TEST_CASE("slow or numerous or hostile viewers harm neither the run nor the monitor", "[both-cores][slow]") {
  LaunchedRun run(two_teams_for(20));
  const MonitorProcess monitor(run);
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  // Memory of the monitor without its history of frames.
  const auto memory_mb = [&] {
    return usage_of(monitor.pid()).memory_mb - monitor.state().at("history_bytes").get<double>() * 1e-6;
  };
  wait(run, 3s);
  const double before_mb = memory_mb();
  const Json promise_before = monitor.state().at("promise");
  const SlowViewer slow(monitor.port());
  std::vector<std::unique_ptr<CountingViewer>> viewers;
  for (int i = 0; i < 50; ++i) viewers.push_back(std::make_unique<CountingViewer>(monitor.port()));
  int disconnected = 0;
  for (int i = 0; i < 20; ++i) {
    SocketClient hostile(monitor.port());
    hostile.send(i % 2 ? "garbage" : std::string(100'000, 'x'));
    for (int k = 0; k < 500 && hostile.is_connected(); ++k) (void)hostile.receive(100ms);
    disconnected += !hostile.is_connected();
    wait(run, 500ms);
  }
  wait(run, 5s);
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

}  // namespace sidestep::monitor_load_test
