// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <fmt/format.h>
#include <string>
#include <utility>

namespace sidestep {

/// Writes the text to a stream and flushes it. If that fails, because the reader is gone or the disk is full,
/// the text is lost. Unlike fmt::print(), this does not throw, so a missing reader does not abort any work.
/// The process must ignore SIGPIPE to outlive the reader of a pipe.
void write_text(std::FILE* stream, const std::string& text) noexcept;

/// Formats the text, and writes it as write_text() does.
template <typename... Values>
void print_to(std::FILE* stream, fmt::format_string<Values...> format, Values&&... values) {
  write_text(stream, fmt::format(format, std::forward<Values>(values)...));
}

/// Opens /dev/null as each of stdin, stdout and stderr that is closed. Otherwise the next file or socket that
/// the process opens would get its descriptor and receive what is printed. Call it before opening anything.
void reopen_standard_streams() noexcept;

}  // namespace sidestep
