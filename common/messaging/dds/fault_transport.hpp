// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/rtps/common/GuidPrefix_t.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <memory>

#include "common/messaging/impairment.hpp"

namespace sidestep {

/// A transport that does to what arrives over UDP what the impairment says: losing, doubling, delaying and so
/// reordering datagrams. Not to discovery, or processes would not find each other for seconds, and not to
/// what an operator sends, or a fault could not be ended.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> fault_transport(
    std::shared_ptr<eprosima::fastdds::rtps::UDPv4TransportDescriptor> udp,
    std::shared_ptr<Impairment> impairment);

/// How this process is known on the wire when it is an operator's.
eprosima::fastrtps::rtps::GuidPrefix_t operator_prefix();

}  // namespace sidestep
