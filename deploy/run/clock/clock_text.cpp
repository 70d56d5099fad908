// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/clock/clock_text.hpp"

#include <cmath>
#include <fmt/format.h>

#include "common/protocol/process_names.hpp"

namespace sidestep {
namespace {

constexpr double kSecondsFrom_s = 10;
// The host's clock and the process's clock are not read at exactly the same time, and time daemons slew.
constexpr Duration kMinClockStep{1'000'000};

const char* verdict_text(ClockVerdict verdict) {
  switch (verdict) {
    case ClockVerdict::kWithin:
      return "within";
    case ClockVerdict::kUnclear:
      return "unclear";
    case ClockVerdict::kBeyond:
      return "beyond";
    case ClockVerdict::kNotMeasured:
      break;
  }
  return "not measured";
}

std::string offset_text(const std::optional<OffsetInterval>& offset) {
  if (!offset) return "-";
  const double middle_s = to_seconds(offset->middle()), uncertainty_s = to_seconds(offset->uncertainty());
  return std::abs(middle_s) < kSecondsFrom_s
             ? fmt::format("{:+.3f} ± {:.3f} ms", 1e3 * middle_s, 1e3 * uncertainty_s)
             : fmt::format("{:+.1f} s", middle_s);
}

std::string note(const ClockRow& row) {
  if (row.host_ahead < kMinClockStep && row.host_ahead > -kMinClockStep) return {};
  return fmt::format("  its host's clock has been set by {:+.3f} s since it started",
                     to_seconds(row.host_ahead));
}

std::string round_trip_text(const ClockRow& row) {
  return row.offset ? fmt::format("{:.3f}", 1e3 * to_seconds(row.round_trip)) : "-";
}

}  // namespace

std::string to_table(const std::vector<ClockRow>& rows, const std::string& reference) {
  // The verdict, and what it rests on, stay in a terminal of 80 columns.
  constexpr const char* kLine = "{:<14} {:<12} {:>24} {:>24} {:<16} {:>13}{}\n";
  std::string table = fmt::format("offsets from the clock of {}\n", reference);
  table += fmt::format(kLine, "process", "clock bound", "offset", "robot - coordinator", "host",
                       "round trip ms", "");
  for (const ClockRow& row : rows) {
    table += fmt::format(kLine, process_name(row.process), verdict_text(row.verdict), offset_text(row.offset),
                         offset_text(row.robot), row.host.empty() ? "-" : row.host, round_trip_text(row),
                         note(row));
  }
  return table;
}

}  // namespace sidestep
