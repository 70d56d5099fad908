// SPDX-License-Identifier: Apache-2.0
// An include guard instead of #pragma once: this file is part of a precompiled header, which a cache may have
// built from a copy with another date, and g++ treats copies with different dates as different files.
#ifndef SIDESTEP_FAST_DDS_LIBRARY_HPP
#define SIDESTEP_FAST_DDS_LIBRARY_HPP

#include <fastdds/LibrarySettings.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/rtps/common/Guid.hpp>
#include <fastdds/rtps/common/GuidPrefix_t.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.hpp>

/// The differences between versions of Fast DDS; this is version 3. The files for all versions declare the
/// same names.
namespace sidestep::fast_dds {

namespace dds = eprosima::fastdds::dds;
/// Wire protocol types.
namespace rtps = eprosima::fastdds::rtps;
/// Transport types.
namespace transport = eprosima::fastdds::rtps;
using eprosima::fastdds::dds::Duration_t;
inline const Duration_t kInfiniteDuration = eprosima::fastdds::dds::c_TimeInfinite;

using ReturnCode = dds::ReturnCode_t;

[[nodiscard]] inline bool is_ok(ReturnCode code) { return code == dds::RETCODE_OK; }

/// Precondition: `sample` has the sample type of the writer's DataType.
[[nodiscard]] inline bool write(dds::DataWriter& writer, void* sample) { return is_ok(writer.write(sample)); }

inline void set_times(dds::DataWriterQos& qos, const Duration_t& heartbeat_period,
                      const Duration_t& nack_response_delay) {
  qos.reliable_writer_qos().times.heartbeat_period = heartbeat_period;
  qos.reliable_writer_qos().times.nack_response_delay = nack_response_delay;
}

inline void set_times(dds::DataReaderQos& qos, const Duration_t& heartbeat_response_delay) {
  qos.reliable_reader_qos().times.heartbeat_response_delay = heartbeat_response_delay;
}

inline dds::DataRepresentationQosPolicy& representation(dds::DataReaderQos& qos) {
  return qos.representation();
}

/// Makes endpoints within one process also exchange messages over the network. Call it before creating
/// participants.
inline void disable_intraprocess_delivery() {
  eprosima::fastdds::LibrarySettings settings;
  settings.intraprocess_delivery = eprosima::fastdds::INTRAPROCESS_OFF;
  dds::DomainParticipantFactory::get_instance()->set_library_settings(settings);
}

/// Disables announcing the structure of types, because Cyclone DDS drops endpoints that do.
inline void disable_type_propagation(dds::DomainParticipantQos& qos) {
  qos.properties().properties().emplace_back("fastdds.type_propagation", "disabled");
}

}  // namespace sidestep::fast_dds

#endif  // SIDESTEP_FAST_DDS_LIBRARY_HPP
