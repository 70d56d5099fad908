// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/process_command.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <iterator>

#include "common/file/permission.hpp"
#include "common/keys/key_folder.hpp"
#include "common/yaml/yaml_document.hpp"
#include "deploy/run/launch/hosts/command.hpp"
#include "deploy/run/launch/process_group.hpp"

namespace sidestep {
namespace {

using Arguments = std::vector<std::string>;

/// The shell script on the remote host. Its stdin carries files (see file_input()), first those that the
/// program needs, later replacements. Stdin ends when the connection ends for any reason. Descriptor 3
/// preserves stdin, because a shell replaces it for background processes. HUP and PIPE are ignored so that
/// the script can clean up after the connection is lost.
constexpr const char* kRemoteScript = R"(trap '' HUP PIPE
exec 3<&0
umask 077
scenario=$1 program=$2 niceness=$3 grace_s=$4 files=$5
shift 5
case $program in */*) program=$(realpath -- "$program") ;; esac
folder=$(mktemp -d) && cd "$folder" || exit 1
receive() { read -r size name <&3 && head -c "$size" <&3 >./part && mv ./part "./$name"; }
while [ "$files" -gt 0 ]; do
  receive || exit 1
  files=$((files - 1))
done
nice -n "$niceness" "$program" --scenario "$folder/$scenario" "$@" </dev/null 3<&- &
child=$!
{ while receive; do :; done; kill "$child"; sleep "$grace_s"; kill -9 "$child"; } >/dev/null 2>&1 &
watchdog=$!
wait "$child"
status=$?
kill "$watchdog"
rm -r "$folder"
exit "$status")";

/// Time from when a remote process is asked to end until it is killed, in addition to its robots' time to
/// rest.
constexpr double kGrace_s = 3;

std::string shell_quoted(const std::string& word) {
  std::string result(1, '\'');
  for (const char c : word) {
    if (c == '\'') result.append("'\\'");
    result.push_back(c);
  }
  result.push_back('\'');
  return result;
}

void append(Arguments& arguments, const Arguments& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
}

struct SentFile {
  std::string name, content;
};

/// The files that a process on another host needs.
std::vector<SentFile> sent_files(const ProcessSpec& process) {
  std::vector<SentFile> files{{std::filesystem::path(process.scenario_file).filename().string(),
                               read_yaml_file(process.scenario_file, "a scenario")}};
  if (process.keys.empty()) return files;
  for (const char* name : key_files::kAll) files.push_back({name, read_key_file(process.keys, name)});
  return files;
}

Arguments ssh_arguments(const HostSpec& host, const std::string& program, int niceness, double grace_s,
                        const std::vector<SentFile>& files, const Arguments& options) {
  Arguments remote{"sh",
                   "-c",
                   kRemoteScript,
                   "sidestep",
                   files.front().name,
                   program,
                   std::to_string(niceness),
                   fmt::format("{:.1f}", grace_s),
                   std::to_string(files.size())};
  append(remote, options);
  for (std::string& word : remote) word = shell_quoted(word);
  // A hanging connection ends within seconds on this side, and on the remote host too if its server is
  // configured to do so.
  return {find_program("ssh"),
          "-oBatchMode=yes",
          "-oServerAliveInterval=1",
          "-oServerAliveCountMax=3",
          "-oConnectTimeout=5",
          host.target,
          fmt::format("{}", fmt::join(remote, " "))};
}

/// The nice value of agents that share a machine with processes that all robots need. On an overloaded
/// machine, each process would otherwise get the same share of processor time. The simulator, vision and the
/// coordinator need more than an agent does, so all robots would wait for them.
constexpr int kAgentNiceness = 15;

int niceness(const ProcessSpec& process, const HostSpec& host) {
  if (process.program != "sidestep-agent") return 0;
  // The processes of namespaces share the launcher's machine.
  const bool is_shared = host.transport != HostTransport::kSsh || host.simulator || host.robots ||
                         host.vision || host.coordinator || host.standbys.rest ||
                         !host.standbys.ranges.empty();
  return is_shared ? kAgentNiceness : 0;
}

}  // namespace

std::string file_input(const std::string& name, const std::string& content) {
  return fmt::format("{} {}\n{}", content.size(), name, content);
}

std::string read_key_file(const std::string& folder, const char* name) {
  require_read_permission(folder + "/" + name);
  std::ifstream file(folder + "/" + name);
  if (!file) throw std::runtime_error(fmt::format("cannot read {}/{}", folder, name));
  return {std::istreambuf_iterator<char>(file), {}};
}

ChildSpec child_spec(const ProcessSpec& process, const HostSpec& host, const std::string& namespace_name) {
  const std::string program =
      host.programs.empty() ? sibling_program_path(process.program) : host.programs + "/" + process.program;
  Arguments options{"--domain", std::to_string(process.domain), "--interface", host.interface};
  if (!process.peers.empty()) append(options, {"--peers", fmt::format("{}", fmt::join(process.peers, ","))});
  const bool is_remote = host.transport == HostTransport::kSsh;
  if (!process.keys.empty()) append(options, {"--keys", is_remote ? "." : process.keys});
  if (process.insecure) append(options, {"--insecure"});
  append(options, process.arguments);
  ChildSpec child{process.name, {}, process.restart};
  // An agent's robot comes to rest by itself, so other processes do not wait for the agent.
  if (process.program != "sidestep-agent")
    child.rest_time = std::chrono::ceil<std::chrono::milliseconds>(process.rest_time);
  if (is_remote) {
    const std::vector<SentFile> files = sent_files(process);
    for (const SentFile& file : files) child.input += file_input(file.name, file.content);
    child.argv = ssh_arguments(host, program, niceness(process, host),
                               kGrace_s + to_seconds(process.rest_time), files, options);
    return child;
  }
  child.niceness = niceness(process, host);
  if (host.transport == HostTransport::kNamespace)
    child.argv = {find_program("ip"), "netns", "exec", namespace_name};
  append(child.argv, {program, "--scenario", process.scenario_file});
  append(child.argv, options);
  return child;
}

}  // namespace sidestep
