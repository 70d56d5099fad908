// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/client/client.hpp"
#include "common/client/order_client.hpp"

namespace sidestep::client {

OrderState state_of(const SentOrder& sent);
/// Whether the state stays. A zone may be forgotten by all coordinators, or replaced.
bool stays(const SentOrder& sent, const OrderState& state);

sidestep::Zone to_zone(const Zone& zone);
std::vector<sidestep::Goal> to_goals(const std::vector<Goal>& goals);

/// Whether coordinators can decode the order at `now`; its client and number are not looked at.
bool is_well_formed(sidestep::Order order, Time now);

}  // namespace sidestep::client
