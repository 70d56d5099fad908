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
const std::string kOnDemand = SIDESTEP_SOURCE_DIR "/deploy/scenarios/on-demand.yaml";
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
  std::string domain_option() const { return " --domain " + std::to_string(domain.number()); }
  /// The exit code of a command while a run of the scenario grants. The run is ended afterwards.
  ProgramRun during_run(const std::string& scenario, const std::string& command) const {
    return run_in_shell(
        "\"$0\" run " + scenario + " --seconds 60 --report run.json" + domain_option() +
            " >run & run=$!\nuntil grep -q 'coordinator grants' run || ! kill -0 $run; do sleep 0.1; "
            "done\n" +
            command + "; code=${PIPESTATUS[0]}\nkill -INT $run; wait $run; exit $code",
        folder);
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

TEST_CASE("a command whose output cannot be written says so, and still does its work") {
  const RunFixture f;
  struct Case {
    std::string command;
    std::string work;               // what a shell must find done afterwards
    std::string preparation = ":";  // what a shell does before
  };
  const std::string records =
      "\"$0\" simulate " + kScenario + " --seconds 1 --report r.json --record r.mcap >log";
  const std::string issues = "\"$0\" keys init k >log && \"$0\" keys issue 'agent 3' --keys k >log";
  const auto [command, work, preparation] =
      GENERATE_REF(Case{"new hall.yaml", "\"$0\" check hall.yaml >log"},
                   Case{"keys init new-keys", "test -d new-keys/private"},
                   Case{"keys issue operator viewer --keys k",
                        "test -f k/enclaves/operator/key.pem -a -f k/enclaves/viewer/key.pem", issues},
                   Case{"keys revoke 'agent 3' --keys k", "test ! -e k/enclaves/agent-3", issues},
                   Case{"keys show --keys k", "true", issues},
                   Case{"building b --cells 200 --robots 2", "test -f b/map.pgm"},
                   Case{"plan empty --svg p.svg", "test -f p.svg"},
                   Case{"check " + kScenario + " --svg c.svg", "test -f c.svg"},
                   Case{"frame " + kImages + " p.png --detections", "test -f p.png"},
                   Case{"report r.json --html r.html --svg r.svg",
                        "grep -q '</html>' r.html && grep -q '</svg>' r.svg", records},
                   Case{"bag info r.mcap", "true", records},
                   Case{"record " + kScenario + " --seconds 0.5 --out l.mcap" + f.domain_option(),
                        "\"$0\" bag info l.mcap >log"},
                   Case{"status" + f.domain_option(), "true"}, Case{"clock" + f.domain_option(), "true"},
                   Case{"topic list" + f.domain_option(), "true"});
  const auto [output, cause] =
      GENERATE(std::pair(">/dev/full", "No space left on device"), std::pair(">&-", "it is closed"),
               std::pair("| true", "the process that read it has ended"));
  REQUIRE(run_in_shell(preparation, f.folder).exit_code <= 1);
  const bool is_pipe = output == std::string("| true");
  const ProgramRun run =
      run_in_shell(is_pipe ? "(trap '' PIPE; sleep 0.3; exec \"$0\" " + command + ") | true"
                           : "\"$0\" " + command + " " + output,
                   f.folder);
  CAPTURE(command, output, run.errors);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.errors, ContainsSubstring(std::string("cannot write to standard output: ") + cause));
  CHECK(run_in_shell(work, f.folder).exit_code == 0);
}

