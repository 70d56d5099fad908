// SPDX-License-Identifier: Apache-2.0
#include "common/version/version.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace sidestep {
namespace {

/// Shortens the commit's hash to 12 digits, which are enough for git, and keeps the suffix.
std::string short_commit(const std::string& commit) {
  constexpr std::size_t kDigits = 12;
  const std::size_t end = std::min(commit.find('-'), commit.size());
  return commit.substr(0, std::min(end, kDigits)) + commit.substr(end);
}

}  // namespace

std::string version_text(const std::string& fast_dds_version) {
  return fmt::format("Sidestep {}, commit {}, Fast DDS {}", kVersion, short_commit(kBuildCommit),
                     fast_dds_version);
}

}  // namespace sidestep
