// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/protocol/negotiation_messages.hpp"
#include "common/protocol/role_cause.hpp"

namespace sidestep {

/// Decodes an untrusted proposal. Returns nullopt if its sender is not an agent of the proposal's robot, or
/// if incarnation or epoch are implausible at `now`, by the local clock. A candidate becomes nullopt if it is
/// invalid, or if its robot, base or start differs from that of the first candidate; the other candidates
/// remain.
[[nodiscard]] std::optional<Proposal> decode(const msg::Proposal& message, Time now);
/// Decodes an untrusted registration. Returns nullopt if its sender is not an agent of the registration's
/// robot, or if incarnation or epoch are implausible. Registration::versions is nullopt if too many are
/// listed, if any is invalid, belongs to another robot or is listed twice, or if they contradict is_absent.
[[nodiscard]] std::optional<Registration> decode(const msg::Registration& message, Time now);
/// Decodes an untrusted verdict. Returns nullopt unless a coordinator sent it for `robot`, and all reasons
/// are known.
[[nodiscard]] std::optional<Verdict> decode(const msg::Verdict& message, RobotId robot);
/// Decodes an untrusted coordinator state. Returns nullopt if its sender is not the coordinator with the
/// stated number, or if its epoch, its mode, the reason of its role, a time or the place of a displaced robot
/// is implausible. Precondition: the message outlives the result.
[[nodiscard]] std::optional<CoordinatorHeartbeat> decode(const msg::CoordinatorState& message, Time now);

/// Decodes the reason of a coordinator's role from an untrusted message. Returns nullopt if the reason is
/// unknown or refers to an impossible process number.
[[nodiscard]] std::optional<RoleCause> decode_role_cause(const msg::CoordinatorState& message);
/// Writes a role's reason into a coordinator's state.
void encode(const RoleCause& cause, msg::CoordinatorState& message);

/// Encodes a proposal without the header's message_number and stamp_ns, which Writer::publish() sets.
msg::Proposal encode(const Proposal& proposal);
/// Encodes a registration without the header's message_number and stamp_ns.
msg::Registration encode(const Registration& registration);
/// Encodes a verdict without its header.
msg::Verdict encode(const Verdict& verdict);

}  // namespace sidestep
