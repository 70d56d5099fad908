// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/messaging/dds/bus.hpp"
#include "common/messaging/dds/free_domain.hpp"

namespace sidestep {

/// A DDS domain that no other test on this machine uses during the lifetime of this object.
class TestDomain : public FreeDomain {
 public:
  DdsSettings settings(const std::string& participant = "test") const {
    return {number(), "127.0.0.1", participant};
  }
};

}  // namespace sidestep
