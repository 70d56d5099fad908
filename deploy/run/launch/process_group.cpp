// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/process_group.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <deque>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <poll.h>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

#include "common/file/console.hpp"
#include "common/file/folder.hpp"
#include "common/file/output_file.hpp"

// glibc 2.36 declares the functions of this header without C linkage.
extern "C" {
#include <sys/pidfd.h>
}

namespace sidestep {
namespace {

using std::chrono::steady_clock;

constexpr std::size_t kMaxKeptLines = 20;
constexpr std::size_t kMaxLineLength = 4096;
constexpr ProcessGroup::Milliseconds kMinBackoff{100}, kMaxBackoff{2000};

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(fmt::format("{}: {}", what, std::strerror(errno)));
}

/// Executes the program in a forked child. Uses system calls only, because the parent may have threads.
[[noreturn]] void execute(char* const argv[], int input, int output, int niceness, int last_signal,
                          pid_t parent) {
  prctl(PR_SET_PDEATHSIG, last_signal);
  if (getppid() != parent) _exit(126);  // the parent died before the line above
  setpgid(0, 0);                        // Ctrl-C reaches only the parent, which stops its children in order
  setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + niceness);
  for (int signal = 1; signal < NSIG; ++signal) ::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  dup2(input >= 0 ? input : open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  close_range(3, ~0U, 0);  // inherited descriptors, above all the parent's sockets
  execv(argv[0], argv);
  const char* const reason = strerrordesc_np(errno);
  for (const char* part :
       {"cannot execute ", static_cast<const char*>(argv[0]), ": ", reason ? reason : "?", "\n"}) {
    if (write(STDERR_FILENO, part, std::strlen(part)) < 0) break;
  }
  _exit(127);
}

void close_fd(int& fd) {
  if (fd >= 0) close(fd);
  fd = -1;
}

struct Pipe {
  int read_end = -1;
  int write_end = -1;
};

Pipe new_pipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail("cannot create a pipe");
  return {ends[0], ends[1]};
}

/// Sockets are used because writing to a pipe whose reader has ended would end this process by a signal.
Pipe new_input() {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail("cannot create a socket");
  return {ends[0], ends[1]};
}

void add(const rusage& used, ProcessUse& to) {
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  constexpr double kMegabytePerKibibyte = 1024e-6;
  to.cpu_s += seconds(used.ru_utime) + seconds(used.ru_stime);
  to.max_memory_mb = std::max(to.max_memory_mb, static_cast<double>(used.ru_maxrss) * kMegabytePerKibibyte);
}

}  // namespace

struct ProcessGroup::Child {
  ChildSpec spec;
  pid_t pid = -1;
  int pidfd = -1;
  int input = -1;
  int output = -1;
  bool is_running = false;
  bool must_restart = false;     // restart the process once, as soon as it has ended
  bool is_asked_to_end = false;  // do not restart the process when it has ended
  SteadyTime started{};
  SteadyTime restart_at = SteadyTime::max();
  Milliseconds backoff = kMinBackoff;
  std::string unsent;  // input that was not yet sent to its stdin
  std::string partial;
  std::deque<std::string> lines;
};

bool ProcessGroup::drives_robots(const Child& child) { return child.spec.rest_time > Milliseconds::zero(); }

std::string reason_of(int status) {
  if (WIFEXITED(status)) return fmt::format("exit code {}", WEXITSTATUS(status));
  const char* const name = sigabbrev_np(WTERMSIG(status));
  return fmt::format("signal {} (SIG{})", WTERMSIG(status), name ? name : "?");
}

std::string sibling_program_path(const std::string& name) {
  return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / name).string();
}

ProcessGroup::ProcessGroup(const std::string& log_path) : log_path_(log_path) {
  create_folder_of(log_path);
  log_ = open_output(log_path).release();
}

ProcessGroup::~ProcessGroup() {
  try {
    terminate_all(Milliseconds{0});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cannot end all processes: %s\n", error.what());
  }
  std::fclose(log_);
}

void ProcessGroup::log(const std::string& line) {
  const int error = write_text(log_, line + "\n");
  if (error == 0 || std::exchange(has_lost_lines_, true)) return;
  print_to(stderr, "cannot write {}: {}; lines are missing from here on\n", log_path_, std::strerror(error));
}

pid_t ProcessGroup::start(const ChildSpec& spec) {
  if (spec.argv.empty() || access(spec.argv[0].c_str(), X_OK) != 0) {
    fail(fmt::format("cannot start {} ({})", spec.name, spec.argv.empty() ? "no program" : spec.argv[0]));
  }
  auto child = std::make_unique<Child>();
  child->spec = spec;
  spawn(*child);
  children_.push_back(std::move(child));
  return children_.back()->pid;
}

