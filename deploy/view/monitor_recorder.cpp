// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor_recorder.hpp"

namespace sidestep {

void MonitorRecorder::start(const std::string& path) {
  channels_.clear();
  failure_.clear();
  writer_.emplace(path, recording_header(scenario_, scenario_file_));
  file_ = path;
  writer_->on_failure([this](const std::string& failure) {
    failure_ = failure;
    if (on_failure_) on_failure_(failure);
  });
}

void MonitorRecorder::stop() {
  if (!writer_) return;
  RecordingWriter writer = std::move(*writer_);
  writer_.reset();
  writer.close();
}

void MonitorRecorder::add(const AnyMessage& message, Time now) {
  if (!is_recording()) return;
  auto channel = channels_.find(message.channel);
  if (channel == channels_.end())
    channel =
        channels_.emplace(message.channel, writer_->add_channel(message.topic, message.channel_name)).first;
  writer_->add(now, message.topic, channel->second, message.header, message.message);
}

void MonitorRecorder::add_scene(const FloorState& floor, Time now) {
  if (!is_recording() || now < next_scene_) return;
  next_scene_ = now + RecordingWriter::scene_period(scenario_.robots.size());
  writer_->add_scene(now, floor, scenario_.radius_m);
}

void MonitorRecorder::add_event(Time at, const std::string& kind, const std::string& text) {
  if (is_recording()) writer_->add_event(at, kind, text);
}

void MonitorRecorder::flush() {
  if (is_recording()) writer_->flush();
}

}  // namespace sidestep
