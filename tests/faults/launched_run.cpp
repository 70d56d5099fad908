// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/launched_run.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace sidestep {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::filesystem::path new_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "sidestep-run-XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
  return name;
}

}  // namespace

LaunchedRun::LaunchedRun(const std::string& scenario, const std::vector<std::string>& more_arguments)
    : folder_(new_folder()), group_((folder_ / "launcher.log").string()), bus_(domain_.settings("judge")) {
  bus_.subscribe(topics::kTruth, std::function([this](const msg::GroundTruth& truth) { truth_ = truth; }));
  std::ofstream(folder_ / "scenario.yaml") << scenario;
  std::vector<std::string> argv{
      program_beside_own("sidestep"),   "run",      (folder_ / "scenario.yaml").string(), "--domain",
      std::to_string(domain_.number()), "--report", (folder_ / "report.json").string()};
  argv.insert(argv.end(), more_arguments.begin(), more_arguments.end());
  pid_ = group_.start({"run", argv, false});
}

LaunchedRun::~LaunchedRun() {
  (void)group_.terminate(std::chrono::seconds(10));
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void LaunchedRun::listen() {
  bus_.run_until(bus_.now() + Duration{2'000'000});
  for (const ChildEvent& event : group_.poll(std::chrono::milliseconds(0))) exit_ = event.reason;
}

std::string LaunchedRun::wait_for_end() {
  (void)until([this] { return exit_.has_value(); });
  return exit_.value_or("");
}

std::string LaunchedRun::output() const { return text_of(folder_ / "launcher.log"); }

bool LaunchedRun::printed(const std::string& words) const {
  return output().find(words) != std::string::npos;
}

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

pid_t LaunchedRun::pid_of(const std::string& process) const {
  const auto all = children();
  const auto found = all.find(process);
  return found == all.end() ? 0 : found->second;
}

double LaunchedRun::speed_mps(RobotId robot) const {
  for (const auto& r : truth_.robots()) {
    if (r.robot() == robot) return std::hypot(r.vx_mps(), r.vy_mps());
  }
  return 0;
}

double LaunchedRun::fastest_mps() const {
  double fastest = 0;
  for (const auto& r : truth_.robots()) fastest = std::max(fastest, std::hypot(r.vx_mps(), r.vy_mps()));
  return fastest;
}

nlohmann::json LaunchedRun::report() const {
  return nlohmann::json::parse(text_of(folder_ / "report.json"), nullptr, false);
}

std::string shipped_scenario(const std::string& name) {
  return text_of(std::filesystem::path(SIDESTEP_SOURCE_DIR) / "deploy/scenarios" / (name + ".yaml"));
}

bool is_running(pid_t pid) {
  const std::string stat = text_of("/proc/" + std::to_string(pid) + "/stat");
  const auto after_name = stat.rfind(") ");
  return after_name != std::string::npos && stat[after_name + 2] != 'Z';
}

}  // namespace sidestep
