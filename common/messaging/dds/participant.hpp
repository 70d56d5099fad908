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

#include "common/messaging/dds/bus.hpp"
#include "common/messaging/impairment.hpp"

namespace sidestep {

/// A DDS participant with one publisher and one subscriber, over UDPv4 and optionally shared memory.
/// Destroying it deletes everything that it has created.
class DdsParticipant {
 public:
  /// The listener, if any, must outlive the participant. `shared_memory_bytes` > 0 is the size of the segment
  /// for written messages. Two participants on one host that both have shared memory use it instead of UDP,
  /// even if their segments are not visible to each other (containers); faults do not affect it. Throws
  /// std::runtime_error with the reason.
  DdsParticipant(const DdsSettings& settings, eprosima::fastdds::dds::DomainParticipantListener* listener,
                 std::uint32_t shared_memory_bytes = 0);
  ~DdsParticipant();
  DdsParticipant(const DdsParticipant&) = delete;
  DdsParticipant& operator=(const DdsParticipant&) = delete;

  /// Registers `type` unless a type of its name is already registered. Throws std::runtime_error that names
  /// the topic.
  eprosima::fastdds::dds::DataWriter* create_writer(const std::string& channel,
                                                    const eprosima::fastdds::dds::TypeSupport& type,
                                                    const eprosima::fastdds::dds::DataWriterQos& qos,
                                                    eprosima::fastdds::dds::DataWriterListener* listener);
  eprosima::fastdds::dds::DataReader* create_reader(const std::string& channel,
                                                    const eprosima::fastdds::dds::TypeSupport& type,
                                                    const eprosima::fastdds::dds::DataReaderQos& qos,
                                                    eprosima::fastdds::dds::DataReaderListener* listener);
  void delete_writer(eprosima::fastdds::dds::DataWriter* writer);
  void delete_reader(eprosima::fastdds::dds::DataReader* reader);
  /// As DdsBus::impair().
  void impair(const LinkQuality& quality, std::uint64_t seed) { impairment_->set(quality, seed); }

 private:
  eprosima::fastdds::dds::Topic* topic(const std::string& channel,
                                       const eprosima::fastdds::dds::TypeSupport& type);

  std::shared_ptr<Impairment> impairment_;  ///< null without DdsSettings::faults
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
};

eprosima::fastdds::dds::DataWriterQos dds_writer_qos(Qos qos);
eprosima::fastdds::dds::DataReaderQos dds_reader_qos(Qos qos);
/// The addresses on which the reader listens.
std::string dds_locators(const eprosima::fastdds::dds::DataReader& reader);
/// The policy's name, e.g. "reliability".
std::string dds_policy_name(eprosima::fastdds::dds::QosPolicyId_t policy);
/// Logs a DDS problem. Thread-safe.
void log_dds(const std::string& message);

}  // namespace sidestep
