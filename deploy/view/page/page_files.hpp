// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace sidestep {

/// A file of the monitor's page, which is compiled into the program.
struct PageFile {
  const char* path;  ///< for example /main.js
  const char* content_type;
  std::string_view content;
};

/// The file with this path; nullptr if there is none. "/" is the page itself.
[[nodiscard]] const PageFile* find_page_file(const std::string& path);

}  // namespace sidestep
