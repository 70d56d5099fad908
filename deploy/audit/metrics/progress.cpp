// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/progress.hpp"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "common/file/console.hpp"

namespace sidestep {
namespace {

constexpr Duration kTablePeriod = std::chrono::milliseconds(200);
constexpr Duration kLinePeriod = std::chrono::seconds(1);
constexpr int kDefaultTerminalRows = 24;

const char* state_name(const RobotProgress& row) {
  if (row.arrived) return "arrived";
  if (!row.agent_state) return "silent";
  switch (*row.agent_state) {
    case msg::AgentState::AGENT_FENCING:
      return "fencing";
    case msg::AgentState::AGENT_REGISTERING:
      return "registering";
    case msg::AgentState::AGENT_WAITING:
      return "waiting";
    case msg::AgentState::AGENT_DRIVING:
      return "driving";
    case msg::AgentState::AGENT_ARRIVED:
      return "settling";
    case msg::AgentState::AGENT_CLOCK_OUT_OF_BOUND:
      return "clock off";
    case msg::AgentState::AGENT_ABSENT:
      return "absent";
    case msg::AgentState::AGENT_HELD:
      return "held";
    case msg::AgentState::AGENT_WITHOUT_ORDER:
      return "no order";
  }
  return "?";
}

std::string clock_text(const Report& report) {
  if (!report.max_clock_offset_s) return "";
  return fmt::format("  clocks {:.2f} +- {:.2f} ms", *report.max_clock_offset_s * 1e3,
                     report.clock_uncertainty_s.value_or(0) * 1e3);
}

double milliseconds(Duration duration) { return to_seconds(duration) * 1e3; }

int terminal_rows() {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 0 ? size.ws_row : kDefaultTerminalRows;
}

}  // namespace

std::string progress_line(const RunMetrics& metrics, Time now) {
  const Report report = metrics.report();
  const auto since = metrics.granting_since();
  const double missed = report.cycles > 0 ? 100.0 * static_cast<double>(report.missed_cycles) /
                                                static_cast<double>(report.cycles)
                                          : 0;
  const std::string named = metrics.named_robots();
  return fmt::format(
      "{}  {} of {} arrived  {} contacts{}{}  clearance {}  {} grants  {} denials  {:.2f} % missed  "
      "negotiation {:.2f} / {:.2f} ms{}",
      since ? fmt::format("{:5.1f} s", to_seconds(now - *since)) : "starting", report.arrived, report.robots,
      report.contacts, metrics.conflicts() > 0 ? fmt::format("  {} in conflict", metrics.conflicts()) : "",
      named.empty() ? "" : "  " + named,
      report.min_clearance_m ? fmt::format("{:.3f} m", *report.min_clearance_m) : "?", report.grants,
      report.denials, missed, milliseconds(report.negotiation.quantile(0.5)),
      milliseconds(report.negotiation.quantile(0.99)), clock_text(report));
}

std::string progress_table(const RunMetrics& metrics, Time now, int max_rows) {
  std::string text = progress_line(metrics, now) + "\n";
  text += "robot  team    state          to go      speed   grants  denials  negotiation p50 / p99\n";
  const auto rows = metrics.progress();
  const auto shown = std::min<std::size_t>(rows.size(), static_cast<std::size_t>(std::max(max_rows, 1)));
  for (std::size_t i = 0; i < shown; ++i) {
    const RobotProgress& row = rows[i];
    text += fmt::format("{:5}  {:6}  {:11}  {:6.2f} m  {:5.2f} m/s  {:7}  {:7}  {:11.2f} / {:.2f} ms\n",
                        row.robot, row.team == Team::kBlue ? "blue" : "yellow", state_name(row),
                        row.distance_to_go_m, row.speed_mps, row.grants, row.denials,
                        milliseconds(row.negotiation_p50), milliseconds(row.negotiation_p99));
  }
  if (shown < rows.size()) text += fmt::format("... and {} more\n", rows.size() - shown);
  return text;
}

ProgressDisplay::ProgressDisplay() : is_terminal_(isatty(STDOUT_FILENO) == 1) {}

void ProgressDisplay::erase_table() {
  if (drawn_lines_ > 0) print_to(stdout, "\x1b[{}A\x1b[J", drawn_lines_);
  drawn_lines_ = 0;
}

void ProgressDisplay::print(const std::string& line) {
  erase_table();
  print_to(stdout, "{}\n", line);
  if (is_terminal_) next_ = Time{};
}

void ProgressDisplay::update(const RunMetrics& metrics, Time now) {
  if (now < next_) return;
  if (is_terminal_) {
    next_ = now + kTablePeriod;
    erase_table();
    const std::string table = progress_table(metrics, now, terminal_rows() - 4);
    drawn_lines_ = static_cast<int>(std::count(table.begin(), table.end(), '\n'));
    print_to(stdout, "{}", table);
  } else {
    next_ = now + kLinePeriod;
    print_to(stdout, "{}\n", progress_line(metrics, now));
  }
}

}  // namespace sidestep
