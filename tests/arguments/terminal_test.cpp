// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <regex>
#include <sstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "common/file/temporary_folder.hpp"
#include "tests/arguments/program_run.hpp"
#include "tests/catch.hpp"
#include "tests/pseudo_terminal.hpp"
#include "tests/sanitized.hpp"
#include "tests/screen.hpp"
#include "tests/test_domain.hpp"
#include "tests/text_of.hpp"

namespace sidestep::terminal_test {
namespace {

using namespace std::chrono_literals;

const std::string kScenario = SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml";
const std::string kOnDemand = SIDESTEP_SOURCE_DIR "/deploy/scenarios/on-demand.yaml";
const std::string kTitle = "robot  team    state";
constexpr int kRobots = 8;
constexpr auto kPatience = kIsSanitized ? 240s : 60s;

std::string program() {
  return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "sidestep").string();
}

/// Replaces this process by the program of these words.
[[noreturn]] void execute(std::vector<std::string> words, const std::string& folder) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  if (chdir(folder.c_str()) == 0) execv(arguments[0], arguments.data());
  _exit(127);
}

/// What a screen of this many columns shows after these bytes.
Screen screen_after(const std::string& bytes, int columns) {
  Screen screen(columns, 24);
  screen.feed(bytes);
  return screen;
}

using ScreenCondition = std::function<bool(const Screen& screen)>;

/// Runs the words as a program in a terminal, with the environment of this process. Once the screen fulfils
/// the condition, sends Ctrl-C's signal. Returns what it prints.
std::string printed_in_terminal(
    const std::vector<std::string>& command, const std::string& folder, int columns,
    const ScreenCondition& is_enough = [](const Screen&) { return false; }) {
  PseudoTerminal terminal(columns, 24);
  const pid_t process = fork();
  if (process == 0) {
    setsid();
    ioctl(terminal.slave(), TIOCSCTTY, 0);
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
      dup2(terminal.slave(), descriptor);
    execute(command, folder);
  }
  terminal.close_own_end();
  std::string bytes;
  bool is_interrupted = false;
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < end && terminal.read_some(bytes)) {
    if (is_interrupted || !is_enough(screen_after(bytes, columns))) continue;
    is_interrupted = true;
    kill(process, SIGINT);
  }
  kill(process, SIGKILL);
  waitpid(process, nullptr, 0);
  return bytes;
}

/// A run of robots without orders that grants, until the object ends.
class OnDemandRun {
 public:
  OnDemandRun() {
    process_ = fork();
    if (process_ == 0) {
      const int file = open(folder_.file("out").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO}) dup2(file, descriptor);
      execute({program(), "run", kOnDemand, "--seconds", "120", "--report", "r.json", "--domain",
               std::to_string(domain_.number())},
              folder_.path());
    }
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (output().find("coordinator grants") == std::string::npos && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(50ms);
  }
  ~OnDemandRun() {
    kill(process_, SIGINT);
    waitpid(process_, nullptr, 0);
  }
  OnDemandRun(const OnDemandRun&) = delete;
  OnDemandRun& operator=(const OnDemandRun&) = delete;

  std::string output() const { return text_of(folder_.file("out")); }
  const std::string& folder() const { return folder_.path(); }
  /// The command with the domain of the run.
  std::vector<std::string> beside(const std::string& command) const {
    return {program(), command, "--domain", std::to_string(domain_.number())};
  }

 private:
  TemporaryFolder folder_;
  TestDomain domain_;
  pid_t process_ = 0;
};

/// A command that shows a table, what each robot's row has, and how many columns the table needs for it.
struct TableCommand {
  std::string name, title, row;
  bool is_complete(const Screen& screen) const {
    const auto lines = screen.lines();
    return std::ranges::count_if(lines, [this](const std::string& line) {
             return std::regex_search(line, std::regex(row));
           }) == kRobots;
  }
};

const TableCommand kTables[] = {
    {"status", "robot  state     ordered by goal left s  why", "^ {4}[0-7]  no order  - "},
    {"clock", "process        clock bound                    offset",
     "^agent [0-7]        (within|unclear) +[+-][0-9]"}};

struct Fixture {
  std::vector<std::string> run() const {
    return {program(),  "run",   kScenario, "--seconds", "1", "--domain", std::to_string(domain.number()),
            "--report", "r.json"};
  }
  /// What a terminal shows at the end of a run.
  Screen screen_of_run(int columns) const {
    bytes = printed_in_terminal(run(), folder.path(), columns);
    return screen_after(bytes, columns);
  }

