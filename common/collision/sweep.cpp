// SPDX-License-Identifier: Apache-2.0
#include "common/collision/sweep.hpp"

#include <stdexcept>

namespace sidestep {

void Sweep::refuse() {
  throw std::invalid_argument("a disc's places and radius have to be finite, and the radius not negative");
}

}  // namespace sidestep
