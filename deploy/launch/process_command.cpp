// SPDX-License-Identifier: Apache-2.0
#include "deploy/launch/process_command.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/config/yaml_document.hpp"
#include "deploy/launch/hosts/command.hpp"

namespace sidestep {
namespace {

using Arguments = std::vector<std::string>;

/// The shell script on the remote host. Its stdin carries the scenario and reaches its end when the
/// connection ends for any reason. Descriptor 3 preserves stdin, because a shell replaces it for background
/// processes. HUP and PIPE are ignored so that the script can clean up after the connection is lost.
constexpr const char* kRemoteScript = R"(trap '' HUP PIPE
exec 3<&0
umask 077
size=$1 name=$2 program=$3
shift 3
folder=$(mktemp -d) && head -c "$size" <&3 >"$folder/$name" || exit 1
"$program" --scenario "$folder/$name" "$@" </dev/null 3<&- &
child=$!
{ cat <&3; kill "$child"; sleep 3; kill -9 "$child"; } >/dev/null 2>&1 &
watchdog=$!
wait "$child"
status=$?
kill "$watchdog"
rm -r "$folder"
exit "$status")";

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

Arguments ssh_arguments(const ProcessSpec& process, const HostSpec& host, const std::string& program,
                        std::size_t scenario_size, const Arguments& options) {
  Arguments remote{"sh",
                   "-c",
                   kRemoteScript,
                   "sidestep",
                   std::to_string(scenario_size),
                   std::filesystem::path(process.scenario_file).filename().string(),
                   program};
  append(remote, options);
  for (std::string& word : remote) word = shell_quoted(word);
  // A hanging connection ends within seconds here, and on the remote host if its server is configured
  // likewise.
  return {find_program("ssh"),
          "-oBatchMode=yes",
          "-oServerAliveInterval=1",
          "-oServerAliveCountMax=3",
          "-oConnectTimeout=5",
          host.target,
          fmt::format("{}", fmt::join(remote, " "))};
}

}  // namespace

ChildSpec child_spec(const ProcessSpec& process, const HostSpec& host, const std::string& namespace_name) {
  const std::string program =
      host.programs.empty() ? sibling_program_path(process.program) : host.programs + "/" + process.program;
  Arguments options{"--domain", std::to_string(process.domain), "--interface", host.interface};
  if (!process.peers.empty()) append(options, {"--peers", fmt::format("{}", fmt::join(process.peers, ","))});
  append(options, process.arguments);
  ChildSpec child{process.name, {}, process.restart};
  if (host.transport == HostTransport::kSsh) {
    child.input = read_yaml_file(process.scenario_file, "a scenario");
    child.argv = ssh_arguments(process, host, program, child.input.size(), options);
    return child;
  }
  if (host.transport == HostTransport::kNamespace)
    child.argv = {find_program("ip"), "netns", "exec", namespace_name};
  append(child.argv, {program, "--scenario", process.scenario_file});
  append(child.argv, options);
  return child;
}

}  // namespace sidestep
