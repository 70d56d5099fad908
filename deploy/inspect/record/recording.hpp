// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "deploy/inspect/floor/floor_state.hpp"
#include "deploy/inspect/record/mcap/mcap_writer.hpp"

namespace sidestep {

/// Names of the metadata in our recordings.
inline constexpr const char* kRecordingMetadata = "sidestep";
inline constexpr const char* kEventMetadata = "sidestep event";
// Names of the attachments.
inline constexpr const char *kScenarioFile = "scenario.yaml", *kMapFile = "map.yaml",
                            *kMapImageFile = "map.pgm", *kReportFile = "report.json";

/// A recording's description of its run.
struct RecordingHeader {
  std::string scenario_name;
  std::string scenario_text;                ///< content of the scenario file
  std::shared_ptr<const OccupancyMap> map;  ///< the scenario's map
  bool is_complete = false;  ///< contains every message from the start on, with its sending time
};

/// The header of an incomplete recording. Throws std::runtime_error if the scenario file cannot be read.
[[nodiscard]] RecordingHeader recording_header(const Scenario& scenario, const std::string& scenario_file);

/// Writes messages with their reception times to an MCAP file, as CDR with the IDL of their types. The header
/// is written as the metadata "sidestep" and the attachments scenario.yaml, map.yaml and map.pgm.
class RecordingWriter {
 public:
  /// Throws std::runtime_error with the reason when the file cannot be written.
  RecordingWriter(const std::string& path, const RecordingHeader& header,
                  const McapWriterSettings& settings = {});

  /// Returns the channel's id.
  std::uint16_t add_channel(const TopicInfo& topic, const std::string& channel);
  void add(Time received, const TopicInfo& topic, std::uint16_t channel, const msg::Header& header,
           const void* message);
  /// Adds the floor for the 3-D panels of Lichtblick and Foxglove, on separate channels.
  void add_scene(Time now, const FloorState& floor, double radius_m);
  /// The recommended period of scenes, which limits the size of the file.
  static Duration scene_period(std::size_t robots) {
    return std::max<Duration>(std::chrono::milliseconds(250), robots * std::chrono::milliseconds(5));
  }
  /// Adds an event that no message describes, for example a bookmark, as metadata with the name
  /// kEventMetadata and the keys at_ns, kind and text.
  void add_event(Time at, const std::string& kind, const std::string& text);
  /// Attaches the report of the run.
  void add_report(Time now, const std::string& json);
  /// Writes what has been added so far to the file.
  void flush() { mcap_.end_chunk(); }
  /// See McapWriter.
  void on_failure(std::function<void(const std::string& failure)> callback) {
    mcap_.on_failure(std::move(callback));
  }
  const std::string& failure() const { return mcap_.failure(); }
  std::uint64_t messages() const { return mcap_.messages(); }
  /// Finishes the file. Throws std::runtime_error if any write has failed.
  void close() { mcap_.close(); }

 private:
  McapWriter mcap_;
  std::uint16_t json_channel(const std::string& topic, const std::string& type);

  std::map<std::string, std::uint16_t> schemas_;        // indexed by type
  std::map<std::string, std::uint16_t> json_channels_;  // indexed by topic
  std::uint32_t scenes_ = 0;
};

/// Subscribes to all channels of all topics except camera images (about 100 MB/s), and records their messages
/// until the bus stops. At most a second of messages is lost if the process is killed. The writer must
/// outlive the bus.
void record(Bus& bus, const Scenario& scenario, RecordingWriter& writer);

}  // namespace sidestep
