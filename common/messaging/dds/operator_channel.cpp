// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/operator_channel.hpp"

#include <algorithm>

#include "common/messaging/dds/directory.hpp"
#include "common/messaging/dds/matched_readers.hpp"
#include "common/messaging/dds/participant.hpp"
#include "common/messaging/dds/types.hpp"

namespace sidestep {
namespace {

using namespace fast_dds::dds;
using fast_dds::rtps::GUID_t;

DdsSettings operator_settings(DdsSettings settings) {
  settings.is_operator = true;
  settings.faults = false;
  return settings;
}

}  // namespace

struct OperatorChannel::Impl : RawWriter {
  Impl(const DdsSettings& settings, const TopicInfo& topic)
      : participant(operator_settings(settings), &directory),
        data_writer(participant.create_writer(channel_name(topic, 0),
                                              TypeSupport(new GuardedType(topic.type)),
                                              dds_writer_qos(topic.qos), &subscribers)) {}
  ~Impl() override { participant.delete_writer(data_writer); }

  void write(const void* message) override {
    GuardedType::Sample sample{const_cast<void*>(message), true};
    if (!fast_dds::write(*data_writer, &sample))
      throw std::runtime_error("DDS failed to send the operator's message");
  }

  DdsDirectory directory;
  MatchedReaders subscribers;
  DdsParticipant participant;
  DataWriter* data_writer;
};

OperatorChannel::OperatorChannel(const DdsSettings& settings, const TopicInfo& topic)
    : impl_(std::make_unique<Impl>(settings, topic)) {}
OperatorChannel::~OperatorChannel() = default;

std::vector<std::string> OperatorChannel::subscribers() const {
  std::vector<std::string> names;
  for (const GUID_t& guid : impl_->subscribers.guids()) {
    names.push_back(impl_->directory.participant_of(guid));
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool OperatorChannel::has_writer(const std::string& channel) const {
  const auto all = impl_->directory.endpoints();
  return std::any_of(all.begin(), all.end(), [&](const DiscoveredEndpoint& endpoint) {
    return endpoint.is_writer && endpoint.topic == channel;
  });
}

RawWriter& OperatorChannel::writer() { return *impl_; }

bool OperatorChannel::wait_until_acknowledged(Duration timeout) {
  const auto whole_s = std::chrono::duration_cast<std::chrono::seconds>(timeout);
  const fast_dds::Duration_t wait(static_cast<std::int32_t>(whole_s.count()),
                                  static_cast<std::uint32_t>((timeout - whole_s).count()));
  return fast_dds::is_ok(impl_->data_writer->wait_for_acknowledgments(wait));
}

}  // namespace sidestep
