// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <sys/types.h>
#include <vector>

#include "deploy/launch/hosts/hosts_file.hpp"

namespace sidestep {

/// Makes this thread, and what it starts from then on, use another network namespace while it lives; then the
/// one from before.
class NamespaceVisit {
 public:
  /// Throws std::runtime_error when there is no such namespace or the right to enter it is missing.
  explicit NamespaceVisit(const std::string& name);
  ~NamespaceVisit();
  NamespaceVisit(const NamespaceVisit&) = delete;
  NamespaceVisit& operator=(const NamespaceVisit&) = delete;

 private:
  int before_ = -1;
};

/// Hosts that this machine plays: a network namespace each, and one more with the bridge that connects them
/// and the launcher's address, so that nothing of it shows outside and several runs never meet. All names
/// carry the process's pid.
class NamespaceNetwork {
 public:
  /// `hosts.create` must hold. Throws std::runtime_error, leaving nothing behind.
  explicit NamespaceNetwork(const Hosts& hosts);
  ~NamespaceNetwork();
  NamespaceNetwork(const NamespaceNetwork&) = delete;
  NamespaceNetwork& operator=(const NamespaceNetwork&) = delete;

  /// The namespace with the bridge: where to go to take part.
  std::string hub() const;
  /// The namespace that the hosts file calls `name`.
  std::string name_of(const std::string& name) const;

 private:
  void make(const Hosts& hosts);
  void connect(const HostSpec& host, const std::string& cable, int prefix_length);
  void remove();

  std::vector<std::string> made_;
};

/// What the namespace with the bridge is called.
inline constexpr const char* kHubName = "hub";

/// A namespace that some launcher has made.
struct RunNamespace {
  std::string name;  ///< as `ip netns` knows it
  pid_t launcher = 0;
  std::string called;  ///< in the hosts file, or kHubName
};

/// All of them on this machine.
std::vector<RunNamespace> run_namespaces();

/// Removes the namespaces of launchers that live no longer: those that were killed could not.
void remove_abandoned_namespaces();

}  // namespace sidestep
