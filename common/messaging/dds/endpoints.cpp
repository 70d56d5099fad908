// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/endpoints.hpp"

#include <algorithm>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/topic/TopicDescription.hpp>
#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>
#include <fmt/core.h>
#include <sstream>
#include <utility>

namespace sidestep {

using namespace eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::ReaderDiscoveryInfo;
using eprosima::fastrtps::rtps::WriterDiscoveryInfo;

void TypeMismatchListener::expect(const std::string& channel, const std::string& type) {
  const std::lock_guard lock(mutex_);
  types_[channel] = type;
}

std::optional<Time> TypeMismatchListener::writer_since(const std::string& channel) const {
  const std::lock_guard lock(mutex_);
  std::optional<Time> latest;
  const auto own = types_.find(channel);
  if (own == types_.end()) return latest;
  if (const auto writers = writers_.find(*own); writers != writers_.end()) {
    for (const auto& [guid, since] : writers->second) latest = std::max(latest.value_or(since), since);
  }
  return latest;
}

void TypeMismatchListener::on_publisher_discovery(DomainParticipant*, WriterDiscoveryInfo&& info) {
  const std::string channel = info.info.topicName().to_string(), type = info.info.typeName().to_string();
  std::ostringstream guid;
  guid << info.info.guid();
  const std::lock_guard lock(mutex_);
  if (info.status == WriterDiscoveryInfo::REMOVED_WRITER) {
    writers_[{channel, type}].erase(guid.str());
  } else if (info.status == WriterDiscoveryInfo::DISCOVERED_WRITER) {
    writers_[{channel, type}].emplace(guid.str(), EventLoop::now());
    compare("writer", channel, type);
  }
}

void TypeMismatchListener::on_subscriber_discovery(DomainParticipant*, ReaderDiscoveryInfo&& info) {
  if (info.status != ReaderDiscoveryInfo::DISCOVERED_READER) return;
  const std::lock_guard lock(mutex_);
  compare("reader", info.info.topicName().to_string(), info.info.typeName().to_string());
}

void TypeMismatchListener::compare(const char* endpoint, const std::string& channel, const std::string& type) {
  const auto own = types_.find(channel);
  if (own == types_.end() || own->second == type) return;
  log_dds(fmt::format("topic '{}': a {} has type {} and is ignored, ours is {}", channel, endpoint, type,
                      own->second));
}

DdsWriter::DdsWriter(std::shared_ptr<DdsParticipant> participant, const TopicInfo& topic,
                     const std::string& channel)
    : participant_(std::move(participant)),
      writer_(participant_->create_writer(channel, TypeSupport(make_dds_type(topic.type).release()),
                                          dds_writer_qos(topic.qos), this)) {}

DdsWriter::~DdsWriter() { participant_->delete_writer(writer_); }

void DdsWriter::write(const void* message) {
  GuardedType::Sample sample{const_cast<void*>(message), true};
  if (!writer_->write(&sample)) report_failure();
}

void DdsWriter::on_offered_incompatible_qos(DataWriter* writer, const OfferedIncompatibleQosStatus& status) {
  log_dds(fmt::format("topic '{}': a reader asks for more than this writer offers, policy {}",
                      writer->get_topic()->get_name(), dds_policy_name(status.last_policy_id)));
}

void DdsWriter::report_failure() {
  if (std::exchange(has_failed_, true)) return;
  log_dds(fmt::format("topic '{}': DDS refused to send a message", writer_->get_topic()->get_name()));
}

DdsReader::DdsReader(EventLoop& loop, std::shared_ptr<DdsParticipant> participant, const TopicInfo& topic,
                     const std::string& channel, std::function<void(const void*)> callback)
    : loop_(loop),
      participant_(std::move(participant)),
      qos_(topic.qos),
      channel_(channel),
      callback_(std::move(callback)),
      type_(make_dds_type(topic.type).release()),
      sample_(static_cast<GuardedType::Sample*>(type_.create_data())),
      reader_(participant_->create_reader(channel, type_, dds_reader_qos(topic.qos), this)) {}

DdsReader::~DdsReader() {
  participant_->delete_reader(reader_);
  type_.delete_data(sample_);
}

void DdsReader::move_to(std::shared_ptr<DdsParticipant> participant) {
  DataReader* const next = participant->create_reader(channel_, type_, dds_reader_qos(qos_), this);
  participant_->delete_reader(reader_);
  participant_ = std::move(participant);
  reader_ = next;
}

bool DdsReader::drain() {
  constexpr int kMostAtOnce = 64;
  SampleInfo info;
  for (int i = 0; i < kMostAtOnce && !loop_.stopped(); ++i) {
    if (reader_->take_next_sample(sample_, &info) != ReturnCode_t::RETCODE_OK) return false;
    if (!info.valid_data) continue;
    if (sample_->is_valid) {
      callback_(sample_->message);
    } else {
      count_refused();
    }
  }
  return true;
}

void DdsReader::on_requested_incompatible_qos(DataReader*, const RequestedIncompatibleQosStatus& status) {
  log_dds(fmt::format("topic '{}': a writer offers less than this reader asks for, policy {}", channel_,
                      dds_policy_name(status.last_policy_id)));
}

void DdsReader::count_refused() {
  if (++refused_ < next_report_) return;
  next_report_ *= 10;
  log_dds(fmt::format("topic '{}': {} unreadable message(s) refused so far", channel_, refused_));
}

}  // namespace sidestep
