// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/clock/clock_survey.hpp"

#include <algorithm>

namespace sidestep {
namespace {

ClockVerdict judge(const OffsetInterval& offset, Duration bound) {
  if (offset.is_beyond(bound)) return ClockVerdict::kBeyond;
  return offset.low >= -bound && offset.high <= bound ? ClockVerdict::kWithin : ClockVerdict::kUnclear;
}

}  // namespace

void ClockSurvey::on_answer(const ClockAnswer& answer, Time received) {
  const bool is_asked =
      answer.probe_sent != Time{} && std::ranges::find(probes_, answer.probe_sent) != probes_.end();
  if (answer.client != client_ || !is_asked) return;
  Process& process = processes_[answer.process];
  // An answer from an earlier run of a process counts only if the later run has fallen silent.
  const bool is_silent = received - process.heard > kMaxMeasurementAge;
  if (process.measured && answer.incarnation < process.measured->incarnation && !is_silent) return;
  if (!process.measured || answer.incarnation != process.measured->incarnation) {
    process.measured.emplace();
    process.measured->incarnation = answer.incarnation;
  }
  process.heard = received;
  Measured& measured = *process.measured;
  if (!measured.offset.add({answer.probe_sent, answer.probe_received, answer.answered, received})) return;
  const Duration round_trip = received - answer.probe_sent - (answer.answered - answer.probe_received);
  if (received - measured.round_trip_at > kMaxMeasurementAge || round_trip <= measured.round_trip) {
    measured.round_trip = round_trip;
    measured.round_trip_at = received;
  }
  measured.clock_bound_s = answer.clock_bound_s;
  measured.host = answer.host;
  measured.host_ahead = answer.host_ahead;
}

void ClockSurvey::on_heard(std::uint32_t process, Time now) { processes_[process].heard = now; }

void ClockSurvey::on_robot_clock(RobotId robot, const std::optional<OffsetInterval>& offset, Time now) {
  Process& agent = processes_[robot];
  agent.heard = now;
  agent.robot = offset;
}

ClockRow ClockSurvey::row_of(std::uint32_t id, const Process& process, Time now) const {
  ClockRow row;
  row.process = id;
  row.robot = process.robot;
  if (!process.measured) return row;
  row.host = process.measured->host;
  row.round_trip = process.measured->round_trip;
  row.host_ahead = process.measured->host_ahead;
  row.offset = process.measured->offset.at(now, kMaxMeasurementAge);
  return row;
}

std::vector<ClockRow> ClockSurvey::rows(Time now, std::optional<std::uint32_t> reference) const {
  std::optional<OffsetInterval> zero = OffsetInterval{};
  if (reference) {
    const auto found = processes_.find(*reference);
    zero = found == processes_.end() ? std::nullopt : row_of(*reference, found->second, now).offset;
  }
  std::vector<ClockRow> result;
  for (const auto& [id, process] : processes_) {
    if (now - process.heard > kSilence) continue;
    ClockRow row = row_of(id, process, now);
    const bool is_reference = id == reference;
    if (row.offset && zero)
      row.offset = is_reference ? OffsetInterval{} : difference(*row.offset, *zero);
    else
      row.offset.reset();
    if (row.offset) row.verdict = judge(*row.offset, from_seconds(process.measured->clock_bound_s));
    result.push_back(std::move(row));
  }
  return result;
}

bool all_agree(const std::vector<ClockRow>& rows) {
  return !rows.empty() && std::ranges::all_of(rows, [](const ClockRow& row) {
    return row.verdict == ClockVerdict::kWithin || row.verdict == ClockVerdict::kUnclear;
  });
}

}  // namespace sidestep
