// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/messaging/dds/participant_filter.hpp"
#include "common/messaging/dds/transport_counts.hpp"
#include "common/messaging/impairment.hpp"
#include "fast_dds/library.hpp"

namespace sidestep {

/// A UDP transport that announces presence, and makes Fast DDS forget participants that have become silent
/// (see Presence).
///
/// Drops are counted in `counts`. With an impairment it also loses, duplicates, delays and thereby reorders
/// arriving datagrams. Discovery is exempt, because otherwise processes would take seconds to find each
/// other. An operator's messages are exempt, because otherwise a fault could not be ended. With a filter,
/// datagrams that the filter rejects are dropped first.
std::shared_ptr<fast_dds::transport::TransportDescriptorInterface> udp_transport(
    std::shared_ptr<fast_dds::transport::UDPv4TransportDescriptor> udp,
    std::shared_ptr<Impairment> impairment, std::shared_ptr<TransportCounts> counts,
    std::shared_ptr<ParticipantFilter> filter);

/// A GUID prefix, unique to this process, that marks it as an operator's.
fast_dds::rtps::GuidPrefix_t operator_prefix();

}  // namespace sidestep
