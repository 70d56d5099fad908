// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <fmt/format.h>
#include <string>
#include <utility>

namespace sidestep {

/// Writes the text to a stream and flushes it. If that fails, because the reader is gone or the disk is full,
/// the text is lost. Unlike fmt::print(), this does not throw, so a missing reader does not abort any work.
/// The process must ignore SIGPIPE to outlive the reader of a pipe. Returns 0, or errno.
int write_text(std::FILE* stream, const std::string& text) noexcept;

/// Formats the text, and writes it as write_text() does.
template <typename... Values>
void print_to(std::FILE* stream, fmt::format_string<Values...> format, Values&&... values) {
  (void)write_text(stream, fmt::format(format, std::forward<Values>(values)...));
}

/// Writes the text to stdout and flushes it. Throws std::runtime_error ("cannot write to standard output:
/// reason") if that fails. For commands whose output is all of their work, so that they end with it.
void write_output(const std::string& text);

/// Formats the text, and writes it as write_output() does.
template <typename... Values>
void print_output(fmt::format_string<Values...> format, Values&&... values) {
  write_output(fmt::format(format, std::forward<Values>(values)...));
}

/// Throws what write_output() throws, given what write_text() returned for stdout, unless that was 0. For
/// commands that do something else before they end.
void require_printed(int error);

/// Flushes stdout. Throws as write_output() does if anything printed with fmt::print() could not be written.
void finish_output();

/// Whether stdout is a pipe or terminal from which nobody reads any more. Commands that wait for something to
/// print ask regularly, because writing would tell them only then.
[[nodiscard]] bool is_output_abandoned();

/// Opens /dev/null as each of stdin, stdout and stderr that is closed. Otherwise the next file or socket that
/// the process opens would get its descriptor and receive what is printed. Writing to a stdout that was
/// closed still fails. Call it before opening anything.
void reopen_standard_streams() noexcept;

}  // namespace sidestep
