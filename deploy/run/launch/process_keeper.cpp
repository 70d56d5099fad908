// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/process_keeper.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <poll.h>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/file/console.hpp"
#include "common/process/exit_code.hpp"
#include "deploy/run/launch/stop_requests.hpp"

// glibc 2.36 declares the functions of this header without C linkage.
extern "C" {
#include <sys/pidfd.h>
}

namespace sidestep {
namespace {

using Json = nlohmann::json;
using namespace std::chrono_literals;
using std::chrono::steady_clock;

constexpr int kDirectorSocket = 3;  // descriptor of the socket in the director
constexpr auto kTerminationTimeout = 3000ms;
constexpr auto kPause = 500ms, kMaxPause = 60'000ms;  // pause before the next director; doubles each time
constexpr std::uint32_t kMaxMessage = 64'000'000;

[[noreturn]] void fail(const char* what) {
  throw std::runtime_error(fmt::format("{}: {}", what, std::strerror(errno)));
}

bool send_all(int socket, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = send(socket, bytes, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool receive_all(int socket, void* data, std::size_t size) {
  auto* bytes = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t received = recv(socket, bytes, size, 0);
    if (received < 0 && errno == EINTR) continue;
    if (received <= 0) return false;
    bytes += received;
    size -= static_cast<std::size_t>(received);
  }
  return true;
}

/// Sends a message preceded by its size. Returns false if the other side has ended.
bool send_message(int socket, const Json& message) {
  const std::vector<std::uint8_t> bytes = Json::to_cbor(message);
  const auto size = static_cast<std::uint32_t>(bytes.size());
  return send_all(socket, &size, sizeof size) && send_all(socket, bytes.data(), bytes.size());
}

/// Receives a message; nullopt if the other side has ended.
std::optional<Json> receive_message(int socket) {
  std::uint32_t size = 0;
  if (!receive_all(socket, &size, sizeof size) || size > kMaxMessage) return std::nullopt;
  std::vector<std::uint8_t> bytes(size);
  if (!receive_all(socket, bytes.data(), size)) return std::nullopt;
  Json message = Json::from_cbor(bytes, true, false);
  return message.is_object() ? std::optional(std::move(message)) : std::nullopt;
}

Json to_json(const ChildSpec& spec) {
  return {{"name", spec.name},
          {"argv", spec.argv},
          {"restart", spec.restart},
          {"input", spec.input},
          {"niceness", spec.niceness},
          {"rest_time_ms", spec.rest_time.count()},
          {"outlasts_run", spec.outlasts_run}};
}

ChildSpec child_spec(const Json& json) {
  ChildSpec spec{json.at("name"), json.at("argv"), json.at("restart"), json.at("input"), json.at("niceness")};
  spec.rest_time = std::chrono::milliseconds(json.at("rest_time_ms").get<std::int64_t>());
  spec.outlasts_run = json.at("outlasts_run");
  return spec;
}

Json to_json(const ChildEvent& event) {
  return {{"started", event.kind == ChildEvent::Kind::kStarted},
          {"name", event.name},
          {"pid", event.pid},
          {"reason", event.reason},
          {"will_restart", event.will_restart}};
}

ChildEvent child_event(const Json& json) {
  const auto kind = json.at("started").get<bool>() ? ChildEvent::Kind::kStarted : ChildEvent::Kind::kDied;
  return {kind, json.at("name"), json.at("pid"), json.at("reason"), json.at("will_restart")};
}

/// The processes as the director sees them. When the process that keeps them has ended, all of them have
/// ended.
class KeptProcesses : public Processes {
 public:
  explicit KeptProcesses(int socket) : socket_(socket) {}

  pid_t start(const ChildSpec& spec) override { return ask({{"do", "start"}, {"spec", to_json(spec)}}, -1); }
  bool send_signal(const std::string& name, int signal) override {
    return ask({{"do", "signal"}, {"name", name}, {"signal", signal}}, false);
  }
  void add_input(const std::string& name, const std::string& more) override {
    ask({{"do", "input"}, {"name", name}, {"more", more}}, true);
  }
  void restart(const ChildSpec& spec) override { ask({{"do", "restart"}, {"spec", to_json(spec)}}, true); }
  std::vector<ChildEvent> poll(Milliseconds timeout) override {
    const Json answer = ask<Json>({{"do", "poll"}, {"timeout_ms", timeout.count()}}, Json::array());
    std::vector<ChildEvent> events;
    for (const Json& event : answer) events.push_back(child_event(event));
    return events;
  }
  bool ask_to_end(const std::string& name) override {
    return ask({{"do", "ask_to_end"}, {"name", name}}, false);
  }
  void abandon() override { ask({{"do", "abandon"}}, true); }
  std::vector<std::string> terminate(Milliseconds timeout) override {
    return ask<std::vector<std::string>>({{"do", "terminate"}, {"timeout_ms", timeout.count()}}, {});
  }
  std::map<std::string, ProcessUse> resource_use() const override {
    const Json answer = ask<Json>({{"do", "resource_use"}}, Json::object());
    std::map<std::string, ProcessUse> result;
    for (const auto& [name, use] : answer.items()) result[name] = {use.at(0), use.at(1)};
    return result;
  }
  std::vector<std::string> last_lines(const std::string& name) const override {
    return ask<std::vector<std::string>>({{"do", "last_lines"}, {"name", name}}, {});
  }
  void log(const std::string& line) override { ask({{"do", "log"}, {"line", line}}, true); }

 private:
  /// `if_ended`: the answer if the keeping process has ended.
  template <typename Answer>
  Answer ask(const Json& request, Answer if_ended) const {
    if (!send_message(socket_, request)) return if_ended;
    const auto answer = receive_message(socket_);
    if (!answer) return if_ended;
    if (answer->contains("error")) throw std::runtime_error(answer->at("error").get<std::string>());
    return answer->at("answer").get<Answer>();
  }

  int socket_;
};

/// Serves the requests of directors.
class Keeper {
 public:
  explicit Keeper(ProcessGroup& group) : group_(group) {}

  /// Begins to serve a new director, which is informed again of processes that have died permanently.
  void begin() {
    events_ = ended_;
    is_ending_ = false;
  }
  /// Whether the director has asked to end the processes. From then on, a signal could end the director
  /// before its report is written.
  bool is_ending() const { return is_ending_; }
  bool has_ended_all() const { return is_ending_ && group_.running() == 0; }

  void poll(std::span<const int> descriptors) { add(group_.poll(200ms, descriptors)); }
  void poll_for(ProcessGroup::Milliseconds duration) {
    for (const auto end = steady_clock::now() + duration; steady_clock::now() < end;)
      add(group_.poll(std::chrono::ceil<ProcessGroup::Milliseconds>(end - steady_clock::now())));
  }

  /// Serves one request. Returns false if the director has ended.
  bool serve(int socket) {
    const auto request = receive_message(socket);
    if (!request) return false;
    Json reply;
    try {
      reply["answer"] = answer(*request);
    } catch (const std::exception& error) {
      reply["error"] = error.what();
    }
    return send_message(socket, reply);
  }

 private:
  void add(const std::vector<ChildEvent>& events) {
    for (const ChildEvent& event : events) {
      std::erase_if(ended_, [&](const ChildEvent& other) { return other.name == event.name; });
      if (event.kind == ChildEvent::Kind::kDied && !event.will_restart) ended_.push_back(event);
      if (event.kind == ChildEvent::Kind::kStarted) pids_[event.name] = event.pid;
      events_.push_back(event);
    }
  }

  Json answer(const Json& request) {
    const std::string& what = request.at("do").get_ref<const std::string&>();
    if (what == "poll") {
      if (events_.empty()) add(group_.poll(ProcessGroup::Milliseconds(request.at("timeout_ms").get<int>())));
      Json result = Json::array();
      for (const ChildEvent& event : std::exchange(events_, {})) result.push_back(to_json(event));
      return result;
    }
    if (what == "start") {
      const ChildSpec spec = child_spec(request.at("spec"));
      const auto known = pids_.find(spec.name);
      return known != pids_.end() ? known->second : pids_[spec.name] = group_.start(spec);
    }
    if (what == "restart") {
      group_.restart(child_spec(request.at("spec")));
    } else if (what == "signal") {
      return group_.send_signal(request.at("name"), request.at("signal"));
    } else if (what == "input") {
      group_.add_input(request.at("name"), request.at("more"));
    } else if (what == "ask_to_end") {
      return group_.ask_to_end(request.at("name"));
    } else if (what == "abandon") {
      is_ending_ = true;
      group_.abandon();
    } else if (what == "terminate") {
      is_ending_ = true;
      return group_.terminate(ProcessGroup::Milliseconds(request.at("timeout_ms").get<int>()));
    } else if (what == "last_lines") {
      return group_.last_lines(request.at("name"));
    } else if (what == "log") {
      group_.log(request.at("line"));
    } else if (what == "resource_use") {
      Json result = Json::object();
      for (const auto& [name, use] : group_.resource_use()) result[name] = {use.cpu_s, use.max_memory_mb};
      return result;
    } else {
      throw std::invalid_argument("unknown request " + what);
    }
    return true;
  }

  ProcessGroup& group_;
  bool is_ending_ = false;
  std::map<std::string, pid_t> pids_;
  std::vector<ChildEvent> events_;  // events not yet reported to the director
  std::vector<ChildEvent> ended_;   // the last event of each process that has died permanently
};

struct Director {
  pid_t pid = -1;
  int pidfd = -1, socket = -1;
};

[[noreturn]] void direct(int socket, pid_t parent, const DirectorWork& work,
                         const std::vector<std::string>& deaths) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  setpgid(0, 0);  // Ctrl-C comes from the parent only
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  if (getppid() != parent) std::_Exit(kExitFailure);  // the parent died before the lines above
  dup2(socket, kDirectorSocket);
  close_range(kDirectorSocket + 1, ~0U, 0);  // above all, the other ends of the processes' stdin
  int code = kExitFailure;
  {
    KeptProcesses processes(kDirectorSocket);
    code = work.run(processes, deaths);
  }
  // Does not run the destructors of the parent's objects, which would end its processes.
  std::exit(code);
}

Director start_director(const DirectorWork& work, const std::vector<std::string>& deaths) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) fail("cannot create a socket");
  const pid_t parent = getpid(), pid = fork();
  if (pid == 0) direct(ends[1], parent, work, deaths);
  close(ends[1]);
  const int pidfd = pid < 0 ? -1 : pidfd_open(pid, 0);
  if (pidfd < 0) fail("cannot start the process that directs the run");
  return {pid, pidfd, ends[0]};
}

