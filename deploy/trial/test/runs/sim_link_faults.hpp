// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "deploy/trial/simulate/system/sim_system.hpp"
#include "deploy/trial/test/plan/planned_fault.hpp"

namespace sidestep {

/// Partitions and impairments of a system on SimBus. Links without a fault keep the scenario's network
/// quality.
class SimLinkFaults {
 public:
  /// Both arguments must outlive this object.
  SimLinkFaults(SimSystem& system, const Scenario& scenario);

  void begin(const PartitionFault& partition) { cut(partition, 1); }
  void end(const PartitionFault& partition) { cut(partition, -1); }
  /// Replaces the impairment of the fault's target, as over DDS.
  void begin(const ImpairmentFault& fault) { impair(fault.target, fault.quality); }
  void end(const ImpairmentFault& fault) { impair(fault.target, kUnimpairedLink); }
  /// Removes a process's impairment when it dies, as over DDS.
  void end_impairment(const std::string& process) {
    if (impairments_.contains(process)) impair(process, kUnimpairedLink);
  }

 private:
  void cut(const PartitionFault& partition, int count);
  void impair(const std::string& target, const LinkQuality& quality);
  void update(const std::string& from, const std::string& to);

  SimSystem& system_;
  const NetworkSpec& network_;
  std::vector<std::string> processes_;
  std::map<std::pair<std::string, std::string>, int> cuts_;  // indexed by sender and receiver
  std::map<std::string, LinkQuality> impairments_;           // indexed by receiver
};

}  // namespace sidestep
