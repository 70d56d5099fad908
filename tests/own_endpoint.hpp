// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/league/multicast.hpp"
#include "tests/own_domain.hpp"

namespace sidestep {

/// A multicast group and ports that no other test on this machine uses while this one lives.
class OwnEndpoint {
 public:
  /// `which` tells several of one test apart, 0 .. 9.
  league::Endpoint endpoint(int which = 0) const {
    return {0xefff'3e00, static_cast<std::uint16_t>(20'000 + 10 * domain_.number() + which)};
  }
  std::string text(int which = 0) const { return to_text(endpoint(which)); }
  /// A domain that is one's own as well.
  const OwnDomain& domain() const { return domain_; }

 private:
  OwnDomain domain_;
};

}  // namespace sidestep
