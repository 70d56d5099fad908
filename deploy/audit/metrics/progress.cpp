// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/progress.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vector>

#include "common/file/console.hpp"
#include "common/terminal/screen_text.hpp"

namespace sidestep {
namespace {

constexpr Duration kTablePeriod = std::chrono::milliseconds(200);
constexpr Duration kLinePeriod = std::chrono::seconds(1);

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

double milliseconds(Duration duration) { return to_seconds(duration) * 1e3; }

/// A duration in milliseconds with three digits, so that it fits into its column.
std::string milliseconds_text(Duration duration) {
  const double value = milliseconds(duration);
  return fmt::format("{:.{}f}", value, value < 9.995 ? 2 : value < 99.95 ? 1 : 0);
}

TextColour state_colour(const RobotProgress& row) {
  if (row.arrived) return TextColour::kGreen;
  if (!row.agent_state) return TextColour::kRed;
  switch (*row.agent_state) {
    case msg::AgentState::AGENT_CLOCK_OUT_OF_BOUND:
    case msg::AgentState::AGENT_ABSENT:
      return TextColour::kRed;
    case msg::AgentState::AGENT_FENCING:
    case msg::AgentState::AGENT_REGISTERING:
    case msg::AgentState::AGENT_HELD:
      return TextColour::kYellow;
    default:
      return TextColour::kNone;
  }
}

/// The parts of the progress line, the most important ones first.
std::vector<std::string> progress_parts(const RunMetrics& metrics, Time now) {
  const Report report = metrics.report();
  const auto since = metrics.granting_since();
  const double missed = report.cycles > 0 ? 100.0 * static_cast<double>(report.missed_cycles) /
                                                static_cast<double>(report.cycles)
                                          : 0;
  std::vector<std::string> parts{
      since ? fmt::format("{:5.1f} s", to_seconds(now - *since)) : "starting",
      fmt::format("{} of {} arrived", report.arrived, report.arrivals().with_goal())};
  if (report.without_goal > 0) parts.push_back(fmt::format("{} without a goal", report.without_goal));
  parts.push_back(fmt::format("{} contacts", report.contacts));
  if (metrics.conflicts() > 0) parts.push_back(fmt::format("{} in conflict", metrics.conflicts()));
  if (const std::string named = metrics.named_robots(); !named.empty()) parts.push_back(named);
  parts.push_back("clearance " +
                  (report.min_clearance_m ? fmt::format("{:.3f} m", *report.min_clearance_m) : "?"));
  parts.push_back(fmt::format("{} grants", report.grants));
  parts.push_back(fmt::format("{} denials", report.denials));
  parts.push_back(fmt::format("{:.2f} % missed", missed));
  parts.push_back(fmt::format("negotiation {:.2f} / {:.2f} ms",
                              milliseconds(report.negotiation.quantile(0.5)),
                              milliseconds(report.negotiation.quantile(0.99))));
  if (report.max_clock_offset_s)
    parts.push_back(fmt::format("clocks {:.2f} +- {:.2f} ms", *report.max_clock_offset_s * 1e3,
                                report.clock_uncertainty_s.value_or(0) * 1e3));
  return parts;
}

/// A column of the table of robots.
struct TableColumn {
  const char* title;
  int width;
  bool is_left_aligned = false;
};
/// The first ones are the most important.
constexpr std::array kTableColumns{
    TableColumn{"robot", 5},   TableColumn{"team", 6, true},    TableColumn{"state", 11, true},
    TableColumn{"to go", 8},   TableColumn{"speed", 9},         TableColumn{"grants", 7},
    TableColumn{"denials", 7}, TableColumn{"p50 / p99 ms", 12},
};
/// Replaces the last column on a wide screen.
constexpr TableColumn kWideColumn{"negotiation p50 / p99 ms", 24};
constexpr int kGap = 2;

using TableRow = std::array<std::string, kTableColumns.size()>;

/// The columns that fit into this width, at least one.
std::vector<TableColumn> fitting_columns(int width) {
  std::vector<TableColumn> columns;
  int left = width + kGap;
  for (const TableColumn& column : kTableColumns) {
    left -= kGap + column.width;
    if (left < 0 && !columns.empty()) return columns;
    columns.push_back(column);
  }
  if (left >= kWideColumn.width - columns.back().width) columns.back() = kWideColumn;
  return columns;
}

/// A line of the table; the state may have a colour.
std::string table_line(const TableRow& row, const std::vector<TableColumn>& columns, TextColour state) {
  constexpr std::size_t kState = 2;
  std::string line;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const TableColumn& column = columns[i];
    const std::string cell = column.is_left_aligned ? fmt::format("{:<{}}", row[i], column.width)
                                                    : fmt::format("{:>{}}", row[i], column.width);
    line += std::string(i == 0 ? 0 : kGap, ' ') + (i == kState ? coloured(cell, state) : cell);
  }
  return line;
}

TableRow cells_of(const RobotProgress& row) {
  return {
      fmt::format("{}", row.robot),
      row.team == Team::kBlue ? "blue" : "yellow",
      state_name(row),
      fmt::format("{:.2f} m", row.distance_to_go_m),
      fmt::format("{:.2f} m/s", row.speed_mps),
      fmt::format("{}", row.grants),
      fmt::format("{}", row.denials),
      fmt::format("{} / {}", milliseconds_text(row.negotiation_p50), milliseconds_text(row.negotiation_p99))};
}

}  // namespace

