// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fmt/format.h>
#include <sstream>
#include <sys/wait.h>
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
const std::string kTitle = "robot  team    state";
constexpr int kRobots = 8;
constexpr auto kPatience = kIsSanitized ? 240s : 60s;

std::string program() {
  return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "sidestep").string();
}

/// Runs the words as a program in a terminal, with the environment of this process. Returns what it prints.
std::string printed_in_terminal(const std::vector<std::string>& command, const std::string& folder,
                                int columns) {
  PseudoTerminal terminal(columns, 24);
  const pid_t process = fork();
  if (process == 0) {
    setsid();
    ioctl(terminal.slave(), TIOCSCTTY, 0);
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
      dup2(terminal.slave(), descriptor);
    std::vector<std::string> words = command;
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    if (chdir(folder.c_str()) == 0) execv(arguments[0], arguments.data());
    _exit(127);
  }
  terminal.close_own_end();
  std::string bytes;
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < end && terminal.read_some(bytes)) {
  }
  kill(process, SIGKILL);
  waitpid(process, nullptr, 0);
  return bytes;
}

struct Fixture {
  std::vector<std::string> run() const {
    return {program(),  "run",   kScenario, "--seconds", "1", "--domain", std::to_string(domain.number()),
            "--report", "r.json"};
  }
  /// What a terminal shows at the end of a run.
  Screen screen_of_run(int columns) const {
    bytes = printed_in_terminal(run(), folder.path(), columns);
    Screen screen(columns, 24);
    screen.feed(bytes);
    return screen;
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

TEST_CASE("a simulation keeps its progress in one line of a narrow terminal") {
  const EnvironmentVariable term("TERM", "xterm"), no_color("NO_COLOR", nullptr);
  const int columns = GENERATE(60, 80);
  const TemporaryFolder folder;
  // Long enough in real time to redraw the line.
  const std::string bytes = printed_in_terminal(
      {program(), "simulate", SIDESTEP_SOURCE_DIR "/deploy/scenarios/two-teams-22.yaml", "--seconds", "5"},
      folder.path(), columns);
  Screen screen(columns, 24);
  screen.feed(bytes);
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
