// SPDX-License-Identifier: Apache-2.0
#include "deploy/launch/hosts/process_command.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/config/yaml_document.hpp"
#include "deploy/launch/hosts/command.hpp"

namespace sidestep {
namespace {

using Words = std::vector<std::string>;

/// What ssh has a shell run there: its stdin brings the scenario, and whatever ends the connection ends
/// stdin. The shell gives a process in the background another stdin unless told; hence descriptor 3.
/// What it says once the connection has gone reaches nobody, and must not end it before it has tidied up.
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

std::string shell_word(const std::string& word) {
  std::string result(1, '\'');
  for (const char c : word) {
    if (c == '\'') result.append("'\\'");
    result.push_back(c);
  }
  result.push_back('\'');
  return result;
}

void append(Words& words, const Words& more) { words.insert(words.end(), more.begin(), more.end()); }

Words ssh_words(const ProcessCall& call, const HostSpec& host, const std::string& program,
                std::size_t scenario_size, const Words& options) {
  Words remote{"sh",
               "-c",
               kRemoteScript,
               "sidestep",
               std::to_string(scenario_size),
               std::filesystem::path(call.scenario_file).filename().string(),
               program};
  append(remote, options);
  for (std::string& word : remote) word = shell_word(word);
  // A connection that hangs ends within seconds, at both ends where the server is set up like this too.
  return {find_program("ssh"),
          "-oBatchMode=yes",
          "-oServerAliveInterval=1",
          "-oServerAliveCountMax=3",
          "-oConnectTimeout=5",
          host.target,
          fmt::format("{}", fmt::join(remote, " "))};
}

}  // namespace

ChildSpec child_on_host(const ProcessCall& call, const HostSpec& host, const std::string& namespace_name) {
  const std::string program =
      host.programs.empty() ? program_beside_own(call.program) : host.programs + "/" + call.program;
  Words options{"--domain", std::to_string(call.domain), "--interface", host.interface};
  append(options, call.more);
  ChildSpec child{call.name, {}, call.restart};
  if (host.transport == HostTransport::kSsh) {
    child.input = read_yaml_file(call.scenario_file, "a scenario");
    child.argv = ssh_words(call, host, program, child.input.size(), options);
    return child;
  }
  if (host.transport == HostTransport::kNamespace)
    child.argv = {find_program("ip"), "netns", "exec", namespace_name};
  append(child.argv, {program, "--scenario", call.scenario_file});
  append(child.argv, options);
  return child;
}

}  // namespace sidestep
