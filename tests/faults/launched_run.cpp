// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/launched_run.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <ios>
#include <sstream>

#include "common/geometry/vec2.hpp"
#include "common/json/json_text.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "deploy/audit/audit_totals.hpp"
#include "deploy/run/launch/hosts/hosts_file.hpp"
#include "tests/catch.hpp"
#include "tests/sanitized.hpp"
#include "tests/text_of.hpp"

namespace sidestep {
namespace {

std::filesystem::path new_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "sidestep-run-XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("cannot create a temporary folder");
  return name;
}

/// A file of a process in /proc; empty if the process has ended, even while the file is read.
std::string process_text(pid_t pid, const std::string& name) {
  try {
    return text_of("/proc/" + std::to_string(pid) + "/" + name);
  } catch (const std::ios_base::failure& failure) {
    if (failure.code().value() == ESRCH) return "";
    throw;
  }
}

}  // namespace

LaunchedRun::LaunchedRun(const std::string& scenario, const std::vector<std::string>& extra_arguments)
    : LaunchedRun(scenario, extra_arguments, "127.0.0.1") {
  subscribe();
}

std::unique_ptr<LaunchedRun> LaunchedRun::on_namespaces(const std::string& scenario,
                                                        const std::vector<std::string>& extra_arguments,
                                                        const std::string& hosts_file) {
  std::vector<std::string> arguments{"--hosts", hosts_file};
  arguments.insert(arguments.end(), extra_arguments.begin(), extra_arguments.end());
  std::unique_ptr<LaunchedRun> run(new LaunchedRun(scenario, arguments, load_hosts(hosts_file).interface));
  const Time deadline = EventLoop::now() + std::chrono::minutes(1);
  while (!run->printed("started simulator") && !run->exit_ && EventLoop::now() < deadline) {
    for (const ChildEvent& event : run->group_.poll(std::chrono::milliseconds(20))) run->exit_ = event.reason;
  }
  if (run->exit_) throw std::runtime_error(run->output());
  run->visit_.emplace("sidestep-" + std::to_string(run->pid_) + "-" + kBridgeLabel);
  run->subscribe();
  return run;
}

LaunchedRun::LaunchedRun(const std::string& scenario, const std::vector<std::string>& extra_arguments,
                         const std::string& interface)
    : interface_(interface), folder_(new_folder()), group_((folder_ / "launcher.log").string()) {
  std::ofstream(scenario_file()) << scenario;
  std::vector<std::string> argv{sibling_program_path("sidestep"),
                                "run",
                                scenario_file(),
                                "--domain",
                                std::to_string(domain_.number()),
                                "--report",
                                (folder_ / "report.json").string()};
  argv.insert(argv.end(), extra_arguments.begin(), extra_arguments.end());
  const auto keys = std::ranges::find(extra_arguments, "--keys");
  if (keys != extra_arguments.end()) keys_ = keys[1];
  pid_ = group_.start({"run", argv, false});
}

