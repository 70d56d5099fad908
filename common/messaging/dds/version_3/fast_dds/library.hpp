// SPDX-License-Identifier: Apache-2.0
#pragma once

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

/// What differs between versions of Fast DDS: this is version 3. The files of all versions declare the same.
namespace sidestep::fast_dds {

namespace dds = eprosima::fastdds::dds;
/// The wire protocol's types.
namespace rtps = eprosima::fastdds::rtps;
/// The transports' types.
namespace transport = eprosima::fastdds::rtps;
using eprosima::fastdds::dds::Duration_t;
inline const Duration_t kInfiniteDuration = eprosima::fastdds::dds::c_TimeInfinite;

using ReturnCode = dds::ReturnCode_t;

[[nodiscard]] inline bool is_ok(ReturnCode code) { return code == dds::RETCODE_OK; }

/// `sample` is of the kind that the writer's DataType takes.
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

/// Endpoints of one process exchange messages by the network too. Call it before there is a participant.
inline void disable_intraprocess_delivery() {
  eprosima::fastdds::LibrarySettings settings;
  settings.intraprocess_delivery = eprosima::fastdds::INTRAPROCESS_OFF;
  dds::DomainParticipantFactory::get_instance()->set_library_settings(settings);
}

/// Does not announce the structure of types: Cyclone DDS drops endpoints that do.
inline void disable_type_propagation(dds::DomainParticipantQos& qos) {
  qos.properties().properties().emplace_back("fastdds.type_propagation", "disabled");
}

}  // namespace sidestep::fast_dds
