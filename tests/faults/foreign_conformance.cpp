// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/foreign_conformance.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <fstream>
#include <regex>
#include <sstream>

#include "common/file/temporary_folder.hpp"
#include "common/process/process.hpp"
#include "deploy/run/launch/process_group.hpp"
#include "tests/test_endpoint.hpp"
#include "tests/text_of.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

constexpr auto kTimeout = 240s;
constexpr const char *kCommand = "conformance", *kPlacing = "placing";

const std::regex& latency_pattern() {
  static const std::regex pattern("(passed|FAILED|not judged) +latency +(.*)");
  return pattern;
}

void read_latency(ConformanceOutcome& outcome) {
  const std::regex figure("obey after (-?[0-9.]+) ms");
  std::istringstream lines(outcome.output);
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (!std::regex_search(line, match, latency_pattern())) continue;
    outcome.latency_row = match[2];
    outcome.is_latency_judged = match[1] != "not judged";
    if (std::regex_search(outcome.latency_row, match, figure)) outcome.latency_ms = std::stod(match[1]);
  }
}

}  // namespace

ConformanceOutcome examine_foreign_robot(const std::string& scenario,
                                         const std::vector<std::string>& simulator_options,
                                         const std::string& driver_options,
                                         const std::vector<std::string>& conformance_options,
                                         ExaminedUntil until) {
  const TestEndpoint endpoints;
  const TemporaryFolder folder;
  const std::string file = folder.file("scenario.yaml"), log = folder.file("log");
  std::ofstream(file) << scenario;
  const std::string domain = std::to_string(endpoints.domain().number()), group = endpoints.text(0),
                    blue = to_text(endpoints.unicast(2)), yellow = to_text(endpoints.unicast(3));
  std::vector<std::string> simulator{sibling_program_path("sidestep-simulator"),
                                     "--scenario",
                                     file,
                                     "--domain",
                                     domain,
                                     "--league",
                                     "--ssl-vision",
                                     group,
                                     "--control",
                                     to_text(endpoints.unicast(1)),
                                     "--blue",
                                     blue,
                                     "--yellow",
                                     yellow};
  simulator.insert(simulator.end(), simulator_options.begin(), simulator_options.end());
  ConformanceOutcome outcome;
  {
    ProcessGroup group_of_processes(log);
    group_of_processes.start({"foreign simulator", simulator, false});
    const auto is_enough = [&] {
      return until == ExaminedUntil::kLatency &&
             std::ranges::any_of(group_of_processes.last_lines(kCommand), [](const std::string& line) {
               return std::regex_search(line, latency_pattern());
             });
    };
    const auto ended = [&](const std::string& name) {
      const auto deadline = std::chrono::steady_clock::now() + kTimeout;
      while (std::chrono::steady_clock::now() < deadline && !is_enough()) {
        for (const ChildEvent& event : group_of_processes.poll(20ms)) {
          if (event.name == name) return event.reason;
        }
      }
      return std::string();
    };
    const std::string sidestep = sibling_program_path("sidestep");
    group_of_processes.start({kPlacing,
                              {sidestep, "league", "place", file, "--control", to_text(endpoints.unicast(1)),
                               "--ssl-vision", group},
                              false});
    outcome.ended = ended(kPlacing);
    if (outcome.ended == "exit code 0") {
      std::vector<std::string> command{
          sidestep,
          "conformance",
          file,
          "--driver",
          "league",
          "--domain",
          domain,
          fmt::format("--robots={} --blue {} --yellow {}", driver_options, blue, yellow),
          fmt::format("--vision=--source ssl --ssl-vision {}", group)};
      command.insert(command.end(), conformance_options.begin(), conformance_options.end());
      group_of_processes.start({kCommand, command, false});
      outcome.ended = ended(kCommand);
    }
    (void)group_of_processes.terminate(10s);
  }
  outcome.output = text_of(log);
  read_latency(outcome);
  return outcome;
}

}  // namespace sidestep
