// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/league/multicast.hpp"
#include "tests/test_domain.hpp"

namespace sidestep {

/// Multicast endpoints that no other test on this machine uses during the lifetime of this object.
class TestEndpoint {
 public:
  /// `index`: 0 to 9, to distinguish the endpoints of one test.
  league::Endpoint endpoint(int index = 0) const {
    return {0xefff'3e00, static_cast<std::uint16_t>(20'000 + 10 * domain_.number() + index)};
  }
  /// The same port on the loopback interface.
  league::Endpoint unicast(int index = 0) const { return {0x7f00'0001, endpoint(index).port}; }
  std::string text(int index = 0) const { return to_text(endpoint(index)); }
  /// A DDS domain that no other test on this machine uses.
  const TestDomain& domain() const { return domain_; }

 private:
  TestDomain domain_;
};

}  // namespace sidestep
