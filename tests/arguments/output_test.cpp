// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <filesystem>
#include <tuple>
#include <utility>

#include "common/file/temporary_folder.hpp"
#include "tests/arguments/program_run.hpp"
#include "tests/catch.hpp"
#include "tests/needs_root.hpp"
#include "tests/sanitized.hpp"
#include "tests/small_disk.hpp"
#include "tests/taken_port.hpp"
#include "tests/test_domain.hpp"
#include "tests/text_of.hpp"

namespace sidestep::output_test {
namespace {

using arguments::ProgramRun;
using arguments::run_program;
using namespace std::chrono_literals;

const std::string kScenario = SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml";
const std::string kFaultTest = SIDESTEP_SOURCE_DIR "/deploy/scenarios/faults/agent-killed.yaml";
const std::string kLoneRobot = SIDESTEP_SOURCE_DIR "/deploy/scenarios/league/lone-robot.yaml";
const std::string kImages = SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing-images.yaml";
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
  std::string command(const std::string& more, int seconds = 1) const {
    return "\"$0\" run " + kScenario + " --seconds " + std::to_string(seconds) + " --domain " +
           std::to_string(domain.number()) + " " + more;
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
                                    "--faults none --seeds 1..4 --seconds 12 --jobs 2");
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

TEST_CASE("a run that cannot write its report still prints its verdict, and names the cause") {
  const RunFixture f;
  const std::string command = GENERATE("run", "simulate");
  // From 1 kB on, files are as on a full disk; the reader of the output is not limited.
  const std::string limited = "(ulimit -f 1; exec " +
                              (command == "run" ? f.command("--report r.json")
                                                : "\"$0\" simulate " + kScenario + " --report r.json") +
                              ") | cat >out";
  const ProgramRun run = run_in_shell(limited, f.folder);
  CAPTURE(command, run.errors);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.errors, ContainsSubstring("cannot write r.json: File too large"));
  CHECK_THAT(f.text("out"), ContainsSubstring("robots arrived") && !ContainsSubstring("report: "));
  CHECK_THAT(f.text("out"),
             ContainsSubstring(command == "run" ? "\nfailed: time limit of 1 s" : "\npassed\n"));
  CHECK_FALSE(std::filesystem::exists(f.folder.file("r.json")));
  if (command == "run")
    CHECK_THAT(run.errors,
               ContainsSubstring("cannot write r.log: File too large; lines are missing from here on"));
}

TEST_CASE("a run that can write neither report nor picture names both") {
  const RunFixture f;
  const std::string command = GENERATE("run", "simulate");
  const std::string outputs = "--report r.json --svg p.svg";
  const std::string limited =
      "(ulimit -f 1; exec " +
      (command == "run" ? f.command(outputs) : "\"$0\" simulate " + kScenario + " " + outputs) +
      ") | cat >out";
  const ProgramRun run = run_in_shell(limited, f.folder);
  CAPTURE(command, run.errors);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.errors,
             ContainsSubstring("cannot write r.json: File too large; cannot write p.svg: File too large"));
  CHECK_FALSE(std::filesystem::exists(f.folder.file("p.svg")));
}

TEST_CASE("a run that has passed fails if its picture cannot be drawn, and keeps its report") {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_in_shell("\"$0\" simulate " + kScenario + " --report r.json --svg /dev/full >out", folder);
  CAPTURE(run.errors);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.errors, ContainsSubstring("cannot write /dev/full: No space left on device"));
  CHECK_THAT(text_of(folder.file("out")), ContainsSubstring("\npassed\n"));
  CHECK_THAT(text_of(folder.file("r.json")), ContainsSubstring("\"passed\": true"));
}

