// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/decoded_ledger_page.hpp"

#include "common/messaging/version_codec.hpp"

namespace sidestep {

void DecodedLedgerPage::assign(const msg::LedgerPage& page) {
  const std::size_t count = page.versions().size();
  entries.clear();
  versions.clear();
  bounds.clear();
  ends.clear();
  entries.reserve(count);
  versions.reserve(count);
  bounds.reserve(count);
  ends.reserve(count);
  for (const msg::Version& message : page.versions()) {
    const auto version = decode(message);
    entries.push_back({{message.x_m(), message.y_m()}, message.robot(), version.has_value()});
    versions.push_back(version.value_or(Version{}));
    bounds.push_back(trajectory_bounds(versions.back().trajectory));
    ends.push_back(versions.back().trajectory.end());
  }
}

}  // namespace sidestep
