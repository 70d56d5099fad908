// SPDX-License-Identifier: Apache-2.0
#include "common/log/log.hpp"

#include <memory>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace sidestep {
namespace {

/// Time, level, process, text.
constexpr const char* kPattern = "%Y-%m-%d %H:%M:%S.%e %-7l %n: %v";

spdlog::level::level_enum library_level(LogLevel level) {
  switch (level) {
    case LogLevel::kTrace:
      return spdlog::level::trace;
    case LogLevel::kDebug:
      return spdlog::level::debug;
    case LogLevel::kInfo:
      return spdlog::level::info;
    case LogLevel::kWarning:
      return spdlog::level::warn;
    case LogLevel::kError:
      return spdlog::level::err;
    case LogLevel::kOff:
      break;
  }
  return spdlog::level::off;
}

void install(const std::string& process, LogLevel level) {
  auto logger = std::make_shared<spdlog::logger>(process, std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern(kPattern);
  logger->set_level(library_level(level));
  spdlog::set_default_logger(std::move(logger));
}

// The library's default logger writes to stdout, which is reserved for the results of programs.
const bool is_installed = (install("sidestep", LogLevel::kInfo), true);

}  // namespace

void set_up_log(const std::string& process, LogLevel level) { install(process, level); }

bool is_logged(LogLevel level) { return level != LogLevel::kOff && spdlog::should_log(library_level(level)); }

void log(LogLevel level, const std::string& text) {
  spdlog::default_logger_raw()->log(library_level(level), spdlog::string_view_t(text));
}

std::string log_line(const std::string& process, LogLevel level, const std::string& text) {
  spdlog::pattern_formatter formatter(kPattern, spdlog::pattern_time_type::local, "");
  spdlog::memory_buf_t line;
  formatter.format(spdlog::details::log_msg(process, library_level(level), text), line);
  return {line.data(), line.size()};
}

}  // namespace sidestep
