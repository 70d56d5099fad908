// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/time/time.hpp"

namespace sidestep {

/// Detects changes of the list of revoked keys.
class RevokedKeys {
 public:
  /// `folder` contains the keys of an identity. Empty: the list never changes.
  explicit RevokedKeys(const std::string& folder);

  /// The list, if it has changed since the last call or the construction. Checks once a second. Throws
  /// std::runtime_error, once per change, if it cannot be read.
  [[nodiscard]] std::optional<std::string> changed(Time now);

 private:
  std::filesystem::file_time_type modification_time() const;

  std::string folder_;
  std::filesystem::file_time_type time_;
  Time due_{};
};

}  // namespace sidestep
