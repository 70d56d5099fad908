// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// The numbers that a key accepts, both limits included.
struct Range {
  double low;
  double high;
};

}  // namespace sidestep
