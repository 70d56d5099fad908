// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace sidestep {

/// No interface of this machine has the address, which is valid. It may appear later, so a service tries
/// again; for a command the address is wrong.
class MissingInterface : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace sidestep
