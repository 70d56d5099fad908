// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>

#include "deploy/trial/fault/process_faults.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"

namespace sidestep {

/// The qualities of the links of a system on SimBus, and its partitions, which may overlap.
class SimLinkFaults {
 public:
  /// `initial` is the quality of links whose quality is not set. The system must outlive this object.
  SimLinkFaults(SimSystem& system, const LinkQuality& initial) : system_(system), initial_(initial) {}

  void set_quality(const std::string& from, const std::string& to, const LinkQuality& quality);
  void begin(const Partition& partition) { change(partition, 1); }
  void end(const Partition& partition) { change(partition, -1); }

 private:
  struct Link {
    LinkQuality quality;
    int partitions = 0;  // number of partitions that cut the link
  };
  void change(const Partition& partition, int count);
  Link& link(const std::string& from, const std::string& to) {
    return links_.try_emplace({from, to}, Link{initial_}).first->second;
  }
  void apply(const std::string& from, const std::string& to, const Link& link);

  SimSystem& system_;
  LinkQuality initial_;
  std::map<std::pair<std::string, std::string>, Link> links_;  // indexed by sender and receiver
};

}  // namespace sidestep
