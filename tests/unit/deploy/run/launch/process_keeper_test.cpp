// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/process_keeper.hpp"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <optional>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "common/file/temporary_folder.hpp"
#include "common/file/write_file.hpp"
#include "deploy/run/launch/end_process.hpp"
#include "tests/catch.hpp"
#include "tests/text_of.hpp"

namespace sidestep::process_keeper_test {
namespace {

using namespace std::chrono_literals;
using Deaths = std::vector<std::string>;

/// Set in a director when the director is asked to end.
volatile std::sig_atomic_t is_asked_to_end = 0;
/// Set in a director when the user presses Ctrl-C again.
volatile std::sig_atomic_t is_interrupted = 0;

void obey_sigterm() {
  is_asked_to_end = 0;
  std::signal(SIGTERM, [](int) { is_asked_to_end = 1; });
}

ChildSpec shell(const std::string& name, const std::string& script) {
  return {name, {"/bin/sh", "-c", script}, false};
}

bool is_alive(pid_t pid) { return kill(pid, 0) == 0; }

/// Waits in a director for a condition, and fails after ten seconds.
template <typename Condition>
void wait_for(Condition condition) {
  for (int i = 0; !condition(); ++i) {
    if (i == 10'000) std::_Exit(99);
    std::this_thread::sleep_for(1ms);
  }
}

struct Fixture {
  std::string file(const std::string& name) const { return folder.file(name); }
  std::string text(const std::string& name) const { return text_of(file(name)); }
  int keep(std::function<int(Processes&, const Deaths&)> run) {
    DirectorWork work{std::move(run), [this](const std::string& reason) { lost = reason; }};
    if (shutdown_timeout) work.shutdown_timeout = *shutdown_timeout;
    if (exit_timeout) work.exit_timeout = *exit_timeout;
    work.on_outlasting = on_outlasting;
    return keep_processes(group, work);
  }

  TemporaryFolder folder;
  ProcessGroup group{folder.file("log")};
  std::string lost;
  std::optional<std::chrono::milliseconds> shutdown_timeout, exit_timeout;  // of directors; nullopt: default
  std::function<void()> on_outlasting;
};

}  // namespace

TEST_CASE("processes continue when their director dies, and the next director takes over") {
  Fixture f;
  const int code = f.keep([&](Processes& processes, const Deaths& deaths) {
    const pid_t pid = processes.start(shell("agent", "exec sleep 1000"));
    if (deaths.size() < 2) {
      write_file(f.file("pid" + std::to_string(deaths.size())), std::to_string(pid));
      std::raise(deaths.empty() ? SIGABRT : SIGKILL);
    }
    write_file(f.file("pid2"), std::to_string(pid));
    write_file(f.file("deaths"), deaths[0] + ", " + deaths[1]);
    if (!is_alive(pid) || !processes.send_signal("agent", SIGSTOP)) return 98;
    processes.log("from the third");
    return processes.terminate(0ms) == std::vector<std::string>{"agent"} ? 7 : 97;
  });
  CHECK(code == 7);
  CHECK(f.text("pid0") == f.text("pid1"));
  CHECK(f.text("pid0") == f.text("pid2"));
  CHECK(f.text("deaths") == "signal 6 (SIGABRT), signal 9 (SIGKILL)");
  CHECK(f.lost.empty());
  CHECK_FALSE(is_alive(std::stoi(f.text("pid0"))));
  CHECK_THAT(f.text("log"), ContainsSubstring("signal 6 (SIGABRT)") && ContainsSubstring("from the third"));
}

TEST_CASE("each director learns which processes have died permanently") {
  Fixture f;
  const int code = f.keep([&](Processes& processes, const Deaths& deaths) {
    const pid_t pid = processes.start(shell("simulator", "echo last words; exit 5"));
    (void)processes.start(shell("vision", "exec sleep 1000"));
    std::vector<ChildEvent> events;
    wait_for([&] {
      events = processes.poll(100ms);
      return !events.empty();
    });
    const bool is_right = events.size() == 1 && events[0].name == "simulator" && events[0].pid == pid &&
                          events[0].reason == "exit code 5" && events[0].kind == ChildEvent::Kind::kDied &&
                          !events[0].will_restart &&
                          processes.last_lines("simulator") == std::vector<std::string>{"last words"} &&
                          processes.resource_use().count("simulator") == 1;
    if (!is_right) return 96;
    if (deaths.empty()) std::raise(SIGSEGV);
    return 0;
  });
  CHECK(code == 0);
  CHECK(f.group.running() == 0);
}

TEST_CASE("a director's failed request throws an exception in the director") {
  Fixture f;
  const int code = f.keep([](Processes& processes, const Deaths&) {
    try {
      (void)processes.start({"nobody", {"/no/such/program"}, false});
    } catch (const std::runtime_error& error) {
      return std::string(error.what()).find("cannot start nobody") != std::string::npos ? 0 : 95;
    }
    return 94;
  });
  CHECK(code == 0);
}

TEST_CASE("a director that is asked to end may finish its work and is not replaced if it dies") {
  Fixture f;
  const pid_t self = getpid();
  const auto finish_after_sigterm = [&](Processes& processes, const Deaths&) {
    obey_sigterm();
    (void)processes.start(shell("agent", "exec sleep 1000"));
    kill(self, SIGINT);
    wait_for([] { return is_asked_to_end != 0; });
    return 3;
  };
  CHECK(f.keep(finish_after_sigterm) == 3);
  CHECK(f.lost.empty());
  CHECK(f.group.running() == 0);

  Fixture other;
  const auto dies = [&](Processes& processes, const Deaths& deaths) -> int {
    obey_sigterm();
    (void)processes.start(shell("agent", "exec sleep 1000"));
    kill(self, SIGTERM);
    wait_for([] { return is_asked_to_end != 0; });
    write_file(other.file("deaths"), std::to_string(deaths.size()));
    std::abort();
  };
  CHECK(other.keep(dies) == 1);
  CHECK(other.lost == "signal 6 (SIGABRT)");
  CHECK(other.text("deaths") == "0");
  CHECK(other.group.running() == 0);
}

TEST_CASE("a director that is ending its processes is not asked to end again and may write its report") {
  Fixture f;
  const pid_t self = getpid();
  const auto ends_slowly = [&](Processes& processes, const Deaths&) {
    obey_sigterm();
    // The agent ends only after the time at which the keeping process would ask the director again.
    (void)processes.start(
        shell("agent", "trap 'sleep 1.5; exit 0' TERM; echo ready; while :; do sleep 0.01; done"));
    wait_for([&] { return !processes.last_lines("agent").empty(); });
    kill(self, SIGINT);
    wait_for([] { return is_asked_to_end != 0; });
    signal(SIGTERM, SIG_DFL);
    const bool has_ended = processes.terminate(5s).empty();
    (void)processes.poll(0ms);  // waits until the keeping process has continued
    return has_ended ? 3 : 4;
  };
  CHECK(f.keep(ends_slowly) == 3);
  CHECK(f.lost.empty());
}

TEST_CASE("a second Ctrl-C reaches the director as such, and repeated requests to end do not") {
  Fixture f;
  const bool is_repeated = GENERATE(true, false);
  CAPTURE(is_repeated);
  const pid_t self = getpid();
  const int code = f.keep([&](Processes& processes, const Deaths&) {
    obey_sigterm();
    is_interrupted = 0;
    std::signal(SIGINT, [](int) { is_interrupted = 1; });
    (void)processes.start(shell("agent", "exec sleep 1000"));
    kill(self, SIGINT);
    wait_for([] { return is_asked_to_end != 0; });
    if (is_interrupted != 0) return 91;
    if (is_repeated) {
      // Until enough time has passed for another request.
      wait_for([&] {
        kill(self, SIGINT);
        return is_interrupted != 0;
      });
    } else {
      kill(self, SIGTERM);
      is_asked_to_end = 0;
      wait_for([] { return is_asked_to_end != 0; });
      if (is_interrupted != 0) return 92;
    }
    processes.abandon();
    return processes.terminate(5s).empty() ? 3 : 93;
  });
  CHECK(code == 3);
  CHECK(f.lost.empty());
  CHECK(f.group.running() == 0);
}

TEST_CASE("a director may ask processes to end one after the other, and waits for none") {
  Fixture f;
  const int code = f.keep([&](Processes& processes, const Deaths&) {
    ChildSpec spec = shell("agent", "trap 'exit 0' TERM; echo ready; while :; do sleep 0.01; done");
    spec.restart = true;
    (void)processes.start(spec);
    wait_for([&] { return !processes.last_lines("agent").empty(); });
    if (!processes.ask_to_end("agent")) return 91;
    std::vector<ChildEvent> events;
    wait_for([&] {
      events = processes.poll(100ms);
      return !events.empty();
    });
    if (events[0].reason != "exit code 0" || events[0].will_restart) return 92;
    return processes.ask_to_end("agent") ? 93 : 0;
  });
  CHECK(code == 0);
}

TEST_CASE("a director that hangs after it has ended its processes is killed") {
  Fixture f;
  f.exit_timeout = 500ms;
  const bool hangs_at_exit = GENERATE(false, true);
  CAPTURE(hangs_at_exit);
  const auto hang = [] {
    for (;;) pause();
  };
  const int code = f.keep([&](Processes& processes, const Deaths&) {
    (void)processes.start(shell("agent", "exec sleep 1000"));
    (void)processes.terminate(5s);
    hangs_at_exit ? (void)std::atexit(hang) : hang();
    return 0;
  });
  CHECK(code == 1);
  CHECK(f.lost == "signal 9 (SIGKILL)");
  CHECK_THAT(f.text("log"), ContainsSubstring("has not ended in time and is killed"));
  CHECK(DirectorWork{}.exit_timeout <= 15s);
}

TEST_CASE("a stopped director that is asked to end is killed and reported, and its processes end") {
  Fixture f;
  f.shutdown_timeout = 500ms;
  const pid_t self = getpid();
  const int code = f.keep([&](Processes& processes, const Deaths&) {
    obey_sigterm();  // the signal may arrive before kill() returns
    write_file(f.file("pid"), std::to_string(processes.start(shell("agent", "exec sleep 1000"))));
    kill(self, SIGINT);
    std::raise(SIGSTOP);
    return 0;
  });
  CHECK(code == 1);
  CHECK(f.lost == "signal 9 (SIGKILL)");
  CHECK(f.group.running() == 0);
  CHECK_FALSE(is_alive(std::stoi(f.text("pid"))));
  CHECK_THAT(f.text("log"), ContainsSubstring("has not ended in time and is killed"));
  CHECK(DirectorWork{}.shutdown_timeout <= 30s);
}

TEST_CASE("a director that dies before it has started anything is not restarted") {
  Fixture f;
  CHECK(f.keep([](Processes&, const Deaths&) -> int { std::abort(); }) == 1);
  CHECK(f.lost == "signal 6 (SIGABRT)");
}

TEST_CASE("when the keeping process is killed, robots come to rest and the director writes its report") {
  Fixture f;
  const pid_t keeper = fork();
  if (keeper == 0) {
    ProcessGroup group(f.file("log"));
    (void)keep_processes(
        group, {[&](Processes& processes, const Deaths&) {
                  obey_sigterm();
                  ChildSpec robots = shell("robots", "trap 'echo rest >" + f.file("rest") +
                                                         "; exit 0' TERM; echo ready; while :; do "
                                                         "sleep 0.01; done");
                  robots.rest_time = 5s;
                  (void)processes.start(robots);
                  const pid_t agent = processes.start(shell("agent", "exec sleep 1000"));
                  wait_for([&] { return !processes.last_lines("robots").empty(); });
                  kill(getppid(), SIGKILL);
                  wait_for([] { return is_asked_to_end != 0; });
                  wait_for([&] { return !is_alive(agent); });
                  const bool is_over = processes.terminate(5s).empty() && processes.poll(0ms).empty();
                  write_file(f.file("report"), is_over ? "written" : "wrong");
                  return 0;
                },
                [](const std::string&) {}});
    std::_Exit(0);
  }
  int status = 0;
  REQUIRE(waitpid(keeper, &status, 0) == keeper);
  CHECK(WIFSIGNALED(status));
  const auto until = std::chrono::steady_clock::now() + 20s;
  while (f.text("report").empty() || f.text("rest").empty()) {
    REQUIRE(std::chrono::steady_clock::now() < until);
    std::this_thread::sleep_for(1ms);
  }
  CHECK(f.text("report") == "written");
  CHECK(f.text("rest") == "rest\n");
}

/// A process that outlasts the run.
ChildSpec page(const std::string& script) {
  ChildSpec spec = shell("page", script);
  spec.outlasts_run = true;
  return spec;
}

TEST_CASE("a process that outlasts the run continues after the director's end until the user interrupts") {
  Fixture f;
  const bool ends_others = GENERATE(true, false);
  CAPTURE(ends_others);
  const auto lives = [&](const std::string& process) { return is_alive(std::stoi(f.text(process))); };
  int calls = 0;
  f.on_outlasting = [&] {
    ++calls;
    CHECK(lives("page"));
    CHECK_FALSE(lives("agent"));
    kill(getpid(), SIGINT);
  };
  const int code = f.keep([&](Processes& processes, const Deaths&) {
    write_file(f.file("page"), std::to_string(processes.start(page("exec sleep 1000"))));
    write_file(f.file("agent"), std::to_string(processes.start(shell("agent", "exec sleep 1000"))));
    if (ends_others) (void)processes.terminate(5s);
    return 3;
  });
  CHECK(code == 3);
  CHECK(calls == 1);
  CHECK_FALSE(lives("page"));
}

TEST_CASE("a process that outlasts the run is not kept if it ends, or if the user has interrupted the run") {
  Fixture f;
  int calls = 0;
  f.on_outlasting = [&] { ++calls; };
  CHECK(f.keep([](Processes& processes, const Deaths&) {
    (void)processes.start(page("sleep 1"));
    return 5;
  }) == 5);
  CHECK(calls == 1);
  const pid_t self = getpid();
  CHECK(f.keep([&](Processes& processes, const Deaths&) {
    obey_sigterm();
    (void)processes.start({"other page", {"/bin/sh", "-c", "exec sleep 1000"}, false, {}, 0, {}, true});
    kill(self, SIGINT);
    wait_for([] { return is_asked_to_end != 0; });
    return 6;
  }) == 6);
  CHECK(calls == 1);
  CHECK_FALSE(f.group.has_outlasting());
}

TEST_CASE("a process that would outlast the run is not kept if the director ends it, even if it hangs") {
  Fixture f;
  int calls = 0;
  f.on_outlasting = [&] { ++calls; };
  const bool hangs = GENERATE(false, true);
  CAPTURE(hangs);
  const std::string trap = hangs ? "trap '' TERM" : "trap 'sleep 0.2; exit 0' TERM";
  const int code = f.keep([&](Processes& processes, const Deaths&) {
    (void)processes.start(page(trap + "; echo ready; while :; do sleep 0.01; done"));
    wait_for([&] { return !processes.last_lines("page").empty(); });
    end_process(processes, "page", hangs ? 200ms : 10s);
    end_process(processes, "page", 10s);  // has no effect
    return processes.send_signal("page", SIGTERM) ? 9 : 5;
  });
  CHECK(code == 5);
  CHECK(calls == 0);
  CHECK_FALSE(f.group.has_outlasting());
}

TEST_CASE("robots come to rest before other processes are asked to end") {
  Fixture f;
  ChildSpec robots = shell("robots", "trap 'sleep 0.3; date +%s%N >" + f.file("rest") +
                                         "; exit 0' TERM; echo ready; while :; do sleep 0.01; done");
  robots.rest_time = 10s;
  (void)f.group.start(shell("vision", "trap 'date +%s%N >" + f.file("end") +
                                          "; exit 0' TERM; echo ready; while :; do sleep 0.01; done"));
  (void)f.group.start(robots);
  while (f.group.last_lines("vision").empty() || f.group.last_lines("robots").empty())
    (void)f.group.poll(100ms);
  CHECK(f.group.terminate(5s).empty());
  CHECK(std::stoll(f.text("rest")) < std::stoll(f.text("end")));
}

}  // namespace sidestep::process_keeper_test
