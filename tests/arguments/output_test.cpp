// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <filesystem>

#include "common/file/temporary_folder.hpp"
#include "tests/arguments/program_run.hpp"
#include "tests/catch.hpp"
#include "tests/sanitized.hpp"
#include "tests/test_domain.hpp"
#include "tests/text_of.hpp"

namespace sidestep::output_test {
namespace {

using arguments::ProgramRun;
using arguments::run_program;
using namespace std::chrono_literals;

const std::string kScenario = SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml";
constexpr auto kPatience = kIsSanitized ? 240s : 60s;

/// Runs a command of bash, in which "$0" is the program; its exit code is that of the first program in a
/// pipe.
ProgramRun run_in_shell(const std::string& command, const TemporaryFolder& folder) {
  const std::string program =
      (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "sidestep").string();
  return run_program({"/bin/bash", "-c", command + "; exit ${PIPESTATUS[0]}", program}, folder.path(),
                     kPatience, SIGKILL);
}

struct RunFixture {
  std::string command(const std::string& more) const {
    return "\"$0\" run " + kScenario + " --seconds 1 --domain " + std::to_string(domain.number()) + " " +
           more;
  }
  std::string text(const std::string& name) const { return text_of(folder.file(name)); }

  TemporaryFolder folder;
  TestDomain domain;
};

}  // namespace

TEST_CASE("a run finishes and writes its report even if its output is closed or no longer read") {
  const RunFixture f;
  const std::string output =
      GENERATE("2>err | head -1", "2>&1 | head -1", ">/dev/full 2>/dev/full", ">&- 2>&-");
  const ProgramRun run = run_in_shell(f.command("--report r.json " + output), f.folder);
  CAPTURE(output, run.errors);
  CHECK(run.exit_code == 1);
  CHECK_THAT(f.text("r.json"), ContainsSubstring("\"failure\": \"time limit of 1 s") &&
                                   ContainsSubstring("\"director_deaths\": []"));
  CHECK_THAT(f.text("r.log"), !ContainsSubstring("SIGPIPE"));
}

TEST_CASE("a simulation finishes and writes its report even if its output is closed or no longer read") {
  const TemporaryFolder folder;
  const std::string runs = GENERATE(as<std::string>(), kScenario + " --seconds 1",
                                    "--faults none --seeds 1..40 --seconds 1 --jobs 2");
  const std::string output = GENERATE("2>&1 | true", ">/dev/full 2>/dev/full", ">&- 2>&-");
  const ProgramRun run = run_in_shell("\"$0\" simulate " + runs + " --report r.json " + output, folder);
  CAPTURE(runs, output, run.errors);
  CHECK((run.exit_code == 0 || run.exit_code == 1));
  CHECK_THAT(text_of(folder.file("r.json")), ContainsSubstring("\"contacts\": 0"));
}

TEST_CASE(
    "a run that cannot write its recording continues, and reports the error once in its output and in its "
    "report") {
  const RunFixture f;
  const ProgramRun run = run_in_shell(f.command("--record /dev/full --report r.json >out"), f.folder);
  CAPTURE(run.errors);
  CHECK(run.exit_code == 1);
  const std::string output = f.text("out"), message = "recording: /dev/full: No space left on device\n";
  CHECK(output.starts_with(message));
  CHECK(output.find(message, 1) == std::string::npos);
  CHECK_THAT(output, ContainsSubstring("robots arrived") && ContainsSubstring("report: r.json"));
  CHECK_THAT(f.text("r.json"),
             ContainsSubstring("\"failure\": \"time limit of 1 s, recording: /dev/full: No space left") &&
                 ContainsSubstring("\"violations\": 0"));
}

TEST_CASE("a run that cannot write its report still prints its summary") {
  const RunFixture f;
  const std::string command = GENERATE("run", "simulate");
  std::filesystem::create_directory(f.folder.file("taken"));
  const ProgramRun run =
      command == "run" ? run_in_shell(f.command("--report taken >out"), f.folder)
                       : run_in_shell("\"$0\" simulate " + kScenario + " --report /dev/full >out", f.folder);
  CAPTURE(command);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.errors, ContainsSubstring("cannot write "));
  CHECK_THAT(f.text("out"), ContainsSubstring("robots arrived") && !ContainsSubstring("report: "));
}

TEST_CASE("a simulated run ends normally if stderr is closed or its disk is full") {
  const TemporaryFolder folder;
  const std::string output = GENERATE("2>&-", "2>/dev/full", "<&- >&- 2>&-");
  const ProgramRun run = run_in_shell("\"$0\" simulate " + kScenario + " --report r.json " + output, folder);
  CAPTURE(output);
  CHECK(run.exit_code == 0);
  CHECK_THAT(text_of(folder.file("r.json")), ContainsSubstring("\"passed\": true"));
  CHECK(run_in_shell("\"$0\" simulate /nowhere.yaml " + output, folder).exit_code == 2);
  CHECK(run_in_shell("\"$0\" simulate --nonsense " + output, folder).exit_code == 2);
}

}  // namespace sidestep::output_test
