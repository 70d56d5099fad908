// SPDX-License-Identifier: Apache-2.0
#include "common/motion/version_set.hpp"

#include <cassert>

namespace sidestep {

void VersionSet::add(const Version& version) {
  if (find(version.number)) return;
  assert(!is_full());
  versions_[count_++] = version;
}

const Version* VersionSet::find(VersionNumber number) const {
  for (const Version& version : versions()) {
    if (version.number == number) return &version;
  }
  return nullptr;
}

}  // namespace sidestep
