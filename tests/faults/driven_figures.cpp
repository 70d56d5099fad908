// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/driven_figures.hpp"

#include <fmt/format.h>
#include <iterator>
#include <regex>

namespace sidestep {
namespace {

constexpr double kMaxOwnStopsPerMinute = 1;

std::size_t count_of(const std::string& text, const std::regex& pattern) {
  return static_cast<std::size_t>(
      std::distance(std::sregex_iterator(text.begin(), text.end(), pattern), std::sregex_iterator()));
}

/// The lines of a log that say when and why robots made their own stops.
std::string own_stops_in(const std::string& log) {
  std::string result;
  const std::regex pattern("[^\n]*robot [0-9]+ makes its own stop: [^\n]*");
  for (std::sregex_iterator match(log.begin(), log.end(), pattern); match != std::sregex_iterator(); ++match)
    result += "\n    " + match->str();
  return result;
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
  const std::string log = run.log();
  const double stops = static_cast<double>(count_of(log, std::regex("robot [0-9]+ makes its own stop: "))) -
                       static_cast<double>(count_of(
                           log, std::regex("robot [0-9]+ makes its own stop: its firmware restarted")));
  if (report["arrived"] != report["robots"])
    result.misses.push_back(fmt::format("{} of {} arrived", report["arrived"].dump(), robots));
  if (report["contacts"] != 0) result.misses.push_back(report["contacts"].dump() + " contacts");
  if (report["audit"]["violations"] != 0)
    result.misses.push_back(report["audit"]["violations"].dump() + " violations");
  result.is_unsafe = report["contacts"] != 0 || report["audit"]["violations"] != 0;
  const auto& makespan = report["makespan_s"];
  const double minutes = makespan.is_number() ? makespan.get<double>() / 60 : 0;
  if (stops > 0 && !(stops <= kMaxOwnStopsPerMinute * robots * minutes))
    result.misses.push_back(fmt::format("{:g} own stops: {}", stops, own_stops_in(log)));
  result.figures =
      fmt::format("{}, {} of {} arrived after {} s, {:g} own stops, {} contacts", ended,
                  report["arrived"].dump(), robots, makespan.dump(), stops, report["contacts"].dump());
  return result;
}

}  // namespace sidestep
