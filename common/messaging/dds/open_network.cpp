// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/open_network.hpp"

#include <filesystem>
#include <fmt/core.h>
#include <mutex>
#include <stdexcept>
#include <sys/stat.h>

#include "common/log/log.hpp"

namespace sidestep {
namespace {

/// Whether this process is in one of the network namespaces that `sidestep run` creates.
bool is_in_own_namespace() {
  struct stat own {};
  if (stat("/proc/thread-self/ns/net", &own) != 0) return false;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/run/netns", none)) {
    struct stat other {};
    if (!entry.path().filename().string().starts_with("sidestep-")) continue;
    if (stat(entry.path().c_str(), &other) == 0 && other.st_dev == own.st_dev && other.st_ino == own.st_ino)
      return true;
  }
  return false;
}

}  // namespace

void require_safe_network(const DdsSettings& settings) {
  if (settings.interface.starts_with("127.") || is_in_own_namespace()) return;
  if (!settings.insecure)
    throw std::invalid_argument(fmt::format(
        "no keys: any machine on the network of {} could command the robots; expected --keys, see "
        "`sidestep keys`, or "
        "--insecure",
        settings.interface == "all" ? "any interface" : settings.interface));
  static std::once_flag once;
  std::call_once(once, [] {
    log(LogLevel::kWarning,
        "no keys: any machine on this network can command the robots, see `sidestep keys`");
  });
}

}  // namespace sidestep