LaunchedRun::~LaunchedRun() {
  (void)group_.terminate(std::chrono::seconds(10));
  check_sanitizers();
  bus_.reset();
  visit_.reset();
  remove_abandoned_namespaces();
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void LaunchedRun::subscribe() {
  DdsSettings settings{domain_.number(), interface_, "test"};
  settings.keys = keys_;
  settings.identity = {Role::kJudge};
  bus_ = std::make_unique<DdsBus>(settings);
  bus_->subscribe(topics::kTruth, std::function([this](const msg::GroundTruth& truth) { truth_ = truth; }));
}

void LaunchedRun::check_sanitizers() const {
  // A sanitizer error of a child process does not always change the launcher's exit code.
  for (const char* log : {"launcher.log", "report.log"}) {
    const std::string text = text_of(folder_ / log);
    for (const char* complaint : {"Sanitizer: ", ": runtime error: "}) {
      if (text.find(complaint) != std::string::npos) FAIL_CHECK(log << ":\n" << text);
    }
  }
}

void LaunchedRun::poll() {
  bus_->run_until(bus_->now() + Duration{2'000'000});
  for (const ChildEvent& event : group_.poll(std::chrono::milliseconds(0))) {
    if (event.name == "run")
      exit_ = event.reason;
    else
      exit_reasons_[event.name] = event.reason;
  }
}

pid_t LaunchedRun::start(const std::string& name, const std::string& program,
                         const std::vector<std::string>& arguments) {
  std::vector<std::string> argv{sibling_program_path(program)};
  argv.insert(argv.end(), arguments.begin(), arguments.end());
  exit_reasons_.erase(name);
  return group_.start({name, argv, false});
}

std::optional<std::string> LaunchedRun::exit_reason(const std::string& name) const {
  const auto found = exit_reasons_.find(name);
  return found == exit_reasons_.end() ? std::nullopt : std::optional(found->second);
}

std::string LaunchedRun::command(const std::vector<std::string>& arguments) {
  const std::string name = arguments.at(0);
  start(name, "sidestep", arguments);
  (void)wait_until([&] { return exit_reason(name).has_value(); });
  return exit_reason(name).value_or("");
}

std::vector<std::string> LaunchedRun::dds_arguments() const {
  return {"--domain", std::to_string(domain_.number()), "--interface", interface_};
}

std::string LaunchedRun::wait_for_end() {
  (void)wait_until([this] { return exit_.has_value(); });
  return exit_.value_or("");
}

std::string LaunchedRun::output() const { return text_of(folder_ / "launcher.log"); }

bool LaunchedRun::printed(const std::string& text) const { return output().find(text) != std::string::npos; }

std::string LaunchedRun::log() const { return text_of(folder_ / "report.log"); }

bool LaunchedRun::logged(const std::string& text) const { return log().find(text) != std::string::npos; }

std::map<std::string, pid_t> LaunchedRun::children() const {
  // Lines such as "run: started agent 3 again as pid 1234".
  const std::string started = "started ", as_pid = " as pid ", again = " again";
  std::map<std::string, pid_t> result;
  std::istringstream lines(output());
  for (std::string line; std::getline(lines, line);) {
    const auto begin = line.find(started), end = line.find(as_pid);
    if (begin == std::string::npos || end == std::string::npos) continue;
    std::string name = line.substr(begin + started.size(), end - begin - started.size());
    if (name.ends_with(again)) name.resize(name.size() - again.size());
    result[name] = std::stoi(line.substr(end + as_pid.size()));
  }
  return result;
}

pid_t LaunchedRun::director() const {
  const std::string command = process_text(pid_, "cmdline");
  std::istringstream children(process_text(pid_, "task/" + std::to_string(pid_) + "/children"));
  for (pid_t child = 0; !command.empty() && children >> child;) {
    // The director is the same program with the same arguments.
    if (process_text(child, "cmdline") == command) return child;
  }
  return 0;
}

pid_t LaunchedRun::pid_of(const std::string& process) const {
  const auto all = children();
  const auto found = all.find(process);
  return found == all.end() ? 0 : found->second;
}

std::vector<RobotId> LaunchedRun::robots_on(const std::string& host) const {
  std::vector<RobotId> result;
  std::istringstream lines(output());
  const std::string agent = "started agent ";
  for (std::string line; std::getline(lines, line);) {
    const auto position = line.find(agent);
    if (position != std::string::npos && line.ends_with(" on host " + host))
      result.push_back(static_cast<RobotId>(std::stoul(line.substr(position + agent.size()))));
  }
  return result;
}

double LaunchedRun::speed_mps(RobotId robot) const {
  for (const auto& r : truth_.robots()) {
    if (r.robot() == robot) return std::hypot(r.vx_mps(), r.vy_mps());
  }
  return 0;
}

double LaunchedRun::max_speed_mps() const {
  double max_mps = 0;
  for (const auto& r : truth_.robots()) max_mps = std::max(max_mps, std::hypot(r.vx_mps(), r.vy_mps()));
  return max_mps;
}

double LaunchedRun::max_speed_mps(const std::vector<RobotId>& robots) const {
  double max_mps = 0;
  for (const RobotId robot : robots) max_mps = std::max(max_mps, speed_mps(robot));
  return max_mps;
}

nlohmann::json LaunchedRun::report() const { return parse_json(text_of(folder_ / "report.json"), false); }

std::string three_hosts_file() {
  return SIDESTEP_SOURCE_DIR "/deploy/run/launch/hosts/three-namespaces.yaml";
}

std::string shipped(const std::string& file) {
  return text_of(std::filesystem::path(SIDESTEP_SOURCE_DIR) / "deploy" / file);
}

std::string shipped_scenario(const std::string& name) { return shipped("scenarios/" + name + ".yaml"); }

std::string crossing_images(int rate_hz) {
  std::string text = shipped_scenario("crossing-images");
  const std::string key = "vision: {images: {";
  REQUIRE(text.find(key) != std::string::npos);
  const std::string size = kIsSanitized ? "width_px: 390, height_px: 290" : "";
  text.replace(text.find(key), key.size(),
               "vision: {rate_hz: " + std::to_string(kIsSanitized ? 10 : rate_hz) + ", images: {" + size);
  return text;
}

std::string shuttles(int times, const std::string& extra_keys) {
  std::string text =
      "name: shuttles\nfield: {length_m: 9, width_m: 6}\ntime_limit_s: 100\n" + extra_keys + "robots:\n";
  const auto add = [&](int id, const Vec2& start_m, const Vec2& goal_m) {
    text += fmt::format("  - {{id: {}, start_m: [{}, {}], goals_m: [", id, start_m.x(), start_m.y());
    for (int i = 0; i < times; ++i) {
      const Vec2& next = i % 2 == 0 ? goal_m : start_m;
      text += fmt::format("{}[{}, {}]", i == 0 ? "" : ", ", next.x(), next.y());
    }
    text += "]}\n";
  };
  for (int lane = 0; lane < 6; ++lane) {
    const double side = lane % 2 == 0 ? -1 : 1, y_m = 0.6 * (lane - 2.5);
    add(lane, {side * 2.5, y_m}, {-side * 2.5, y_m});
  }
  add(6, {-0.8, -2.5}, {-0.8, 2.5});
  add(7, {0.8, 2.5}, {0.8, -2.5});
  return text;
}

void check_passed_or_missed_messages(const LaunchedRun& run, const std::string& end) {
  if (end == "exit code 0") return;
  CHECK(end == "exit code " + std::to_string(kExitNotJudged));
  // The audit lacks data of a version if it has missed one of the few messages about the version.
  CHECK((run.printed("of the messages were missed") || run.printed("of the executed versions lack a")));
}

void require_no_violations(const nlohmann::json& report) {
  REQUIRE(report.is_object());
  CHECK(report["contacts"] == 0);
  CHECK(report["firmware_violations"] == 0);
  INFO(json_text(report["audit"], 2));
  CHECK(report["audit"]["violations"] == 0);
  CHECK(report["audit"]["verdict"] != "failed");
  CHECK(report["audit"]["received"] > 0);
  // A run that ends early has no pairs to compare.
  if (report["arrived"] > 0) CHECK(report["audit"]["compared_pairs"] > 0);
}

bool is_running(pid_t pid) {
  const std::string stat = process_text(pid, "stat");
  const auto after_name = stat.rfind(") ");
  return after_name != std::string::npos && stat[after_name + 2] != 'Z';
}

}  // namespace sidestep
