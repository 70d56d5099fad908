// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Ends the program if the condition does not hold. The fuzzer then reports the input.
#define SIDESTEP_REQUIRE(condition)                                                      \
  do {                                                                                   \
    if (!(condition)) {                                                                  \
      std::fprintf(stderr, "%s:%d: %s does not hold\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                      \
    }                                                                                    \
  } while (false)

namespace sidestep::fuzz {

using Bytes = std::vector<std::uint8_t>;
using View = std::span<const std::uint8_t>;

/// Each `NAME_fuzz.cpp` defines the following two functions for the code that it tests.

/// Passes an input to code that reads untrusted bytes. Ends the program if that code accepts what it must
/// refuse. Only exceptions that the callers of that code catch are caught. Returns whether the input was
/// accepted, at least in part.
bool try_input(View input);

/// Valid inputs of every kind; try_input() accepts each of them.
std::vector<Bytes> seeds();

inline std::string text_of(View bytes) { return {bytes.begin(), bytes.end()}; }
inline Bytes bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

/// The content of a file of this repository.
[[nodiscard]] Bytes file_content(const std::filesystem::path& path);
/// The files with an extension, such as ".yaml", in a folder of this repository and those within it, sorted.
[[nodiscard]] std::vector<std::filesystem::path> files_in(const std::string& folder,
                                                          const std::string& extension);
/// Overwrites a file. This runs for each input, so the folder is best in memory.
void write_input(const std::string& path, View bytes);

}  // namespace sidestep::fuzz
