// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/rtps/common/GuidPrefix_t.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <memory>

#include "common/messaging/impairment.hpp"

namespace sidestep {

/// A UDP transport that impairs arriving datagrams: it loses, duplicates, delays and so reorders them.
/// Discovery is exempt, because otherwise processes would not find each other for seconds. An operator's
/// messages are exempt, because otherwise a fault could not be ended.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> fault_transport(
    std::shared_ptr<eprosima::fastdds::rtps::UDPv4TransportDescriptor> udp,
    std::shared_ptr<Impairment> impairment);

/// GUID prefix that marks this process as an operator's; unique to the process.
eprosima::fastrtps::rtps::GuidPrefix_t operator_prefix();

}  // namespace sidestep
