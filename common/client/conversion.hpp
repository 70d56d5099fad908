// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/client/client.hpp"
#include "common/client/order_client.hpp"

namespace sidestep::client {

OrderState state_of(const SentOrder& sent);
/// Whether the state is final. The state of an accepted zone is not final: all coordinators may forget the
/// zone, or a later order may replace it.
bool stays(const SentOrder& sent, const OrderState& state);

sidestep::Zone to_zone(const Zone& zone);
std::vector<sidestep::Goal> to_goals(const std::vector<Goal>& goals);

/// Whether coordinators could decode the order at `now`. Does not check the order's client and number.
bool is_well_formed(sidestep::Order order, Time now);

}  // namespace sidestep::client
