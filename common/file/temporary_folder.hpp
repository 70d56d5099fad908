// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sidestep {

/// A new temporary folder. It is removed with its contents when this object is destroyed.
class TemporaryFolder {
 public:
  /// Throws std::runtime_error if the folder cannot be created.
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }
  /// The path of a file in the folder.
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace sidestep
