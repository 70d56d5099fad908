// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/type_mismatch_listener.hpp"

#include <algorithm>
#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>
#include <fmt/core.h>
#include <sstream>

#include "common/messaging/dds/event_loop.hpp"
#include "common/messaging/dds/participant.hpp"

namespace sidestep {

using eprosima::fastdds::dds::DomainParticipant;
using eprosima::fastrtps::rtps::ReaderDiscoveryInfo;
using eprosima::fastrtps::rtps::WriterDiscoveryInfo;

void TypeMismatchListener::expect(const std::string& channel, const std::string& type) {
  const std::lock_guard lock(mutex_);
  types_[channel] = type;
}

std::optional<Time> TypeMismatchListener::latest_writer_since(const std::string& channel) const {
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

void TypeMismatchListener::compare(const char* endpoint, const std::string& channel,
                                   const std::string& type) {
  const auto own = types_.find(channel);
  if (own == types_.end() || own->second == type) return;
  log_dds(fmt::format("topic '{}': a {} has type {} and is ignored, ours is {}", channel, endpoint, type,
                      own->second));
}

}  // namespace sidestep
