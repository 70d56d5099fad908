// SPDX-License-Identifier: Apache-2.0
#include "common/file/home_folder.hpp"

#include <cstdlib>

namespace sidestep {

std::string expand_home(const std::string& path) {
  const char* const home = std::getenv("HOME");
  const bool is_below_home = path == "~" || path.starts_with("~/");
  return is_below_home && home ? home + path.substr(1) : path;
}

}  // namespace sidestep
