// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/record/recording.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <type_traits>

#include "common/json/json_text.hpp"
#include "common/map/map_file.hpp"
#include "common/messaging/cdr.hpp"
#include "common/messaging/message_schema.hpp"
#include "deploy/inspect/floor/foxglove_scene.hpp"

namespace sidestep {
namespace {

constexpr Duration kFlushPeriod = std::chrono::seconds(1);

/// The encapsulation header of little-endian CDR, which precedes every message, as on the wire.
constexpr std::array<std::uint8_t, 4> kEncapsulation{0, 1, 0, 0};

/// Whether the 3-D scenes show data of this message.
template <typename Message>
constexpr bool kIsInScene =
    std::is_same_v<Message, msg::GroundTruth> || std::is_same_v<Message, msg::WorldState> ||
    std::is_same_v<Message, msg::Feedback> || std::is_same_v<Message, msg::ObstacleList>;

std::uint64_t unsigned_ns(std::int64_t ns) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(ns, 0));
}

McapAttachment attachment(const std::string& name, const std::string& media_type, const std::string& text) {
  return {0, name, media_type, {text.begin(), text.end()}};
}

}  // namespace

RecordingHeader recording_header(const Scenario& scenario, const std::string& scenario_file) {
  std::ifstream file(scenario_file);
  RecordingHeader header{scenario.name, {std::istreambuf_iterator<char>(file), {}}, {}, false};
  if (scenario.map) header.map = {scenario.map, &scenario.map->cells()};
  if (!file) throw std::runtime_error(scenario_file + ": cannot be read");
  return header;
}

RecordingWriter::RecordingWriter(const std::string& path, const RecordingHeader& header,
                                 const McapWriterSettings& settings)
    : mcap_(path, settings) {
  mcap_.add_metadata(
      {kRecordingMetadata,
       {{"scenario", header.scenario_name}, {"complete", header.is_complete ? "true" : "false"}}});
  mcap_.add_attachment(attachment(kScenarioFile, "application/yaml", header.scenario_text));
  if (!header.map) return;
  const MapFiles files = map_files(*header.map, kMapImageFile);
  mcap_.add_attachment(attachment(kMapFile, "application/yaml", files.yaml));
  mcap_.add_attachment(attachment(kMapImageFile, "image/x-portable-graymap", files.image));
}

std::uint16_t RecordingWriter::add_channel(const TopicInfo& topic, const std::string& channel) {
  const std::string type = topic.type.name;
  if (!schemas_.contains(type)) schemas_[type] = mcap_.add_schema({type, "omgidl", message_schema(type)});
  return mcap_.add_channel({schemas_[type], channel, "cdr", {}});
}

void RecordingWriter::add(Time received, const TopicInfo& topic, std::uint16_t channel,
                          const msg::Header& header, const void* message) {
  const McapMessage head{channel, static_cast<std::uint32_t>(header.message_number()),
                         unsigned_ns(to_ns(received)), unsigned_ns(header.stamp_ns())};
  mcap_.add_message(head, [&](McapBytes& bytes) {
    bytes.insert(bytes.end(), kEncapsulation.begin(), kEncapsulation.end());
    append_cdr(topic, message, bytes);
  });
}

std::uint16_t RecordingWriter::json_channel(const std::string& topic, const std::string& type) {
  const auto known = json_channels_.find(topic);
  if (known != json_channels_.end()) return known->second;
  const std::uint16_t schema = mcap_.add_schema({type, "jsonschema", kJsonSchema});
  return json_channels_[topic] = mcap_.add_channel({schema, topic, "json", {}});
}

void RecordingWriter::add_scene(Time now, const FloorState& floor, double radius_m) {
  const auto add = [&](const char* topic, const char* type, const nlohmann::json& json) {
    const std::string text = json_text(json);
    const std::uint64_t at_ns = unsigned_ns(to_ns(now));
    mcap_.add_message({json_channel(topic, type), scenes_, at_ns, at_ns},
                      [&](McapBytes& bytes) { bytes.insert(bytes.end(), text.begin(), text.end()); });
  };
  ++scenes_;
  add(kSceneTopic, kSceneType, scene_update(floor, radius_m, now));
  add(kTransformsTopic, kTransformsType, frame_transforms(floor, now));
}

void RecordingWriter::add_event(Time at, const std::string& kind, const std::string& text) {
  mcap_.add_metadata(
      {kEventMetadata, {{"at_ns", std::to_string(to_ns(at))}, {"kind", kind}, {"text", text}}});
}

void RecordingWriter::add_report(Time now, const std::string& json) {
  McapAttachment report = attachment(kReportFile, "application/json", json);
  report.logged_ns = unsigned_ns(to_ns(now));
  mcap_.add_attachment(report);
}

void record(Bus& bus, const Scenario& scenario, RecordingWriter& writer) {
  const auto floor = std::make_shared<FloorState>();
  for_each_topic([&]<typename Message>(const Topic<Message>& topic) {
    if (topic.qos == Qos::kImage) return;
    std::vector<RobotId> robots{0};
    if (topic.per_robot) {
      robots.clear();
      for (const RobotSpec& spec : scenario.robots) robots.push_back(spec.id);
    }
    for (const RobotId robot : robots) {
      const std::uint16_t channel = writer.add_channel(topic, channel_name(topic, robot));
      bus.observe<Message>(topic, robot, [&bus, &writer, topic, channel, floor](const Message& message) {
        const Time now = bus.now();
        writer.add(now, topic, channel, message.header(), &message);
        if constexpr (kIsInScene<Message>) floor->on(message, now);
      });
    }
  });
  call_periodically(bus, RecordingWriter::scene_period(scenario.robots.size()),
                    [&bus, &writer, floor, radius_m = scenario.radius_m] {
                      writer.add_scene(bus.now(), *floor, radius_m);
                    });
  call_periodically(bus, kFlushPeriod, [&writer] { writer.flush(); });
}

}  // namespace sidestep
