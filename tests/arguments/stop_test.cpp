// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sys/stat.h>

#include "common/file/temporary_folder.hpp"
#include "tests/arguments/program_run.hpp"
#include "tests/catch.hpp"
#include "tests/sanitized.hpp"
#include "tests/test_domain.hpp"

namespace sidestep::arguments {

using namespace std::chrono_literals;

const std::string kScenario = SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml";
constexpr int kTimeFactor = kIsSanitized ? 5 : 1;

/// A recording that takes many seconds to read: a sparse file with records of an unknown kind.
std::string long_recording(const TemporaryFolder& folder) {
  const ProgramRun simulated = run_program(
      {"sidestep", "simulate", kScenario, "--seconds", "0.2", "--record", folder.file("short.mcap")},
      folder.path(), 60s, SIGKILL);
  REQUIRE(simulated.exit_code == 1);  // no robot has arrived
  std::ifstream stream(folder.file("short.mcap"), std::ios::binary);
  const std::string recording{std::istreambuf_iterator<char>(stream), {}};
  constexpr std::size_t kMagicSize = 8, kFrameSize = 9;
  constexpr char kDataEnd = 0x0f, kUnknown = static_cast<char>(0xf0);
  std::size_t at = kMagicSize;
  while (recording.at(at) != kDataEnd) {
    std::uint64_t size = 0;
    std::memcpy(&size, &recording.at(at + 1), sizeof size);
    at += kFrameSize + size;
  }
  std::ofstream file(folder.file("long.mcap"), std::ios::binary);
  file << recording.substr(0, at);
  const std::uint64_t size = 60'000'000;
  for (int i = 0; i < 500 * kTimeFactor; ++i) {
    file.put(kUnknown);
    file.write(reinterpret_cast<const char*>(&size), sizeof size);
    file.seekp(static_cast<std::streamoff>(size), std::ios::cur);
  }
  file << recording.substr(at);
  return folder.file("long.mcap");
}

TEST_CASE("a command that reads a recording ends within a second of SIGTERM", "[slow]") {
  const TemporaryFolder folder;
  const TestDomain domain;
  const std::string file = long_recording(folder), number = std::to_string(domain.number());
  struct Case {
    std::vector<std::string> command;
    std::chrono::milliseconds asked_after;
    int exit_code;
  };
  const Case cases[] = {
      {{"sidestep", "bag", "info", file}, 1s, -SIGTERM},
      {{"sidestep", "bag", "cut", file, "--out", folder.file("out.mcap")}, 1s, -SIGTERM},
      {{"sidestep", "bag", "merge", file, "--out", folder.file("merged.mcap")}, 1s, -SIGTERM},
      {{"sidestep", "audit", "--recording", file}, 1s, -SIGTERM},
      {{"sidestep", "topic", "echo", "world", "--recording", file}, 1s, -SIGTERM},
      {{"sidestep", "topic", "delay", "world", "--recording", file}, 1s, -SIGTERM},
      {{"sidestep", "monitor", file, "--port", "0", "--domain", number}, 2s, 0},
      // After discovery it reads to the end, because no message has this topic.
      {{"sidestep", "replay", file, "--topics", "attestation", "--domain", number}, 5s, 0},
  };
  for (const auto& [command, asked_after, exit_code] : cases) {
    const ProgramRun run = run_program(command, folder.path(), asked_after * kTimeFactor, SIGTERM);
    INFO(command[1] << " " << command[2] << "\n" << run.errors);
    CHECK(run.exit_code == exit_code);
    CHECK(run.wall_s * 1s > asked_after * kTimeFactor);
    CHECK(run.wall_s * 1s < (asked_after + 1s) * kTimeFactor);
  }
}

TEST_CASE("a run whose report goes to a pipe without a reader prints an error and ends") {
  const TemporaryFolder folder;
  const TestDomain domain;
  const std::string pipe = folder.file("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const ProgramRun run = run_program({"sidestep", "run", kScenario, "--seconds", "1", "--report", pipe,
                                      "--domain", std::to_string(domain.number())},
                                     folder.path(), 60s, SIGKILL);
  INFO(run.errors);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.errors, ContainsSubstring("cannot write " + pipe + ": no process reads this pipe"));
}

}  // namespace sidestep::arguments