std::string progress_line(const RunMetrics& metrics, Time now) {
  return fmt::format("{}", fmt::join(progress_parts(metrics, now), "  "));
}

std::string progress_table(const RunMetrics& metrics, Time now, const ScreenSize& screen, bool has_colours) {
  // The last column stays empty, and so does the line of the cursor below the table.
  const int width = screen.columns - 1;
  std::string text = wrapped(progress_parts(metrics, now), width);
  const std::vector<TableColumn> columns = fitting_columns(width);
  TableRow titles;
  for (std::size_t i = 0; i < columns.size(); ++i) titles[i] = columns[i].title;
  text += coloured(table_line(titles, columns, TextColour::kNone),
                   has_colours ? TextColour::kBold : TextColour::kNone) +
          "\n";
  const auto rows = metrics.progress();
  const auto room =
      static_cast<std::size_t>(std::max<std::ptrdiff_t>(screen.rows - 1 - std::ranges::count(text, '\n'), 1));
  const std::size_t shown = rows.size() <= room ? rows.size() : std::max<std::size_t>(room - 1, 1);
  for (std::size_t i = 0; i < shown; ++i)
    text += table_line(cells_of(rows[i]), columns, has_colours ? state_colour(rows[i]) : TextColour::kNone) +
            "\n";
  if (shown < rows.size()) text += fmt::format("... and {} more\n", rows.size() - shown);
  return text;
}

std::string with_coloured_verdict(const std::string& summary, AuditVerdict verdict) {
  const TextColour colour = verdict == AuditVerdict::kPassed   ? TextColour::kGreen
                            : verdict == AuditVerdict::kFailed ? TextColour::kRed
                                                               : TextColour::kYellow;
  const std::size_t end = summary.find_last_not_of('\n') + 1;
  const std::size_t before = summary.substr(0, end).find_last_of('\n');
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return summary.substr(0, begin) + coloured(summary.substr(begin, end - begin), colour) +
         summary.substr(end);
}

ProgressDisplay::ProgressDisplay(std::FILE* stream)
    : stream_(stream), terminal_(terminal_of(fileno(stream))), table_(stream) {}

void ProgressDisplay::print(const std::string& line, LogLevel level) {
  table_.erase();
  const TextColour colour = level >= LogLevel::kError     ? TextColour::kRed
                            : level == LogLevel::kWarning ? TextColour::kYellow
                                                          : TextColour::kNone;
  print_to(stream_, "{}\n", terminal_.has_colours ? coloured(line, colour) : line);
  if (terminal_.can_redraw) next_ = Time{};
}

void ProgressDisplay::update(const RunMetrics& metrics, Time now) {
  if (now < next_) return;
  if (terminal_.can_redraw) {
    next_ = now + kTablePeriod;
    table_.draw(progress_table(metrics, now, screen_size(fileno(stream_)), terminal_.has_colours));
  } else {
    next_ = now + kLinePeriod;
    print_to(stream_, "{}\n", progress_line(metrics, now));
  }
}

}  // namespace sidestep
