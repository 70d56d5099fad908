// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <functional>
#include <memory>
#include <string>

#include "common/messaging/bus.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "common/messaging/dds/participant.hpp"
#include "common/messaging/dds/types.hpp"

namespace sidestep {

/// A bus's writer of one channel.
class DdsWriter : public RawWriter, public fast_dds::dds::DataWriterListener {
 public:
  /// Throws std::runtime_error if DdsParticipant::create_writer() does.
  DdsWriter(std::shared_ptr<DdsParticipant> participant, const TopicInfo& topic, const std::string& channel);
  ~DdsWriter() override;

  void write(const void* message) override;
  void on_offered_incompatible_qos(fast_dds::dds::DataWriter* writer,
                                   const fast_dds::dds::OfferedIncompatibleQosStatus& status) override;

 private:
  void report_failure();

  std::shared_ptr<DdsParticipant> participant_;
  fast_dds::dds::DataWriter* writer_;
  bool has_failed_ = false;
};

/// A bus's reader of one channel.
class DdsReader : public EventLoop::Source, public fast_dds::dds::DataReaderListener {
 public:
  /// Throws std::runtime_error if DdsParticipant::create_reader() does.
  DdsReader(EventLoop& loop, std::shared_ptr<DdsParticipant> participant, const TopicInfo& topic,
            const std::string& channel, std::function<void(const void*)> callback);
  ~DdsReader() override;

  /// Moves the reader to another participant; samples that were not taken yet are lost. If this throws, as
  /// create_reader() may, the reader is unchanged.
  void move_to(std::shared_ptr<DdsParticipant> participant);

  bool drain() override;
  /// Number of samples dropped because their payload was invalid.
  std::uint64_t refused() const { return refused_; }
  std::string locators() const { return dds_locators(*reader_); }

  void on_data_available(fast_dds::dds::DataReader*) override { loop_.notify(*this); }
  void on_requested_incompatible_qos(fast_dds::dds::DataReader*,
                                     const fast_dds::dds::RequestedIncompatibleQosStatus& status) override;

 private:
  void count_refused();
  /// Whether the keys of the sample's writer permit it to send the message.
  bool is_genuine(const fast_dds::dds::SampleInfo& info);

  EventLoop& loop_;
  std::shared_ptr<DdsParticipant> participant_;
  TopicInfo topic_;
  std::string channel_;
  std::uint32_t robot_;  ///< the robot of a per-robot channel
  std::function<void(const void*)> callback_;
  fast_dds::dds::TypeSupport type_;  ///< a GuardedType
  GuardedType::Sample* sample_;
  std::uint64_t refused_ = 0;
  std::uint64_t next_report_ = 1;
  fast_dds::dds::DataReader* reader_;
};

}  // namespace sidestep
