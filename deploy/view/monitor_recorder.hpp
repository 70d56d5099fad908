// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>

#include "common/config/scenario.hpp"
#include "deploy/inspect/floor/floor_state.hpp"
#include "deploy/inspect/record/recording.hpp"

namespace sidestep {

/// Records the messages that the monitor receives; recording can start and stop at any time.
class MonitorRecorder {
 public:
  /// The scenario must outlive this object.
  MonitorRecorder(const Scenario& scenario, const std::string& scenario_file)
      : scenario_(scenario), scenario_file_(scenario_file) {}

  bool is_recording() const { return writer_.has_value(); }
  /// Precondition: no recording is in progress. Throws std::runtime_error if the file cannot be written.
  void start(const std::string& path);
  /// Finishes the recording. Throws std::runtime_error if a write has failed.
  void stop();
  void add(const AnyMessage& message, Time now);
  void add_scene(const FloorState& floor, Time now);
  void add_event(Time at, const std::string& kind, const std::string& text);
  /// Writes what has been added so far to the file.
  void flush();

 private:
  const Scenario& scenario_;
  std::string scenario_file_;
  std::optional<RecordingWriter> writer_;
  Time next_scene_{};
  std::map<std::uint32_t, std::uint16_t> channels_;  ///< channel ids in the file, by AnyMessage::channel
};

}  // namespace sidestep
