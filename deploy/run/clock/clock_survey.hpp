// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/messaging/clock_codec.hpp"
#include "common/time/clock_offset.hpp"

namespace sidestep {

/// Whether a clock is within the clock bound of another clock, as far as is known.
enum class ClockVerdict : std::uint8_t {
  kWithin,
  kUnclear,  ///< the interval contains offsets both within and beyond the bound
  kBeyond,
  kNotMeasured
};

/// The state of one process's clock, as far as it is known.
struct ClockRow {
  std::uint32_t process = 0;
  std::string host;                      ///< empty until the process has answered
  std::optional<OffsetInterval> offset;  ///< offset of its clock from the reference clock
  /// Round-trip time of its quickest recent answer, minus the time that the process took to answer.
  Duration round_trip{0};
  ClockVerdict verdict = ClockVerdict::kNotMeasured;
  Duration host_ahead{0};               ///< its host's clock minus its own clock
  std::optional<OffsetInterval> robot;  ///< for an agent: its robot's clock minus the coordinator's
};

/// Collects the answers to the probes of one client.
class ClockSurvey {
 public:
  /// A process that has been silent for this long is left out.
  static constexpr Duration kSilence{5'000'000'000};
  static constexpr Duration kMaxMeasurementAge{2'000'000'000};

  explicit ClockSurvey(std::uint32_t client) : client_(client) {}

  /// Records that a probe with this time stamp has been sent.
  void on_probe(Time sent) { probes_[probe_count_++ % probes_.size()] = sent; }
  /// Ignores answers to other clients, and to probes that were not sent.
  void on_answer(const ClockAnswer& answer, Time received);
  /// Records that a process was heard, which gives it a row even if it has not answered any probe.
  void on_heard(std::uint32_t process, Time now);
  /// Records the offset of a robot's clock as measured by its agent; nullopt: not measured.
  void on_robot_clock(RobotId robot, const std::optional<OffsetInterval>& offset, Time now);

  /// One row per process, sorted by id. The offsets are relative to the clock of `reference`, or else to the
  /// client's own clock. If the reference has not been measured, no row has an offset.
  std::vector<ClockRow> rows(Time now, std::optional<std::uint32_t> reference) const;

 private:
  struct Measured {
    Incarnation incarnation = 0;
    ClockOffset offset;
    Duration round_trip{0};  ///< the shortest one since round_trip_at
    Time round_trip_at;
    double clock_bound_s = 0;
    std::string host;
    Duration host_ahead{0};
  };
  struct Process {
    Time heard;
    std::optional<Measured> measured;
    std::optional<OffsetInterval> robot;
  };
  ClockRow row_of(std::uint32_t id, const Process& process, Time now) const;

  std::uint32_t client_;
  std::array<Time, 64> probes_{};
  std::size_t probe_count_ = 0;
  std::map<std::uint32_t, Process> processes_;
};

/// Whether every process has been measured and none is beyond the bound. False if there are no processes.
[[nodiscard]] bool all_agree(const std::vector<ClockRow>& rows);

}  // namespace sidestep
