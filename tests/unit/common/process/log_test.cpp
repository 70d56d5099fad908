// SPDX-License-Identifier: Apache-2.0
#include "common/log/log.hpp"

#include <regex>

#include "common/process/log_option.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"

namespace sidestep::log_test {

LogLevel parsed(std::vector<std::string> arguments) {
  CommandLine command_line("test", "test");
  LogLevel level = LogLevel::kInfo;
  add_log_option(command_line.root(), level);
  command_line.parse(std::move(arguments));
  return level;
}

TEST_CASE("the option --log-level takes the name of each level and defaults to info") {
  CHECK(parsed({}) == LogLevel::kInfo);
  for (std::size_t i = 0; i < kLogLevelNames.size(); ++i) {
    CAPTURE(i);
    CHECK(parsed({"--log-level", std::string(kLogLevelNames[i])}) == static_cast<LogLevel>(i));
  }
}

TEST_CASE("an invalid log level is a usage error that lists the levels") {
  for (const char* wrong : {"verbose", "INFO", "2", ""}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(parsed({"--log-level", wrong}), UsageError);
  }
  try {
    (void)parsed({"--log-level", "verbose"});
  } catch (const UsageError& error) {
    for (const std::string_view name : kLogLevelNames)
      CHECK_THAT(std::string(error.what()), ContainsSubstring(std::string(name)));
  }
}

TEST_CASE("a log line has the time, the level, the process and the text") {
  const std::regex line(R"(\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\.\d{3} warning agent-3: something \{happened\})");
  CHECK(std::regex_match(log_line("agent-3", LogLevel::kWarning, "something {happened}"), line));
  const CaptureStderr captured;
  set_up_log("agent-3", LogLevel::kInfo);
  log(LogLevel::kWarning, "something {happened}");
  const std::string text = captured.text();
  REQUIRE_FALSE(text.empty());
  CHECK(text.back() == '\n');
  CHECK(std::regex_match(text.substr(0, text.size() - 1), line));
}

TEST_CASE("the log contains lines of its level and higher ones") {
  constexpr auto kOff = static_cast<std::size_t>(LogLevel::kOff);
  for (std::size_t level = 0; level <= kOff; ++level) {
    CAPTURE(kLogLevelNames[level]);
    const CaptureStderr captured;
    set_up_log("test", static_cast<LogLevel>(level));
    for (std::size_t i = 0; i < kOff; ++i) {
      log(static_cast<LogLevel>(i), "a line of level " + std::string(kLogLevelNames[i]));
      CHECK(is_logged(static_cast<LogLevel>(i)) == (i >= level));
      CHECK(captured.has("a line of level " + std::string(kLogLevelNames[i])) == (i >= level));
    }
  }
  set_up_log("test", LogLevel::kInfo);
}

TEST_CASE("an event below its listener's level is not formatted") {
  struct Node {
    EventReporter events;
    void on_event(LogLevel level, OnLogEvent callback) { events.set_listener(level, std::move(callback)); }
  } node;
  CHECK_FALSE(node.events.is_wanted(LogLevel::kError));
  const CaptureStderr captured;
  set_up_log("test", LogLevel::kWarning);
  log_events_of(node);
  CHECK_FALSE(node.events.is_wanted(LogLevel::kInfo));
  CHECK(node.events.is_wanted(LogLevel::kWarning));
  node.events.report(LogLevel::kInfo, 3, "robot {} arrived", 3);
  node.events.report(LogLevel::kWarning, 3, "robot {} is lost", 3);
  CHECK(captured.has("warning test: robot 3 is lost"));
  CHECK_FALSE(captured.has("arrived"));
  set_up_log("test", LogLevel::kInfo);
}

}  // namespace sidestep::log_test
