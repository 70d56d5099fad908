// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/free_domain.hpp"

#include <cerrno>
#include <fcntl.h>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <sys/file.h>
#include <unistd.h>
#include <utility>

#include "common/file/output_file.hpp"

namespace sidestep {
namespace {

/// The UDP ports in this network namespace on which processes listen.
std::set<unsigned> open_ports() {
  std::ifstream file("/proc/net/udp");
  std::string line;
  std::getline(file, line);
  std::set<unsigned> result;
  while (std::getline(file, line)) {
    // " sl local_address", with an address such as 0100007F:1CE8
    std::istringstream words(line);
    std::string slot, local;
    words >> slot >> local;
    if (const auto colon = local.find(':'); colon != std::string::npos)
      result.insert(static_cast<unsigned>(std::stoul(local.substr(colon + 1), nullptr, 16)));
  }
  return result;
}

/// Whether a port of the domain is open (RTPS 2.2, 9.6.1.1).
bool is_used(int domain, const std::set<unsigned>& ports) {
  constexpr unsigned kFirstPort = 7400, kPorts = 250;
  const unsigned first = kFirstPort + kPorts * static_cast<unsigned>(domain);
  const auto found = ports.lower_bound(first);
  return found != ports.end() && *found < first + kPorts;
}

/// Opens a domain's lock file. Without permission to write a file that another user has made, reading
/// suffices.
int open_lock(const std::string& path) {
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  return file < 0 && errno == EACCES ? open(path.c_str(), O_RDONLY | O_CLOEXEC) : file;
}

}  // namespace

FreeDomain::FreeDomain() {
  const std::set<unsigned> ports = open_ports();
  std::optional<std::pair<std::string, std::string>> unwritable;  // a lock file, and why it cannot be made
  // Users tend to choose domains below 10; from 101 on, Linux may assign the ports to any program.
  for (number_ = 10; number_ <= 100; ++number_) {
    if (is_used(number_, ports)) continue;
    const std::string path = "/tmp/sidestep-domain-" + std::to_string(number_);
    lock_ = open_lock(path);
    if (lock_ >= 0 && flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
    if (lock_ < 0)
      unwritable = {path, write_problem(path, errno)};
    else
      close(lock_);
  }
  if (unwritable) throw_unwritable(unwritable->first, unwritable->second);
  throw std::runtime_error("no DDS domain from 10 to 100 is free on this machine");
}

FreeDomain::~FreeDomain() { close(lock_); }

}  // namespace sidestep