TEST_CASE("a run whose report or recording cannot be written ends before it starts anything") {
  const RunFixture f;
  std::filesystem::create_directory(f.folder.file("taken"));
  const auto [options, message] =
      GENERATE(std::pair("--report taken", "cannot write taken: Is a directory"),
               std::pair("--report r.json --record taken", "cannot write taken: Is a directory"),
               std::pair("--report r.json --record none/a.mcap", "the folder none does not exist"));
  const ProgramRun run = run_in_shell(f.command(options + std::string(" >out")), f.folder);
  CAPTURE(options, run.errors);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.errors, ContainsSubstring(message));
  CHECK(f.text("out").empty());
  CHECK_FALSE(std::filesystem::exists(f.folder.file("r.json")));
  CHECK_FALSE(std::filesystem::exists(f.folder.file("r.log")));
}

TEST_CASE("a monitor whose port is taken announces nothing and keeps an earlier recording") {
  const RunFixture f;
  const TakenPort port;
  const std::string command = "echo earlier >r.mcap; \"$0\" monitor " + kScenario +
                              " --record r.mcap --port " + port.number() + " --domain " +
                              std::to_string(f.domain.number()) + " >out";
  const ProgramRun run = run_in_shell(command, f.folder);
  CAPTURE(run.errors);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.errors, ContainsSubstring("cannot listen on 127.0.0.1:" + port.number()));
  CHECK(f.text("out").empty());
  CHECK(f.text("r.mcap") == "earlier\n");
}

TEST_CASE("a run, a test or an examination in a domain that another run uses keeps all files") {
  const RunFixture f;
  const std::string command = GENERATE("run", "test", "conformance");
  const std::string domain = " --domain " + std::to_string(f.domain.number());
  const std::string second = command == "run" ? f.command("--report r.json --record r.mcap")
                             : command == "test"
                                 ? "\"$0\" test " + kFaultTest + " --dds" + domain
                                 : "\"$0\" conformance " + kLoneRobot + " --driver simulator" + domain;
  // The second run begins once the first one grants, and ends before the first one.
  const std::string script = f.command("--report first.json >first & first=$!", 30) +
                             "\nuntil grep -q 'coordinator grants' first; do sleep 0.1; done\n"
                             "echo earlier | tee r.log >r.mcap\n" +
                             second + " >second\ncode=$?; kill -INT $first; wait $first; exit $code";
  const ProgramRun run = run_in_shell(script, f.folder);
  CAPTURE(command, run.errors);
  const std::string reason =
      "DDS domain " + std::to_string(f.domain.number()) + " is in use: another run of crossing";
  if (command == "test") {
    CHECK(run.exit_code == 1);
    CHECK_THAT(f.text("second"), ContainsSubstring("could not run: " + reason));
  } else {
    CHECK(run.exit_code == 2);
    CHECK_THAT(run.errors, ContainsSubstring(reason));
    CHECK(f.text("second").empty());
  }
  CHECK(f.text("r.log") == "earlier\n");
  CHECK(f.text("r.mcap") == "earlier\n");
  CHECK_FALSE(std::filesystem::exists(f.folder.file("r.json")));
  CHECK_THAT(f.text("first.json"), ContainsSubstring("\"director_deaths\": []"));
}

TEST_CASE("a recording on a full disk ends with a clear word, and keeps what was written") {
  SIDESTEP_NEEDS_ROOT();
  const RunFixture f;
  const SmallDisk disk(3000);
  const std::string file = disk.file("r.mcap");
  const std::string command = GENERATE("run", "simulate", "record");
  const std::string outputs = "--record " + file + " --report r.json >out";
  const ProgramRun run =
      run_in_shell(command == "run" ? f.command(outputs, 30)
                   : command == "simulate"
                       ? "\"$0\" simulate " + kScenario + " " + outputs
                       : f.command("--report r.json >out & run=$!", 30) + "\n\"$0\" record " + kScenario +
                             " --out " + file + " --domain " + std::to_string(f.domain.number()) +
                             "; code=$?; kill -INT $run; wait; exit $code",
                   f.folder);
  CAPTURE(command, run.errors);
  CHECK(run.exit_code == 1);
  const ProgramRun info = run_in_shell("\"$0\" bag info " + file + " >info", f.folder);
  CHECK(info.exit_code == 1);
  CHECK_THAT(info.errors, ContainsSubstring("the file was not finished"));
  const std::string text = f.text("info");
  const std::size_t begin = text.find(", ") + 2;
  const std::string messages = text.substr(begin, text.find(" messages") - begin);
  CHECK(std::stoi(messages) > 100);
  const std::string failure =
      file + ": No space left on device; the recording ends after " + messages + " messages";
  if (command == "record") {
    CHECK_THAT(run.errors, ContainsSubstring(failure));
  } else {
    CHECK_THAT(f.text("out"), ContainsSubstring("\nfailed: ") && ContainsSubstring("recording: " + failure));
    CHECK_THAT(f.text("r.json"), ContainsSubstring("recording: " + failure));
  }
}

