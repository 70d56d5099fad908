// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/log_notices.hpp"

#include "common/file/temporary_folder.hpp"
#include "tests/catch.hpp"

namespace sidestep::log_notices_test {

constexpr const char* kWarning =
    "vision: 2026-11-29 06:00:00.123 warning sidestep-vision: camera 1 is lost: no usable frame for 0.5 s";

TEST_CASE("a notice is the process and the text of a line of at least the level") {
  CHECK(notice_of(kWarning, LogLevel::kWarning) == "vision: camera 1 is lost: no usable frame for 0.5 s");
  CHECK_FALSE(notice_of(kWarning, LogLevel::kError));
  for (const char* const line :
       {"", "vision: ", "vision: terminate called", "a b c d e f", "vision: 1 2 warning sidestep-vision:"}) {
    CAPTURE(line);
    CHECK_FALSE(notice_of(line, LogLevel::kTrace));
  }
}

TEST_CASE("what every process says at its start is no notice, unless it is a warning") {
  const auto line = [](const std::string& level, const std::string& text) {
    return "vision: 2026-11-29 06:00:00.123 " + level + " sidestep-vision: " + text;
  };
  CHECK_FALSE(notice_of(line("info   ", "Fast DDS 2.9.1, domain 10"), LogLevel::kInfo));
  CHECK_FALSE(notice_of(line("info   ", "safety budget: margin 68.0 mm"), LogLevel::kInfo));
  CHECK(notice_of(line("warning", "safety budget: margin 68.0 mm"), LogLevel::kInfo));
}

TEST_CASE("notices are complete lines that were written since the last call") {
  const TemporaryFolder folder;
  std::ofstream log(folder.file("log"));
  LogNotices notices(folder.file("log"));
  CHECK(notices.next().empty());
  log << "vision: 2026-11-29 06:00:00 info    sidestep-vision: hears sender 10.0.0.7:5000\n"
      << "robots: 2026-11-29 06:00:00 info    sidestep-robot: started\n"
      << std::string(kWarning).substr(0, 70) << std::flush;
  CHECK(notices.next() == std::vector<std::string>{"vision: hears sender 10.0.0.7:5000"});
  CHECK(notices.next().empty());
  log << std::string(kWarning).substr(70) << "\n" << std::flush;
  CHECK(notices.next() == std::vector<std::string>{"vision: camera 1 is lost: no usable frame for 0.5 s"});
}

TEST_CASE("the number of notices is limited") {
  const TemporaryFolder folder;
  std::ofstream log(folder.file("log"));
  LogNotices notices(folder.file("log"));
  for (int i = 0; i < 1000; ++i) log << kWarning << "\n";
  log.flush();
  CHECK(notices.next().size() == LogNotices::kMaxLines + 1);
  log << kWarning << "\n" << std::flush;
  CHECK(notices.next().empty());
}

}  // namespace sidestep::log_notices_test
