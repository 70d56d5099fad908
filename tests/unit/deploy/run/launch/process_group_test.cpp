// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/process_group.hpp"

#include <algorithm>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/file/temporary_folder.hpp"
#include "tests/catch.hpp"
#include "tests/forked.hpp"
#include "tests/text_of.hpp"

// glibc 2.36 declares the functions of this header without C linkage.
extern "C" {
#include <sys/pidfd.h>
}

namespace sidestep {
namespace {

using namespace std::chrono_literals;
using Kind = ChildEvent::Kind;
using SteadyClock = std::chrono::steady_clock;

constexpr auto kDeadline = 20s;

/// A folder that is removed when the process ends.
struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("process-group-" + std::to_string(getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
};

std::string log_path() {
  static const Folder folder;
  return (folder.path / "children.log").string();
}

ChildSpec shell(const std::string& name, const std::string& script, bool restart = false) {
  return {name, {"/bin/sh", "-c", script}, restart};
}

/// Returns the next event, or fails the test.
ChildEvent next_event(ProcessGroup& group) {
  const auto events = group.poll(kDeadline);
  REQUIRE(events.size() == 1);
  return events[0];
}

/// Waits until a child has printed this line.
void wait_for_line(ProcessGroup& group, const std::string& name, const std::string& line) {
  const auto until = SteadyClock::now() + kDeadline;
  while (SteadyClock::now() < until) {
    for (const auto& printed : group.last_lines(name)) {
      if (printed == line) return;
    }
    group.poll(10ms);
  }
  FAIL(name + " did not print " + line);
}

}  // namespace

TEST_CASE("a death is reported with exit code or signal, and the last lines are kept") {
  ProcessGroup group(log_path());
  const pid_t pid = group.start(shell("talker", "echo first; echo second >&2; printf unfinished; exit 3"));
  const ChildEvent event = next_event(group);
  CHECK(event.kind == Kind::kDied);
  CHECK(event.pid == pid);
  CHECK(event.name == "talker");
  CHECK(event.reason == "exit code 3");
  CHECK_FALSE(event.will_restart);
  CHECK(group.last_lines("talker") == std::vector<std::string>{"first", "second", "unfinished"});
  CHECK_THAT(text_of(log_path()),
             ContainsSubstring("talker: first\n") && ContainsSubstring("talker: unfinished\n"));

  group.start(shell("victim", "kill -9 $$"));
  CHECK(next_event(group).reason == "signal 9 (SIGKILL)");
  group.start(shell("aborter", "kill -ABRT $$"));
  CHECK(next_event(group).reason == "signal 6 (SIGABRT)");
  CHECK(group.running() == 0);
}

TEST_CASE("children's processor time and memory are summed over restarts") {
  ProcessGroup group(log_path());
  group.start(shell("busy", "i=0; while [ $i -lt 100000 ]; do i=$((i+1)); done", true));
  CHECK(group.resource_use().empty());
  CHECK(next_event(group).kind == Kind::kDied);
  const ProcessUse once = group.resource_use().at("busy");
  CHECK(once.cpu_s > 0.001);
  CHECK(once.max_memory_mb > 0.5);
  CHECK(once.max_memory_mb < 100);
  CHECK(next_event(group).kind == Kind::kStarted);
  CHECK(next_event(group).kind == Kind::kDied);
  CHECK(group.resource_use().at("busy").cpu_s > 1.2 * once.cpu_s);
}

TEST_CASE("a child runs at the requested priority") {
  ProcessGroup group(log_path());
  ChildSpec spec = shell("polite", "nice; exec sleep 60");
  spec.niceness = 3;
  group.start(spec);
  wait_for_line(group, "polite", std::to_string(std::min(getpriority(PRIO_PROCESS, 0) + 3, 19)));
}

TEST_CASE("starting a program that does not exist throws an exception") {
  ProcessGroup group(log_path());
  CHECK_THROWS_WITH(group.start({"ghost", {"/nowhere/ghost"}, false}),
                    ContainsSubstring("cannot start ghost (/nowhere/ghost): No such file"));
}

TEST_CASE("if a program cannot be executed, the last lines of the child state the reason") {
  const std::string path = log_path() + ".script";
  std::ofstream(path) << "not a program\n";
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  ProcessGroup group(log_path());
  group.start({"text", {path}, false});
  CHECK(next_event(group).reason == "exit code 127");
  REQUIRE_FALSE(group.last_lines("text").empty());  // a sanitizer may add a line of its own
  CHECK_THAT(group.last_lines("text")[0], StartsWith("cannot execute " + path));
}

TEST_CASE("a child with `restart` is started again as a new process after each death") {
  ProcessGroup group(log_path());
  const pid_t first = group.start(shell("phoenix", "echo up; exec sleep 1000", true));
  pid_t pid = first;
  for (int life = 0; life < 3; ++life) {
    REQUIRE(kill(pid, SIGKILL) == 0);
    const ChildEvent death = next_event(group);
    CHECK(death.kind == Kind::kDied);
    CHECK(death.reason == "signal 9 (SIGKILL)");
    CHECK(death.will_restart);
    CHECK(group.running() == 0);
    const ChildEvent birth = next_event(group);
    CHECK(birth.kind == Kind::kStarted);
    CHECK(birth.name == "phoenix");
    CHECK(birth.pid != pid);
    CHECK(group.running() == 1);
    pid = birth.pid;
  }
  CHECK(group.terminate(kDeadline).empty());
  CHECK(group.poll(0ms).empty());
}

TEST_CASE("a child that keeps dying is restarted with growing delays, and promptly after a long life",
          "[half-core]") {
  ProcessGroup group(log_path());
  pid_t pid = group.start(shell("mortal", "exec sleep 1000", true));
  const auto restart_delay = [&] {
    kill(pid, SIGKILL);
    REQUIRE(next_event(group).kind == Kind::kDied);
    const auto died_at = SteadyClock::now();
    const ChildEvent start = next_event(group);
    REQUIRE(start.kind == Kind::kStarted);
    pid = start.pid;
    return SteadyClock::now() - died_at;
  };
  CHECK(restart_delay() < 1s);
  for (int i = 0; i < 3; ++i) (void)restart_delay();
  CHECK(restart_delay() > 1500ms);
  // The child lives for more than two seconds.
  CHECK(group.poll(2100ms).empty());
  CHECK(restart_delay() < 1s);
  CHECK(restart_delay() < 1s);
}

TEST_CASE("a child is restarted once on request, whether alive or dead, with new arguments") {
  ProcessGroup group(log_path());
  const pid_t first = group.start(shell("target", "echo first; exec sleep 1000"));
  wait_for_line(group, "target", "first");
  group.restart(shell("target", "echo second; exec sleep 1000"));
  const auto events = group.poll(kDeadline);
  REQUIRE(events.size() == 2);
  CHECK(events[0].pid == first);
  CHECK(events[0].will_restart);
  CHECK(events[1].kind == Kind::kStarted);
  wait_for_line(group, "target", "second");
  CHECK(group.send_signal("target", SIGKILL));
  CHECK_FALSE(next_event(group).will_restart);
  CHECK_FALSE(group.send_signal("target", SIGKILL));
  group.restart(shell("target", "echo third; exec sleep 1000"));
  CHECK(next_event(group).kind == Kind::kStarted);
  wait_for_line(group, "target", "third");
  CHECK(group.running() == 1);
  CHECK_THROWS_WITH(group.restart(shell("nobody", "true")), ContainsSubstring("there is no process nobody"));
  CHECK_FALSE(group.send_signal("nobody", SIGKILL));
}

TEST_CASE("terminating ends children by SIGTERM, then by SIGKILL, and restarts none") {
  ProcessGroup group(log_path());
  group.start(
      shell("polite", "trap 'echo bye; exit 0' TERM; echo ready; while :; do sleep 0.01; done", true));
  const pid_t stubborn =
      group.start(shell("stubborn", "trap '' TERM; echo ready; while :; do sleep 0.01; done", true));
  wait_for_line(group, "polite", "ready");
  wait_for_line(group, "stubborn", "ready");
  CHECK(group.terminate(1s) == std::vector<std::string>{"stubborn"});
  CHECK(group.running() == 0);
  CHECK(group.last_lines("polite").back() == "bye");
  CHECK(kill(stubborn, 0) == -1);
  CHECK(group.poll(0ms).empty());
}

TEST_CASE("a child that is asked to end is not waited for, and not restarted when it has ended") {
  ProcessGroup group(log_path());
  group.start(shell("agent", "trap 'echo bye; exit 0' TERM; echo ready; while :; do sleep 0.01; done", true));
  group.start(shell("vision", "exec sleep 1000", true));
  wait_for_line(group, "agent", "ready");
  CHECK(group.ask_to_end("agent"));
  const ChildEvent event = next_event(group);
  CHECK(event.name == "agent");
  CHECK(event.reason == "exit code 0");
  CHECK_FALSE(event.will_restart);
  CHECK_FALSE(group.ask_to_end("agent"));
  CHECK_FALSE(group.ask_to_end("nobody"));
  CHECK(group.running() == 1);
  REQUIRE(group.send_signal("vision", SIGKILL));
  CHECK(next_event(group).will_restart);
  CHECK_FALSE(group.ask_to_end("vision"));  // it is about to be restarted
  CHECK(group.poll(500ms).empty());
}

TEST_CASE("abandoning kills all children at once, but only asks those that drive robots to end") {
  const TemporaryFolder folder;
  pid_t robots = 0;
  {
    ProcessGroup group(log_path());
    ChildSpec spec = shell("robots", "trap 'while [ ! -e " + folder.file("rest") +
                                         " ]; do sleep 0.01; done; exit 7' TERM; echo ready; while :; do "
                                         "sleep 0.01; done");
    spec.rest_time = 10s;
    robots = group.start(spec);
    group.start(shell("agent", "trap '' TERM; echo ready; while :; do sleep 0.01; done", true));
    wait_for_line(group, "robots", "ready");
    wait_for_line(group, "agent", "ready");
    group.abandon();
    CHECK(group.running() == 1);
    CHECK(next_event(group).reason == "signal 9 (SIGKILL)");
    CHECK(group.running() == 0);
  }
  int status = 0;
  CHECK(waitpid(robots, &status, WNOHANG) == 0);
  std::ofstream(folder.file("rest")) << "at rest\n";
  REQUIRE(waitpid(robots, &status, 0) == robots);
  CHECK(WEXITSTATUS(status) == 7);
}

TEST_CASE("terminating spares a child that outlasts the run, but not at the end of the group") {
  pid_t page = 0;
  {
    ProcessGroup group(log_path());
    ChildSpec spec = shell("page", "exec sleep 1000");
    spec.outlasts_run = true;
    page = group.start(spec);
    group.start(shell("agent", "exec sleep 1000"));
    CHECK(group.running() == 1);
    CHECK(group.terminate(kDeadline).empty());
    CHECK(group.running() == 0);
    CHECK(group.has_outlasting());
    CHECK(kill(page, 0) == 0);
    SECTION("when all are terminated") {
      CHECK(group.terminate_all(kDeadline).empty());
      CHECK_FALSE(group.has_outlasting());
    }
    SECTION("when the group ends") {}
  }
  CHECK(kill(page, 0) == -1);
}

TEST_CASE("a restarted child reads its input again, and terminating closes a child's stdin") {
  ProcessGroup group(log_path());
  const std::string text(100'000, 'x');
  group.start({"reader", {"/bin/sh", "-c", "head -c 100000 | wc -c; read end; echo over"}, true, text});
  const auto lines = [&] { return group.last_lines("reader"); };
  const auto until = SteadyClock::now() + kDeadline;
  while (lines().empty() && SteadyClock::now() < until) group.poll(1ms);
  REQUIRE(lines() == std::vector<std::string>{"100000"});
  CHECK(group.terminate(kDeadline).empty());
  CHECK(lines().back() == "over");

  ProcessGroup twice(log_path());
  twice.start({"reader", {"/bin/sh", "-c", "head -c 3; kill -9 $$"}, true, "abc"});
  while (twice.last_lines("reader").size() < 2 && SteadyClock::now() < until) twice.poll(1ms);
  CHECK(twice.last_lines("reader") == std::vector<std::string>{"abc", "abc"});
}

TEST_CASE("input can be added while a child runs, and a restarted child gets all input again") {
  ProcessGroup group(log_path());
  const auto until = SteadyClock::now() + kDeadline;
  const auto wait_for_lines = [&](std::vector<std::string> expected) {
    while (group.last_lines("reader") != expected && SteadyClock::now() < until) group.poll(1ms);
    CHECK(group.last_lines("reader") == expected);
  };
  group.start({"reader", {"/bin/sh", "-c", "while read -r word; do echo $word; done"}, true, "first\n"});
  group.add_input("reader", "second\n");
  wait_for_lines({"first", "second"});
  group.add_input("reader", "third\n");
  wait_for_lines({"first", "second", "third"});
  REQUIRE(group.send_signal("reader", SIGKILL));
  wait_for_lines({"first", "second", "third", "first", "second", "third"});
  group.add_input("nobody", "x");

  group.start(shell("deaf", "cat; echo end"));
  group.add_input("deaf", "x");
  while (group.last_lines("deaf").empty() && SteadyClock::now() < until) group.poll(1ms);
  CHECK(group.last_lines("deaf") == std::vector<std::string>{"end"});
}

TEST_CASE("input may exceed the buffer of a child's stdin, and a child that does not read does no harm") {
  ProcessGroup group(log_path());
  const std::string text(8 << 20, 'x');
  group.start({"reader", {"/bin/sh", "-c", "head -c 8388608 | wc -c"}, false, text});
  group.start({"closed", {"/bin/sh", "-c", "exec <&-; echo closed; sleep 0.2; echo end"}, false, text});
  const auto until = SteadyClock::now() + kDeadline;
  while (group.running() > 0 && SteadyClock::now() < until) group.poll(1ms);
  CHECK(group.last_lines("reader") == std::vector<std::string>{"8388608"});
  CHECK(group.last_lines("closed") == std::vector<std::string>{"closed", "end"});
}

TEST_CASE("a child that prints a lot does not block, and only its last lines are kept") {
  ProcessGroup group(log_path());
  group.start(shell("chatter", "i=0; while [ $i -lt 20000 ]; do echo line $i; i=$((i+1)); done"));
  CHECK(next_event(group).reason == "exit code 0");
  const auto lines = group.last_lines("chatter");
  CHECK(lines.size() == 20);
  CHECK(lines.back() == "line 19999");
}

TEST_CASE("children inherit no descriptors, and a group waits only for its own children") {
  const int inheritable = open("/dev/null", O_RDONLY);
  REQUIRE(inheritable >= 0);
  const pid_t stranger = fork();
  if (stranger == 0) _exit(42);
  {
    ProcessGroup group(log_path());
    group.start(shell("lister", "echo /proc/self/fd/*"));
    CHECK(next_event(group).name == "lister");
    // Descriptor 3 is the folder itself, which the shell opens to expand the glob.
    CHECK(group.last_lines("lister")[0] == "/proc/self/fd/0 /proc/self/fd/1 /proc/self/fd/2 /proc/self/fd/3");
  }
  close(inheritable);
  int status = 0;
  REQUIRE(waitpid(stranger, &status, 0) == stranger);
  CHECK(WEXITSTATUS(status) == 42);
}

TEST_CASE("no child outlives its launcher, even after SIGKILL") {
  const std::string path = log_path();
  int pids[2];
  REQUIRE(pipe(pids) == 0);
  const pid_t launcher = fork();
  if (launcher == 0) {
    ProcessGroup group(path);
    for (int i = 0; i < 3; ++i) {
      const pid_t child =
          group.start(shell("child", "trap '' TERM HUP INT; echo ready; while :; do sleep 0.05; done", true));
      if (write(pids[1], &child, sizeof child) != sizeof child) _exit(1);
    }
    while (true) group.poll(1000ms);
  }
  int watched[3];
  for (int& pidfd : watched) {
    pid_t child = 0;
    REQUIRE(read(pids[0], &child, sizeof child) == sizeof child);
    pidfd = pidfd_open(child, 0);
    REQUIRE(pidfd >= 0);
  }
  REQUIRE(kill(launcher, SIGKILL) == 0);
  REQUIRE(waitpid(launcher, nullptr, 0) == launcher);
  for (int& pidfd : watched) {
    pollfd ended{pidfd, POLLIN, 0};
    CHECK(::poll(&ended, 1, static_cast<int>(std::chrono::milliseconds(kDeadline).count())) == 1);
    close(pidfd);
  }
  close(pids[0]);
  close(pids[1]);
}

TEST_CASE("programs are found in the folder of the running program") {
  CHECK(std::filesystem::exists(sibling_program_path("unit_deploy_launch")));
}

TEST_CASE("a log on a full disk is reported once, and the children go on") {
  const TemporaryFolder folder;
  const std::string errors = forked([&]() -> std::string {
    const std::string file = folder.file("errors");
    dup2(open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    ProcessGroup group("/dev/full");
    group.start(shell("child", "echo one; echo two"));
    const bool has_ended = group.poll(kDeadline).size() == 1;
    const bool has_lines = group.last_lines("child") == std::vector<std::string>{"one", "two"};
    return (has_ended && has_lines ? "" : "lost: ") + text_of(file);
  });
  CHECK(errors == "cannot write /dev/full: No space left on device; lines are missing from here on\n");
}

TEST_CASE("a log in a folder that cannot be created is refused with the cause") {
  CHECK_THROWS_WITH(ProcessGroup("/dev/null/r.log"), "cannot write /dev/null/r.log: Not a directory");
}

}  // namespace sidestep