TEST_CASE("a campaign whose results file is full goes on, and keeps the results before") {
  const TemporaryFolder folder;
  const std::string command =
      "(ulimit -f 2; exec \"$0\" simulate --faults none --seeds 1..8 --seconds 12 --jobs 1 --results "
      "results) | cat >out";
  const ProgramRun run = run_in_shell(command, folder);
  CAPTURE(run.errors);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.errors,
             ContainsSubstring("cannot write results: File too large; the campaign continues without it"));
  CHECK_THAT(text_of(folder.file("out")), ContainsSubstring("8 seeds"));
  const ProgramRun resumed = run_in_shell(
      "\"$0\" simulate --faults none --seeds 1..8 --seconds 12 --jobs 1 --results results >out", folder);
  CHECK_THAT(text_of(folder.file("out")), ContainsSubstring("resuming after "));
  CHECK_THAT(resumed.errors, !ContainsSubstring("cannot"));
}

TEST_CASE("a command that waits for something to print ends with the reader of its output") {
  const RunFixture f;
  const std::string domain = " --domain " + std::to_string(f.domain.number());
  const auto [command, exit_code, message] = GENERATE_REF(
      std::tuple("topic echo world" + domain, 0, ""), std::tuple("topic delay world" + domain, 0, ""),
      std::tuple("audit " + kScenario + domain, 3, "audit: not judged"));
  // Without the signal, which would end the program when it prints.
  const ProgramRun run = run_in_shell("(trap '' PIPE; exec \"$0\" " + command + ") | true", f.folder);
  CAPTURE(command, run.errors);
  CHECK(run.exit_code == exit_code);
  CHECK_THAT(run.errors, ContainsSubstring(message));
  CHECK(run.wall_s < 10);
}

TEST_CASE("a command whose output cannot be written says so, and still writes its files") {
  const RunFixture f;
  struct Case {
    std::string command, file;
  };
  const auto [command, file] = GENERATE_REF(
      Case{"keys init new-keys", "new-keys/private"}, Case{"building b --cells 200 --robots 2", "b/map.pgm"},
      Case{"plan empty --svg p.svg", "p.svg"}, Case{"check " + kScenario + " --svg c.svg", "c.svg"},
      Case{"frame " + kImages + " p.png --detections", "p.png"},
      Case{"topic list --domain " + std::to_string(f.domain.number()), ""});
  const auto [output, cause] =
      GENERATE(std::pair(">/dev/full", "No space left on device"), std::pair(">&-", "it is closed"),
               std::pair("| true", "the process that read it has ended"));
  const bool is_pipe = output == std::string("| true");
  const ProgramRun run =
      run_in_shell(is_pipe ? "(trap '' PIPE; sleep 0.3; exec \"$0\" " + command + ") | true"
                           : "\"$0\" " + command + " " + output,
                   f.folder);
  CAPTURE(command, output, run.errors);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.errors, ContainsSubstring(std::string("cannot write to standard output: ") + cause));
  if (!file.empty()) CHECK(std::filesystem::exists(f.folder.file(file)));
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
