// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/driven_figures.hpp"

#include <fmt/format.h>
#include <sstream>
#include <string>
#include <vector>

namespace sidestep {
namespace {

constexpr double kMaxOwnStopsPerMinute = 1;

/// The lines of a log in which robots say why they make their own stops, without restarts of their firmware.
std::vector<std::string> own_stops_in(const std::string& log) {
  std::vector<std::string> stops;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);)
    if (line.find(" makes its own stop: ") != std::string::npos &&
        line.find("its firmware restarted") == std::string::npos)
      stops.push_back(line);
  return stops;
}

}  // namespace

MeasuredRun drive_to_end(const std::string& row, ExternalSimulatorRun& floor) {
  MeasuredRun result{row, "", {}};
  LaunchedRun& run = floor.run();
  std::string ended = run.wait_for_end();
  while (ended.empty() && is_running(run.pid())) ended = run.wait_for_end();
  const auto report = run.report();
  if (!report.is_object()) {
    result.misses.push_back("no report, " + ended);
    return result;
  }
  const double robots = report["robots"].get<double>();
  const std::vector<std::string> own_stops = own_stops_in(run.log());
  const auto stops = static_cast<double>(own_stops.size());
  if (report["arrived"] != report["robots"])
    result.misses.push_back(fmt::format("{} of {} arrived", report["arrived"].dump(), robots));
  if (report["contacts"] != 0) result.misses.push_back(report["contacts"].dump() + " contacts");
  if (report["audit"]["violations"] != 0)
    result.misses.push_back(report["audit"]["violations"].dump() + " violations");
  const auto& makespan = report["makespan_s"];
  const double minutes = makespan.is_number() ? makespan.get<double>() / 60 : 0;
  if (stops > 0 && !(stops <= kMaxOwnStopsPerMinute * robots * minutes)) {
    // While the machine pauses, commands and frames are late.
    result.may_be_chance = result.misses.empty() && ended == "exit code 0";
    result.misses.push_back(fmt::format("{:g} own stops", stops));
    for (const std::string& stop : own_stops) result.details += "    " + stop + "\n";
  }
  result.figures =
      fmt::format("{}, {} of {} arrived after {} s, {:g} own stops, {} contacts", ended,
                  report["arrived"].dump(), robots, makespan.dump(), stops, report["contacts"].dump());
  return result;
}

}  // namespace sidestep
