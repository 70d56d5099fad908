// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/monitor_process.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <netinet/in.h>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>

#include "common/keys/key_folder.hpp"
#include "deploy/run/launch/process_group.hpp"

namespace sidestep {
namespace {

/// Why this process cannot listen on the port; 0 if it can. See errno(3).
int listening_error(std::uint16_t port) {
  const int listener = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (listener < 0) return errno;
  const int yes = 1;  // as the monitor does, so that connections that have just ended do not matter
  setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const bool is_listening =
      bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      ::listen(listener, 1) == 0;
  const int error = is_listening ? 0 : errno;
  close(listener);
  return error;
}

}  // namespace

ChildSpec monitor_child(const RunOptions& options) {
  const DdsSettings& dds = options.dds;
  std::vector<std::string> argv{sibling_program_path("sidestep"),
                                "monitor",
                                options.scenario_file,
                                "--of-run",
                                "--port",
                                *options.monitor_port,
                                "--domain",
                                std::to_string(dds.domain),
                                "--interface",
                                dds.interface};
  if (options.has_control) argv.emplace_back("--control");
  if (!dds.peers.empty()) argv.insert(argv.end(), {"--peers", fmt::format("{}", fmt::join(dds.peers, ","))});
  if (!dds.keys.empty()) {
    const Role role = options.has_control ? Role::kOperator : Role::kViewer;
    argv.insert(argv.end(), {"--keys", key_folder_of(dds.keys, {role})});
  }
  if (dds.insecure) argv.emplace_back("--insecure");
  ChildSpec child{kMonitorProcess, argv, false, options.monitor_token + "\n"};
  child.outlasts_run = !options.closes_page;
  return child;
}

std::string monitor_url(const RunOptions& options) {
  return fmt::format("http://127.0.0.1:{}/{}", *options.monitor_port,
                     options.monitor_token.empty() ? "" : "#token=" + options.monitor_token);
}

void require_free_port(const std::string& port) {
  const int error = listening_error(static_cast<std::uint16_t>(std::stoi(port)));
  if (error == EADDRINUSE)
    throw std::invalid_argument(fmt::format(
        "--monitor: another program, perhaps the page of an earlier run, uses port {}; end it, or choose "
        "another port, e.g. --monitor {}",
        port, port == "65535" ? 8080 : std::stoi(port) + 1));
  if (error != 0)
    throw std::invalid_argument(
        fmt::format("--monitor: cannot listen on port {}: {}", port, std::strerror(error)));
}

}  // namespace sidestep
