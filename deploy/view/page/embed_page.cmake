# SPDX-License-Identifier: Apache-2.0
# Writes the source file OUTPUT with the contents of FILES (names in DIRECTORY, separated by commas).
string(REPLACE "," ";" names "${FILES}")
set(rows "")
foreach(name IN LISTS names)
  file(READ ${DIRECTORY}/${name} content)
  string(REGEX MATCH "[^.]*$" ending ${name})
  if(ending STREQUAL "html")
    set(type "text/html; charset=utf-8")
  elseif(ending STREQUAL "css")
    set(type "text/css; charset=utf-8")
  elseif(ending STREQUAL "js")
    set(type "text/javascript; charset=utf-8")
  elseif(ending STREQUAL "svg")
    set(type "image/svg+xml")
  else()
    message(FATAL_ERROR "${name}: files with the ending .${ending} have no content type")
  endif()
  if(content MATCHES "\\)page\"")
    message(FATAL_ERROR "${name}: contains the end of a raw string")
  endif()
  string(LENGTH "${content}" length)
  if(length GREATER 60000)
    message(FATAL_ERROR "${name}: ${length} bytes, more than a string literal may have")
  endif()
  string(APPEND rows "    {\"/${name}\", \"${type}\", R\"page(${content})page\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// SPDX-License-Identifier: Apache-2.0
#include \"deploy/view/page/page_files.hpp\"

namespace sidestep {
namespace {

constexpr PageFile kFiles[] = {
${rows}};

}  // namespace

const PageFile* find_page_file(const std::string& path) {
  const std::string wanted = path == \"/\" ? \"/index.html\" : path;
  for (const PageFile& file : kFiles)
    if (wanted == file.path) return &file;
  return nullptr;
}

}  // namespace sidestep
")