/// Waits for a director to end. Returns its exit code, or nullopt and the reason why it died.
std::optional<int> end_of(const Director& director, std::string& reason) {
  int status = 0;
  while (waitpid(director.pid, &status, 0) < 0 && errno == EINTR) {
  }
  close(director.pidfd);
  close(director.socket);
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  reason = reason_of(status);
  return std::nullopt;
}

/// Ends the other processes. Then waits while those that outlast the run are running, until `stop` is
/// readable.
void keep_outlasting(ProcessGroup& group, const std::function<void()>& on_outlasting, int stop) {
  (void)group.terminate(kTerminationTimeout);
  if (!group.has_outlasting() || is_readable(stop)) return;
  if (on_outlasting) on_outlasting();
  while (group.has_outlasting() && !is_readable(stop)) (void)group.poll(200ms, std::array{stop});
}

}  // namespace

int keep_processes(ProcessGroup& group, const DirectorWork& work) {
  const StopRequests requests;
  PassedSignal stop(SIGTERM, requests.stop()), give_up(SIGINT, requests.give_up());
  Keeper keeper(group);
  std::vector<std::string> deaths;
  std::optional<int> code;
  auto pause = kPause;
  while (!code) {
    const Director director = start_director(work, deaths);
    keeper.begin();
    bool is_connected = true;
    std::optional<steady_clock::time_point> idle_since;
    while (!is_readable(director.pidfd)) {
      std::vector<int> watched{director.pidfd};
      if (is_connected) watched.push_back(director.socket);
      for (const PassedSignal* signal : {&stop, &give_up}) {
        if (!signal->first_at()) watched.push_back(signal->request());
      }
      keeper.poll(watched);
      if (is_connected && is_readable(director.socket)) is_connected = keeper.serve(director.socket);
      const auto now = steady_clock::now();
      if (!keeper.is_ending()) {
        stop.update(director.pid, now);
        give_up.update(director.pid, now);
      }
      if ((keeper.has_ended_all() || !is_connected) && !idle_since) idle_since = now;
      const bool is_stuck = (stop.first_at() && now - *stop.first_at() > work.shutdown_timeout) ||
                            (idle_since && now - *idle_since > work.exit_timeout);
      if (is_stuck) {
        group.log("the director of the run has not ended in time and is killed");
        kill(director.pid, SIGKILL);
        break;
      }
    }
    std::string reason;
    code = end_of(director, reason);
    if (code) {
      keep_outlasting(group, work.on_outlasting, requests.stop());
      break;
    }
    group.log("the director of the run died: " + reason);
    print_to(stderr, "the process that directs the run died: {}\n", reason);
    deaths.push_back(reason);
    if (!stop.first_at() && !keeper.is_ending() && group.running() > 0) {
      keeper.poll_for(pause);
      pause = std::min(2 * pause, kMaxPause);
      continue;
    }
    (void)group.terminate(kTerminationTimeout);
    work.on_director_lost(reason);
    code = kExitFailure;
  }
  (void)group.terminate_all(kTerminationTimeout);
  return *code;
}

}  // namespace sidestep
