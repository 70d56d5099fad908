// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

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
  MonitorRecorder(const MonitorRecorder&) = delete;
  MonitorRecorder& operator=(const MonitorRecorder&) = delete;

  /// Calls back with the path and the reason when a write fails, which ends the recording.
  void on_failure(std::function<void(const std::string& failure)> callback) {
    on_failure_ = std::move(callback);
  }
  bool is_recording() const { return writer_ && failure_.empty(); }
  /// The file of the recording in progress, or of the last one; empty if there was none.
  const std::string& file() const { return file_; }
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
  std::string scenario_file_, file_;
  std::function<void(const std::string&)> on_failure_;
  std::string failure_;  ///< reason of a failed write; empty: none
  std::optional<RecordingWriter> writer_;
  Time next_scene_{};
  std::map<std::uint32_t, std::uint16_t> channels_;  ///< channel ids in the file, by AnyMessage::channel
};

}  // namespace sidestep
