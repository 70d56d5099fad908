// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <memory>
#include <string>

#include "common/messaging/dds/dds_bus.hpp"
#include "common/messaging/impairment.hpp"

namespace sidestep {

/// A participant set up as dds.md decides, with one publisher and one subscriber. Destroying it deletes
/// whatever it has created.
class DdsParticipant {
 public:
  /// The listener, if any, must outlive the participant. With shared memory, so many bytes for what it
  /// writes, participants on one host that have some use it, and nothing goes from one to the other by UDP,
  /// even if their memory is not the same (containers); no fault reaches it. Throws std::runtime_error,
  /// saying what is wrong.
  DdsParticipant(const DdsSettings& settings, eprosima::fastdds::dds::DomainParticipantListener* listener,
                 std::uint32_t shared_memory_bytes = 0);
  ~DdsParticipant();
  DdsParticipant(const DdsParticipant&) = delete;
  DdsParticipant& operator=(const DdsParticipant&) = delete;

  /// Whether a type of this name was registered by an earlier create call.
  bool has_type(const std::string& name) const;
  /// `type` is registered unless another of its name is already. Throws std::runtime_error, naming the topic.
  eprosima::fastdds::dds::DataWriter* create_writer(const std::string& channel,
                                                    eprosima::fastdds::dds::TypeSupport type,
                                                    const eprosima::fastdds::dds::DataWriterQos& qos,
                                                    eprosima::fastdds::dds::DataWriterListener* listener);
  eprosima::fastdds::dds::DataReader* create_reader(const std::string& channel,
                                                    eprosima::fastdds::dds::TypeSupport type,
                                                    const eprosima::fastdds::dds::DataReaderQos& qos,
                                                    eprosima::fastdds::dds::DataReaderListener* listener);
  void delete_writer(eprosima::fastdds::dds::DataWriter* writer);
  void delete_reader(eprosima::fastdds::dds::DataReader* reader);
  /// As DdsBus::impair.
  void impair(const LinkQuality& quality, std::uint64_t seed) { impairment_->set(quality, seed); }

 private:
  eprosima::fastdds::dds::Topic* topic(const std::string& channel, eprosima::fastdds::dds::TypeSupport type);

  std::shared_ptr<Impairment> impairment_;  ///< null without DdsSettings::faults
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
};

eprosima::fastdds::dds::DataWriterQos dds_writer_qos(Qos qos);
eprosima::fastdds::dds::DataReaderQos dds_reader_qos(Qos qos);
/// The addresses that the reader really listens on.
std::string dds_locators(const eprosima::fastdds::dds::DataReader& reader);
/// In words, e.g. "reliability".
std::string dds_policy_name(eprosima::fastdds::dds::QosPolicyId_t policy);
/// The one place that DDS trouble is reported at; from any thread.
void log_dds(const std::string& message);

}  // namespace sidestep
