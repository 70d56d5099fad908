// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <memory>
#include <string>

namespace sidestep {

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using OutputFile = std::unique_ptr<std::FILE, FileCloser>;

enum class WriteMode { kReplace, kAppend };

/// Opens a file for writing; processes that this one starts do not inherit it. A named pipe without a reader
/// is refused, because opening it would hang silently, and a process that handles signals could not be
/// interrupted. Throws std::runtime_error ("cannot write PATH: reason").
[[nodiscard]] OutputFile open_output(const std::string& path, WriteMode mode = WriteMode::kReplace);

/// Why a file could not be opened for writing, given errno: names the folder that does not exist, or that the
/// user may not write.
[[nodiscard]] std::string write_problem(const std::string& path, int error);

/// Throws std::runtime_error ("cannot write PATH: reason").
[[noreturn]] void throw_unwritable(const std::string& path, const std::string& reason);

}  // namespace sidestep