  TemporaryFolder folder;
  TestDomain domain;
  mutable std::string bytes;
};

/// The lines of the table, without the summary above them; empty unless there is one table.
std::vector<std::string> table_in(const std::vector<std::string>& lines) {
  const auto title = std::ranges::find_if(lines, [](const auto& line) { return line.starts_with(kTitle); });
  const auto is_title = [](const auto& line) { return line.find(kTitle) != line.npos; };
  if (std::ranges::count_if(lines, is_title) != 1 || lines.end() - title < 1 + kRobots) return {};
  return {title, title + 1 + kRobots};
}

void check_table(const std::vector<std::string>& table, int columns) {
  REQUIRE(table.size() == 1 + kRobots);
  for (const std::string& line : table) CHECK(line.size() < static_cast<std::size_t>(columns));
  for (int robot = 0; robot < kRobots; ++robot)
    CHECK_THAT(table[1 + static_cast<std::size_t>(robot)], StartsWith(fmt::format("{:5}  ", robot)));
  CHECK((table[0].find("denials") != std::string::npos) == (columns >= 80));
  CHECK((table[0].find("negotiation") != std::string::npos) == (columns >= 120));
}

}  // namespace

TEST_CASE("a run shows one table in a terminal of 60, 80 or 120 columns") {
  const EnvironmentVariable term("TERM", "xterm-256color"), no_color("NO_COLOR", nullptr);
  const int columns = GENERATE(60, 80, 120);
  const Fixture f;
  const Screen screen = f.screen_of_run(columns);
  INFO(screen.text());
  CAPTURE(columns);
  check_table(table_in(screen.lines()), columns);
  CHECK(screen.unknown().empty());
  CHECK(screen.colours() > 0);
  CHECK_THAT(f.bytes, ContainsSubstring("\x1b[31mfailed: time limit of 1 s"));
}

TEST_CASE("a run obeys NO_COLOR, and prints no control characters to a dumb terminal") {
  const bool is_dumb = GENERATE(false, true);
  const EnvironmentVariable term("TERM", is_dumb ? "dumb" : "xterm"), no_color("NO_COLOR", "1");
  const Fixture f;
  const Screen screen = f.screen_of_run(80);
  INFO(screen.text());
  CHECK(screen.colours() == 0);
  CHECK((f.bytes.find('\x1b') == std::string::npos) == is_dumb);
  CHECK(table_in(screen.lines()).empty() == is_dumb);
  CHECK_THAT(screen.text(), ContainsSubstring("failed: time limit of 1 s"));
}

TEST_CASE("a run prints no control characters to a file") {
  const EnvironmentVariable term("TERM", "xterm"), no_color("NO_COLOR", nullptr);
  const Fixture f;
  std::vector<std::string> command{"/bin/bash", "-c", "\"$@\" >out 2>&1", "bash"};
  for (const std::string& word : f.run()) command.push_back(word);
  const arguments::ProgramRun run = arguments::run_program(command, f.folder.path(), kPatience, SIGKILL);
  const std::string text = text_of(f.folder.file("out"));
  CAPTURE(text);
  CHECK(run.exit_code == 1);
  CHECK(text.find('\x1b') == std::string::npos);
  CHECK_THAT(text, ContainsSubstring(" of 8 arrived") && !ContainsSubstring(kTitle));
}

TEST_CASE("status and clock keep one table in a terminal of 60, 80 or 120 columns", "[slow]") {
  const EnvironmentVariable term("TERM", "xterm-256color"), no_color("NO_COLOR", nullptr);
  const OnDemandRun run;
  INFO(run.output());
  for (const TableCommand& table : kTables) {
    for (const int columns : {60, 80, 120}) {
      const std::string bytes =
          printed_in_terminal(run.beside(table.name), run.folder(), columns,
                              [&](const Screen& screen) { return table.is_complete(screen); });
      const Screen screen = screen_after(bytes, columns);
      INFO(table.name << ", " << columns << " columns\n" << screen.text());
      CHECK(table.is_complete(screen));
      CHECK(screen.count(table.title) == 1);
      CHECK(screen.wraps() == 0);
      CHECK(screen.unknown().empty());
      CHECK(screen.colours() == 0);
    }
  }
}