ProcessGroup::Child* ProcessGroup::find(const std::string& name) {
  const auto found = std::find_if(children_.rbegin(), children_.rend(),
                                  [&](const auto& child) { return child->spec.name == name; });
  return found == children_.rend() ? nullptr : found->get();
}

bool ProcessGroup::send_signal(const std::string& name, int signal) {
  const Child* const child = find(name);
  return child && child->is_running && kill(child->pid, signal) == 0;
}

void ProcessGroup::add_input(const std::string& name, const std::string& more) {
  Child* const child = find(name);
  if (!child || child->spec.input.empty()) return;
  child->spec.input += more;
  child->unsent += more;
  send_input(*child);
}

void ProcessGroup::restart(const ChildSpec& spec) {
  Child* const child = find(spec.name);
  if (!child) throw std::runtime_error("there is no process " + spec.name + " to start again");
  child->spec = spec;
  child->is_asked_to_end = false;
  if (child->is_running) {
    child->must_restart = true;
    kill(child->pid, SIGKILL);
  } else {
    child->restart_at = steady_clock::now();
  }
}

void ProcessGroup::spawn(Child& child) {
  Pipe input = child.spec.input.empty() ? Pipe{} : new_input(), output = new_pipe();
  fcntl(output.read_end, F_SETFL, O_NONBLOCK);
  std::vector<char*> argv;
  for (auto& argument : child.spec.argv) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const pid_t parent = getpid();
  // Blocks signals to the child until it has reset this program's signal handlers.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t pid = fork();
  if (pid == 0)
    execute(argv.data(), input.read_end, output.write_end, child.spec.niceness,
            drives_robots(child) ? SIGTERM : SIGKILL, parent);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  close_fd(output.write_end);
  close_fd(input.read_end);
  close_fd(child.input);
  child.input = input.write_end;
  child.unsent = child.spec.input;
  if (pid < 0) {
    close_fd(output.read_end);
    fail("cannot start " + child.spec.name);
  }
  child.pid = pid;
  child.pidfd = pidfd_open(pid, 0);
  child.output = output.read_end;
  child.is_running = true;
  child.started = steady_clock::now();
  child.restart_at = SteadyTime::max();
  if (child.pidfd < 0) fail("cannot watch " + child.spec.name);
  send_input(child);
}

void ProcessGroup::send_input(Child& child) {
  while (child.input >= 0 && !child.unsent.empty()) {
    const ssize_t sent =
        send(child.input, child.unsent.data(), child.unsent.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0 && errno == EAGAIN) return;
    // A child that no longer reads is about to end.
    child.unsent.erase(0, sent < 0 ? child.unsent.size() : static_cast<std::size_t>(sent));
  }
}

bool ProcessGroup::wait_for_activity(Milliseconds timeout, std::span<const int> descriptors) {
  std::vector<pollfd> watched;
  for (const int descriptor : descriptors) watched.push_back({descriptor, POLLIN, 0});
  SteadyTime until = steady_clock::now() + timeout;
  for (const auto& child : children_) {
    if (child->pidfd >= 0) watched.push_back({child->pidfd, POLLIN, 0});
    if (child->output >= 0) watched.push_back({child->output, POLLIN, 0});
    if (child->input >= 0 && !child->unsent.empty()) watched.push_back({child->input, POLLOUT, 0});
    until = std::min(until, child->restart_at);
  }
  const auto left = std::chrono::ceil<Milliseconds>(until - steady_clock::now());
  ::poll(watched.data(), watched.size(), static_cast<int>(std::max<Milliseconds::rep>(left.count(), 0)));
  return std::any_of(watched.begin(), watched.begin() + static_cast<std::ptrdiff_t>(descriptors.size()),
                     [](const pollfd& entry) { return entry.revents != 0; });
}

void ProcessGroup::drain(Child& child) {
  char buffer[4096];
  const auto finish_line = [&] {
    log(child.spec.name + ": " + child.partial);
    child.lines.push_back(std::move(child.partial));
    if (child.lines.size() > kMaxKeptLines) child.lines.pop_front();
    child.partial.clear();
  };
  while (child.output >= 0) {
    const ssize_t count = read(child.output, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) return;
    if (count <= 0) {
      if (!child.partial.empty()) finish_line();
      close_fd(child.output);
      return;
    }
    for (ssize_t i = 0; i < count; ++i) {
      if (buffer[i] != '\n') child.partial += buffer[i];
      if (buffer[i] == '\n' || child.partial.size() >= kMaxLineLength) finish_line();
    }
  }
}

