// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/messaging/dds/gate.hpp"
#include "common/messaging/dds/transport_counts.hpp"
#include "common/messaging/impairment.hpp"
#include "fast_dds/library.hpp"

namespace sidestep {

/// A UDP transport that announces presence, and makes Fast DDS forget participants that have become silent
/// (see Presence).
///
/// `counts` counts what it drops. With an impairment it also loses, duplicates, delays and so reorders
/// arriving datagrams. Discovery is exempt, because otherwise processes would not find each other for
/// seconds. With a gate, what it does not let pass is dropped first. An operator's messages are exempt,
/// because otherwise a fault could not be ended.
std::shared_ptr<fast_dds::transport::TransportDescriptorInterface> udp_transport(
    std::shared_ptr<fast_dds::transport::UDPv4TransportDescriptor> udp,
    std::shared_ptr<Impairment> impairment, std::shared_ptr<TransportCounts> counts,
    std::shared_ptr<Gate> gate);

/// GUID prefix that marks this process as an operator's; unique to the process.
fast_dds::rtps::GuidPrefix_t operator_prefix();

}  // namespace sidestep
