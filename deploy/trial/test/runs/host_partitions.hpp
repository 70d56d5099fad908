// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "deploy/run/launch/hosts/run_hosts.hpp"
#include "deploy/trial/test/plan/fault_test.hpp"

namespace sidestep {

/// Namespace hosts that are created for the run, so that the partitions of a test separate whole hosts:
/// processes that are on the same sides of all partitions share a host.
[[nodiscard]] Hosts hosts_for_partitions(const FaultTest& test);

/// Partitions between the namespace hosts of a run. Packets between the two sides are dropped, including
/// discovery packets. The launcher still receives packets from all hosts.
class HostPartitions {
 public:
  /// Throws std::runtime_error if a partition of the test does not separate whole namespace hosts. The hosts
  /// must outlive this object.
  HostPartitions(const FaultTest& test, const RunHosts& hosts);
  /// Ends all partitions.
  ~HostPartitions();
  HostPartitions(const HostPartitions&) = delete;
  HostPartitions& operator=(const HostPartitions&) = delete;

  /// Begins a partition. Throws std::runtime_error if the packet filter cannot be set.
  void begin(const Partition& partition) { change(partition, 1); }
  void end(const Partition& partition) { change(partition, -1); }

 private:
  using HostSet = std::set<const HostSpec*>;

  HostSet hosts_of(const std::vector<std::string>& processes) const;
  void check(const Partition& partition, const std::string& text) const;
  void change(const Partition& partition, int count);
  void set_filter(const HostSpec& host) const;

  const FaultTest& test_;
  const RunHosts& hosts_;
  /// Number of partitions, indexed by receiving host and sender's address.
  std::map<const HostSpec*, std::map<std::string, int>> cuts_;
};

}  // namespace sidestep