TEST_CASE("a command that prints nothing, or whose exit code says all, ignores that its output is lost") {
  const TemporaryFolder folder;
  const auto [command, work] =
      GENERATE(std::pair("bag cut r.mcap --from 0.2 --out c.mcap", "\"$0\" bag info c.mcap >log"),
               std::pair("bag merge r.mcap --out m.mcap", "\"$0\" bag info m.mcap >log"),
               std::pair("test $TEST --junit j.xml", "grep -q '<testsuite .*failures=\"0\"' j.xml"));
  const std::string output = GENERATE(">/dev/full", ">&-", "| true");
  REQUIRE(
      run_in_shell("\"$0\" simulate " + kScenario + " --seconds 1 --record r.mcap >log", folder).exit_code <=
      1);
  const ProgramRun run = run_in_shell("TEST=" + kFaultTest + "; \"$0\" " + command + " " + output, folder);
  CAPTURE(command, output, run.errors);
  CHECK(run.exit_code == 0);
  CHECK(run_in_shell(work, folder).exit_code == 0);
}

TEST_CASE("a monitor serves and records although nobody reads the address of its page") {
  const RunFixture f;
  const std::string output = GENERATE(">/dev/full", ">&-", "| true");
  // As a part of a run, it ends with its input.
  const ProgramRun run = run_in_shell("\"$0\" monitor " + kScenario + " --of-run --port 0 --record r.mcap" +
                                          f.domain_option() + " <<<'' " + output,
                                      f.folder);
  CAPTURE(output, run.errors);
  CHECK(run.exit_code == 0);
  CHECK(run_in_shell("\"$0\" bag info r.mcap >info", f.folder).exit_code == 0);
}

TEST_CASE("an order whose progress cannot be printed ends its command, and stays in force") {
  const RunFixture f;
  const auto [output, cause] =
      GENERATE(std::pair(">/dev/full", "No space left on device"), std::pair(">&-", "it is closed"),
               std::pair("| true", "the process that read it has ended"));
  const std::string go = "(trap '' PIPE; exec \"$0\" go 0 -2,-1.5 --wait" + f.domain_option() + ") ";
  const ProgramRun run =
      f.during_run(kOnDemand, go + output + "; code=${PIPESTATUS[0]}; \"$0\" status --once" +
                                  f.domain_option() + " >status; (exit $code)");
  CAPTURE(output, run.errors, f.text("status"));
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.errors, ContainsSubstring(std::string("cannot write to standard output: ") + cause));
  CHECK_THAT(f.text("status"), ContainsSubstring("operator"));
}

TEST_CASE("a fault of the network ends in time although nobody reads that it has begun") {
  const RunFixture f;
  const std::string output = GENERATE(">/dev/full", "| true");
  const std::string fault =
      "\"$0\" fault network --target 'agent 0' --cut --seconds 0.5" + f.domain_option() + " " + output;
  const std::string go = "\"$0\" go 0 -2,-1.5" + f.domain_option() + " >go";
  const ProgramRun run = f.during_run(kOnDemand + " --faults",
                                      fault + "; code=${PIPESTATUS[0]}; " + go + " || code=9; (exit $code)");
  CAPTURE(output, run.errors, f.text("go"));
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.errors, ContainsSubstring("cannot write to standard output: "));
}

TEST_CASE("the picture of a run's processes is written although nobody reads their list") {
  const RunFixture f;
  const std::string output = GENERATE(">/dev/full", "| true");
  const ProgramRun run =
      f.during_run(kOnDemand, "\"$0\" graph --svg g.svg" + f.domain_option() + " " + output);
  CAPTURE(output, run.errors);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.errors, ContainsSubstring("cannot write to standard output: "));
  CHECK_THAT(f.text("g.svg"), ContainsSubstring("</svg>"));
}

TEST_CASE("pictures of a run's images are written although nobody reads their names") {
  const RunFixture f;
  const std::string output = GENERATE(">/dev/full", "| true");
  const ProgramRun run =
      f.during_run(kImages, "\"${0%/*}/sidestep-vision\" view --scenario " + kImages +
                                " --out pictures --count 2" + f.domain_option() + " " + output);
  CAPTURE(output, run.errors);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.errors, ContainsSubstring("cannot write to standard output: "));
  CHECK(std::filesystem::exists(f.folder.file("pictures/camera-0-0002.png")));
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