bool ProcessGroup::reap(Child& child, ChildEvent& event) {
  int status = 0;
  rusage used{};
  if (!child.is_running || wait4(child.pid, &status, WNOHANG, &used) != child.pid) return false;
  add(used, resource_use_[child.spec.name]);
  close_fd(child.input);
  drain(child);
  release(child);
  event = {ChildEvent::Kind::kDied, child.spec.name, child.pid, reason_of(status), false};
  const auto now = steady_clock::now();
  if (child.must_restart && !is_terminating_) {
    child.must_restart = false;
    child.restart_at = now;
    event.will_restart = true;
  } else if (child.spec.restart && !child.is_asked_to_end && !is_terminating_) {
    const bool ran_long = now - child.started > kMaxBackoff;
    child.backoff = ran_long ? kMinBackoff : std::min(2 * child.backoff, kMaxBackoff);
    child.restart_at = now + child.backoff;
    event.will_restart = true;
  }
  return true;
}

void ProcessGroup::release(Child& child) {
  child.is_running = false;
  close_fd(child.pidfd);
  close_fd(child.input);
  close_fd(child.output);  // a grandchild may still hold the other end
}

void ProcessGroup::start_due(std::vector<ChildEvent>& events) {
  for (const auto& child : children_) {
    if (child->restart_at > steady_clock::now()) continue;
    spawn(*child);
    events.push_back({ChildEvent::Kind::kStarted, child->spec.name, child->pid, "", false});
  }
}

std::vector<ChildEvent> ProcessGroup::poll(Milliseconds timeout, std::span<const int> descriptors) {
  const SteadyTime until = steady_clock::now() + timeout;
  std::vector<ChildEvent> events;
  while (true) {
    const auto left = std::chrono::ceil<Milliseconds>(until - steady_clock::now());
    const bool is_called = wait_for_activity(std::max(left, Milliseconds{0}), descriptors);
    for (const auto& child : children_) {
      ChildEvent event;
      drain(*child);
      send_input(*child);
      if (reap(*child, event)) events.push_back(event);
    }
    if (!is_terminating_) start_due(events);
    if (is_called || !events.empty() || steady_clock::now() >= until) return events;
  }
}

bool ProcessGroup::ask_to_end(const std::string& name) {
  Child* const child = find(name);
  if (!child) return false;
  const bool is_running = child->is_running;
  ask(*child);
  return is_running;
}

void ProcessGroup::abandon() {
  for (const auto& child : children_) {
    if (child->spec.outlasts_run) continue;
    ask(*child);
    if (!child->is_running) continue;
    if (drives_robots(*child))
      release(*child);
    else
      kill(child->pid, SIGKILL);
  }
}

void ProcessGroup::ask(Child& child) {
  child.restart_at = SteadyTime::max();
  child.must_restart = false;
  child.is_asked_to_end = true;
  if (!child.is_running) return;
  if (child.input >= 0)
    close_fd(child.input);
  else
    kill(child.pid, SIGTERM);
}

void ProcessGroup::end_all(Milliseconds timeout, const Selection& should_end) {
  Milliseconds rest_time{0};
  for (const auto& child : children_) {
    if (!should_end(*child)) continue;
    ask(*child);
    rest_time = std::max(rest_time, child->spec.rest_time);
  }
  const SteadyTime until = steady_clock::now() + timeout + rest_time;
  while (has_running(should_end) && steady_clock::now() < until)
    poll(std::chrono::ceil<Milliseconds>(until - steady_clock::now()));
}

std::vector<std::string> ProcessGroup::terminate(Milliseconds timeout) {
  return terminate(timeout, [](const Child& child) { return !child.spec.outlasts_run; });
}

std::vector<std::string> ProcessGroup::terminate_all(Milliseconds timeout) {
  return terminate(timeout, [](const Child&) { return true; });
}

std::vector<std::string> ProcessGroup::terminate(Milliseconds timeout, const Selection& should_end) {
  is_terminating_ = true;
  end_all(timeout, [&](const Child& child) { return should_end(child) && drives_robots(child); });
  end_all(timeout, should_end);
  std::vector<std::string> killed;
  for (const auto& child : children_) {
    if (!child->is_running || !should_end(*child)) continue;
    killed.push_back(child->spec.name);
    kill(child->pid, SIGKILL);
  }
  while (has_running(should_end)) poll(Milliseconds{1000});
  is_terminating_ = false;
  return killed;
}

std::size_t ProcessGroup::running() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      children_, [](const auto& child) { return child->is_running && !child->spec.outlasts_run; }));
}

bool ProcessGroup::has_running(const Selection& selection) const {
  return std::ranges::any_of(children_,
                             [&](const auto& child) { return child->is_running && selection(*child); });
}

bool ProcessGroup::has_outlasting() const {
  return has_running([](const Child& child) { return child.spec.outlasts_run; });
}

std::vector<std::string> ProcessGroup::last_lines(const std::string& name) const {
  for (const auto& child : children_) {
    if (child->spec.name == name) return {child->lines.begin(), child->lines.end()};
  }
  return {};
}

}  // namespace sidestep
