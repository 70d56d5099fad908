// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <sys/types.h>
#include <unistd.h>
#include <vector>

#include "deploy/run/launch/hosts/hosts_file.hpp"

namespace sidestep {

/// Moves this thread, and processes that it starts, to another network namespace for the lifetime of the
/// object.
class ScopedNamespace {
 public:
  /// Throws std::runtime_error if the namespace does not exist or there is no permission to enter it.
  explicit ScopedNamespace(const std::string& name);
  ~ScopedNamespace();
  ScopedNamespace(const ScopedNamespace&) = delete;
  ScopedNamespace& operator=(const ScopedNamespace&) = delete;

 private:
  int previous_ = -1;
};

/// Emulated hosts on this machine: one network namespace per host, and one more with the launcher's address
/// and the bridge that connects them. The network is isolated from the machine and from other runs. All names
/// contain the process's pid.
class NamespaceNetwork {
 public:
  /// Precondition: hosts.create. Throws std::runtime_error after removing everything that it created.
  explicit NamespaceNetwork(const Hosts& hosts);
  ~NamespaceNetwork();
  NamespaceNetwork(const NamespaceNetwork&) = delete;
  NamespaceNetwork& operator=(const NamespaceNetwork&) = delete;

  /// The namespace with the bridge, where the launcher and observers run.
  std::string bridge() const;
  /// The full name of a namespace that is in the hosts file.
  std::string full_name(const std::string& label) const;

 private:
  void create(const Hosts& hosts);
  void connect(const HostSpec& host, const std::string& cable, int prefix_length);
  void remove();

  const pid_t launcher_ =
      getpid();  ///< the process that created the network, also in processes forked from it
  std::vector<std::string> created_;
};

/// The label of the namespace with the bridge.
inline constexpr const char* kBridgeLabel = "bridge";

/// A namespace that a launcher created.
struct RunNamespace {
  std::string name;  ///< the name in `ip netns`
  pid_t launcher = 0;
  std::string label;  ///< its name in the hosts file, or kBridgeLabel
};

/// The namespaces of all runs on this machine.
[[nodiscard]] std::vector<RunNamespace> run_namespaces();

/// Removes the namespaces of launchers that were killed.
void remove_abandoned_namespaces();

}  // namespace sidestep
