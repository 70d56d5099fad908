// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "common/messaging/bus.hpp"
#include "common/messaging/dds/participant.hpp"
#include "common/messaging/dds/types.hpp"
#include "common/messaging/dds/event_loop.hpp"

namespace sidestep {

/// Knows who writes our topics, and reports strangers that use one of them with another type: DDS just never
/// matches them.
class TypeMismatchListener : public eprosima::fastdds::dds::DomainParticipantListener {
 public:
  void expect(const std::string& channel, const std::string& type);
  /// When the channel's latest writer of our type that still writes came to be known; nothing when nobody
  /// writes.
  std::optional<Time> writer_since(const std::string& channel) const;

  void on_publisher_discovery(eprosima::fastdds::dds::DomainParticipant*,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) override;
  void on_subscriber_discovery(eprosima::fastdds::dds::DomainParticipant*,
                               eprosima::fastrtps::rtps::ReaderDiscoveryInfo&& info) override;

 private:
  void compare(const char* endpoint, const std::string& channel, const std::string& type);

  mutable std::mutex mutex_;
  std::map<std::string, std::string> types_;
  /// Of each channel and type, by their GUIDs.
  std::map<std::pair<std::string, std::string>, std::map<std::string, Time>> writers_;
};

/// A bus's writer of one channel.
class DdsWriter : public RawWriter, public eprosima::fastdds::dds::DataWriterListener {
 public:
  /// Throws std::runtime_error, as DdsParticipant::create_writer() does.
  DdsWriter(std::shared_ptr<DdsParticipant> participant, const TopicInfo& topic, const std::string& channel);
  ~DdsWriter() override;

  void write(const void* message) override;
  void on_offered_incompatible_qos(
      eprosima::fastdds::dds::DataWriter* writer,
      const eprosima::fastdds::dds::OfferedIncompatibleQosStatus& status) override;

 private:
  void report_failure();

  std::shared_ptr<DdsParticipant> participant_;
  eprosima::fastdds::dds::DataWriter* writer_;
  bool has_failed_ = false;
};

/// A bus's reader of one channel.
class DdsReader : public EventLoop::Source, public eprosima::fastdds::dds::DataReaderListener {
 public:
  /// Throws std::runtime_error, as DdsParticipant::create_reader() does.
  DdsReader(EventLoop& loop, std::shared_ptr<DdsParticipant> participant, const TopicInfo& topic,
            const std::string& channel, std::function<void(const void*)> callback);
  ~DdsReader() override;

  /// Reads by another participant from now on; what has not been handed over yet is lost. Goes on as before
  /// when that throws, as create_reader() does.
  void move_to(std::shared_ptr<DdsParticipant> participant);

  bool drain() override;
  std::uint64_t refused() const { return refused_; }
  std::string locators() const { return dds_locators(*reader_); }

  void on_data_available(eprosima::fastdds::dds::DataReader*) override { loop_.notify(*this); }
  void on_requested_incompatible_qos(
      eprosima::fastdds::dds::DataReader*,
      const eprosima::fastdds::dds::RequestedIncompatibleQosStatus& status) override;

 private:
  void count_refused();

  EventLoop& loop_;
  std::shared_ptr<DdsParticipant> participant_;
  Qos qos_;
  std::string channel_;
  std::function<void(const void*)> callback_;
  eprosima::fastdds::dds::TypeSupport type_;
  GuardedType::Sample* sample_;
  std::uint64_t refused_ = 0;
  std::uint64_t next_report_ = 1;
  eprosima::fastdds::dds::DataReader* reader_;
};

}  // namespace sidestep
