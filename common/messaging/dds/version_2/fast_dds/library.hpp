// SPDX-License-Identifier: Apache-2.0
// An include guard instead of #pragma once: this file is part of a precompiled header, which a cache may have
// built from a copy with another date, and g++ treats copies with different dates as different files.
#ifndef SIDESTEP_FAST_DDS_LIBRARY_HPP
#define SIDESTEP_FAST_DDS_LIBRARY_HPP

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/rtps/common/Guid.h>
#include <fastdds/rtps/common/GuidPrefix_t.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>

/// The differences between versions of Fast DDS; this is version 2. The files for all versions declare the
/// same names.
namespace sidestep::fast_dds {

namespace dds = eprosima::fastdds::dds;
/// Wire protocol types.
namespace rtps = eprosima::fastrtps::rtps;
/// Transport types.
namespace transport = eprosima::fastdds::rtps;
using eprosima::fastrtps::Duration_t;
inline const Duration_t kInfiniteDuration = eprosima::fastrtps::c_TimeInfinite;

using ReturnCode = eprosima::fastrtps::types::ReturnCode_t;

[[nodiscard]] inline bool is_ok(const ReturnCode& code) { return code == ReturnCode::RETCODE_OK; }

/// Precondition: `sample` has the sample type of the writer's DataType.
[[nodiscard]] inline bool write(dds::DataWriter& writer, void* sample) { return writer.write(sample); }

inline void set_times(dds::DataWriterQos& qos, const Duration_t& heartbeat_period,
                      const Duration_t& nack_response_delay) {
  qos.reliable_writer_qos().times.heartbeatPeriod = heartbeat_period;
  qos.reliable_writer_qos().times.nackResponseDelay = nack_response_delay;
}

inline void set_times(dds::DataReaderQos& qos, const Duration_t& heartbeat_response_delay) {
  qos.reliable_reader_qos().times.heartbeatResponseDelay = heartbeat_response_delay;
}

inline dds::DataRepresentationQosPolicy& representation(dds::DataReaderQos& qos) {
  return qos.type_consistency().representation;
}

/// Makes endpoints within one process also exchange messages over the network. Call it before creating
/// participants.
inline void disable_intraprocess_delivery() {
  eprosima::fastrtps::LibrarySettingsAttributes settings;
  settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
  eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
}

/// Disables announcing the structure of types, because Cyclone DDS drops endpoints that do. In this version
/// DataType disables it.
inline void disable_type_propagation(dds::DomainParticipantQos&) {}

}  // namespace sidestep::fast_dds

#endif  // SIDESTEP_FAST_DDS_LIBRARY_HPP
