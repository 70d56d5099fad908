// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace sidestep {

/// A file of the monitor's page, which is part of the program.
struct PageFile {
  const char* path;  ///< e.g. /main.js
  const char* content_type;
  std::string_view content;
};

/// nullptr: there is no such file. "/" is the page itself.
[[nodiscard]] const PageFile* find_page_file(const std::string& path);

}  // namespace sidestep
