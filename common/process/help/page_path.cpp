// SPDX-License-Identifier: Apache-2.0
#include "common/process/help/page_path.hpp"

#include <string_view>
#include <system_error>

namespace sidestep {

namespace fs = std::filesystem;

std::string page_path(const std::string& page, const fs::path& program) {
  // As deploy/package/CMakeLists.txt installs them.
  constexpr std::string_view kNotInstalled = "deploy/";
  const std::string name = page.starts_with(kNotInstalled) ? page.substr(kNotInstalled.size()) : page;
  const fs::path installed = (program.parent_path() / "../share/sidestep" / name).lexically_normal();
  std::error_code error;
  return fs::exists(installed, error) ? installed.string() : page;
}

std::string page_path(const std::string& page) {
  std::error_code error;
  return page_path(page, fs::read_symlink("/proc/self/exe", error));
}

}  // namespace sidestep