TEST_CASE("status and clock print one table without control characters to a dumb terminal or a file",
          "[slow]") {
  const EnvironmentVariable term("TERM", "dumb"), no_color("NO_COLOR", "1");
  const OnDemandRun run;
  INFO(run.output());
  for (const TableCommand& table : kTables) {
    const std::vector<std::string> once = run.beside(table.name);
    std::vector<std::string> to_file{"/bin/bash", "-c", "\"$@\" >table 2>&1", "bash"};
    to_file.insert(to_file.end(), once.begin(), once.end());
    const std::string shown = printed_in_terminal(once, run.folder(), 120);
    (void)arguments::run_program(to_file, run.folder(), kPatience, SIGKILL);
    for (const std::string& bytes : {shown, text_of(run.folder() + "/table")}) {
      INFO(table.name << "\n" << bytes);
      CHECK(bytes.find('\x1b') == std::string::npos);
      // A terminal puts a carriage return before each line feed; a file has none.
      const Screen screen = screen_after(std::regex_replace(bytes, std::regex("\r?\n"), "\r\n"), 200);
      CHECK(table.is_complete(screen));
      CHECK(screen.count(table.title) == 1);
    }
  }
}

TEST_CASE(
    "conformance keeps what it does in the last line of a narrow terminal, and prints rows only to others",
    "[slow]") {
  const bool is_dumb = GENERATE(false, true);
  const int columns = GENERATE(60, 80, 120);
  const EnvironmentVariable term("TERM", is_dumb ? "dumb" : "xterm"), no_color("NO_COLOR", nullptr);
  const TemporaryFolder folder;
  const TestDomain domain;
  const std::string bytes = printed_in_terminal(
      {program(), "conformance", SIDESTEP_SOURCE_DIR "/deploy/scenarios/league/lone-robot.yaml", "--driver",
       "simulator", "--domain", std::to_string(domain.number())},
      folder.path(), columns,
      [](const Screen& screen) { return screen.count("passed      ") + screen.count("FAILED      ") > 0; });
  const Screen screen = screen_after(bytes, columns);
  CAPTURE(is_dumb, columns);
  INFO(screen.text());
  const std::vector<std::string> lines = screen.lines();
  REQUIRE_FALSE(lines.empty());
  CHECK_THAT(lines.front(), StartsWith("passed      "));
  CHECK(screen.count("... ") == 0);
  CHECK((bytes.find("\r\x1b[K... ") == std::string::npos) == is_dumb);
  CHECK((bytes.find('\x1b') == std::string::npos) == is_dumb);
  CHECK(screen.unknown().empty());
  CHECK(screen.colours() == 0);
}

TEST_CASE("a simulation keeps its progress in one line of a narrow terminal") {
  const EnvironmentVariable term("TERM", "xterm"), no_color("NO_COLOR", nullptr);
  const int columns = GENERATE(60, 80);
  const TemporaryFolder folder;
  // Long enough in real time to redraw the line.
  const std::string bytes = printed_in_terminal(
      {program(), "simulate", SIDESTEP_SOURCE_DIR "/deploy/scenarios/two-teams-22.yaml", "--seconds", "20"},
      folder.path(), columns);
  const Screen screen = screen_after(bytes, columns);
  INFO(screen.text());
  CHECK_THAT(bytes, ContainsSubstring("\r\x1b[K  "));
  CHECK(screen.count(" of 22 arrived") == 0);
  CHECK(screen.unknown().empty());
  CHECK_THAT(screen.text(), ContainsSubstring("22 robots arrived"));
}

TEST_CASE("a run shows one table in tmux") {
  if (!std::filesystem::exists("/usr/bin/tmux")) {
    WARN("tmux is not installed");
    return;
  }
  const int columns = GENERATE(60, 80, 120);
  const Fixture f;
  std::string command;
  for (const std::string& word : f.run()) command += "'" + word + "' ";
  // The terminal stays after the run, so that its content can be captured.
  const std::string script = fmt::format(
      "tmux() {{ /usr/bin/tmux -S $PWD/socket -f /dev/null \"$@\"; }}\ntrap 'tmux kill-server' EXIT TERM\n"
      "tmux new-session -d -x {} -y 24 \"{}; echo ended; sleep 60\"\n"
      "until tmux capture-pane -p -S - | grep -q '^ended'; do sleep 0.2; done\n"
      "tmux capture-pane -p -S - >screen",
      columns, command);
  const arguments::ProgramRun run =
      arguments::run_program({"/bin/bash", "-c", script}, f.folder.path(), kPatience, SIGTERM);
  CAPTURE(columns, run.errors);
  CHECK(run.exit_code == 0);
  std::vector<std::string> lines;
  const std::string text = text_of(f.folder.file("screen"));
  INFO(text);
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  check_table(table_in(lines), columns);
}

}  // namespace sidestep::terminal_test
