// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/random/rng.hpp"

namespace sidestep {

/// Changes an order of robots in which the robot at `place` found no path: it becomes the first. If it was
/// the first already, the order is shuffled. Precondition: the place is in the order.
inline void move_to_front(std::vector<std::size_t>& order, std::size_t place, Rng& rng) {
  if (place == 0)
    rng.shuffle(order);
  else
    std::rotate(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(place),
                order.begin() + static_cast<std::ptrdiff_t>(place) + 1);
}

}  // namespace sidestep
