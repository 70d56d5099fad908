// SPDX-License-Identifier: Apache-2.0
#include "common/motion/version_set.hpp"

#include <algorithm>
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

void VersionSet::forget_started(Time at) {
  const auto kept = std::remove_if(versions_.begin(), versions_.begin() + static_cast<std::ptrdiff_t>(count_),
                                   [at](const Version& version) { return version.trajectory.start() <= at; });
  count_ = static_cast<std::size_t>(kept - versions_.begin());
}

bool VersionSet::forget(VersionNumber executing, Time at) {
  if (!find(executing)) return false;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Version& version = versions_[i];
    const bool excluded =
        version.number < executing || (version.number > executing && version.trajectory.start() <= at);
    if (!excluded) versions_[kept++] = version;
  }
  count_ = kept;
  return true;
}

}  // namespace sidestep
