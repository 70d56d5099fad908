// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/endpoints.hpp"

#include <algorithm>
#include <fastdds/dds/topic/TopicDescription.hpp>
#include <fmt/core.h>
#include <utility>

namespace sidestep {

using namespace fast_dds::dds;

namespace {

GuardedType& guarded(const TypeSupport& type) { return static_cast<GuardedType&>(*type); }

}  // namespace

DdsWriter::DdsWriter(std::shared_ptr<DdsParticipant> participant, const TopicInfo& topic,
                     const std::string& channel)
    : participant_(std::move(participant)),
      writer_(participant_->create_writer(channel, TypeSupport(new GuardedType(topic.type)),
                                          dds_writer_qos(topic.qos), this)) {}

DdsWriter::~DdsWriter() { participant_->delete_writer(writer_); }

void DdsWriter::write(const void* message) {
  GuardedType::Sample sample{const_cast<void*>(message), true};
  if (!fast_dds::write(*writer_, &sample)) report_failure();
}

void DdsWriter::on_offered_incompatible_qos(DataWriter* writer, const OfferedIncompatibleQosStatus& status) {
  log_dds(fmt::format("topic '{}': a reader requests more than this writer offers, policy {}",
                      writer->get_topic()->get_name(), dds_policy_name(status.last_policy_id)));
}

void DdsWriter::report_failure() {
  if (std::exchange(has_failed_, true)) return;
  log_dds(fmt::format("topic '{}': DDS failed to send a message", writer_->get_topic()->get_name()));
}

DdsReader::DdsReader(EventLoop& loop, std::shared_ptr<DdsParticipant> participant, const TopicInfo& topic,
                     const std::string& channel, std::function<void(const void*)> callback)
    : loop_(loop),
      participant_(std::move(participant)),
      topic_(topic),
      channel_(channel),
      robot_(channel_robot(topic, channel).value_or(0)),
      callback_(std::move(callback)),
      type_(new GuardedType(topic.type)),
      sample_(static_cast<GuardedType::Sample*>(guarded(type_).make_sample())),
      reader_(participant_->create_reader(channel, type_, participant_->reader_qos(topic.qos), this)) {}

DdsReader::~DdsReader() {
  participant_->delete_reader(reader_);
  guarded(type_).delete_sample(sample_);
}

void DdsReader::move_to(std::shared_ptr<DdsParticipant> participant) {
  DataReader* const next =
      participant->create_reader(channel_, type_, participant->reader_qos(topic_.qos), this);
  participant_->delete_reader(reader_);
  participant_ = std::move(participant);
  reader_ = next;
}

bool DdsReader::drain() {
  constexpr int kMaxBatch = 64;
  SampleInfo info;
  for (int i = 0; i < kMaxBatch && !loop_.stopped(); ++i) {
    if (!fast_dds::is_ok(reader_->take_next_sample(sample_, &info))) return false;
    if (!info.valid_data) continue;
    if (!sample_->is_valid)
      count_refused();
    else if (is_genuine(info))
      callback_(sample_->message);
  }
  return true;
}

void DdsReader::on_requested_incompatible_qos(DataReader*, const RequestedIncompatibleQosStatus& status) {
  log_dds(fmt::format("topic '{}': a writer offers less than this reader requests, policy {}", channel_,
                      dds_policy_name(status.last_policy_id)));
}

bool DdsReader::is_genuine(const SampleInfo& info) {
  ParticipantFilter* const filter = participant_->filter();
  if (!filter || !topic_.type.sender) return true;
  ParticipantId writer;
  std::ranges::copy(info.sample_identity.writer_guid().guidPrefix.value, writer.begin());
  return filter->may_send(writer, topic_, robot_, topic_.type.sender(sample_->message));
}

void DdsReader::count_refused() {
  if (++refused_ < next_report_) return;
  next_report_ *= 10;
  log_dds(fmt::format("topic '{}': {} unreadable message(s) refused so far", channel_, refused_));
}

}  // namespace sidestep
