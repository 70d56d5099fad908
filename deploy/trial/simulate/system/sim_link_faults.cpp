// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/system/sim_link_faults.hpp"

namespace sidestep {

void SimLinkFaults::set_quality(const std::string& from, const std::string& to, const LinkQuality& quality) {
  Link& changed = link(from, to);
  changed.quality = quality;
  apply(from, to, changed);
}

void SimLinkFaults::change(const Partition& partition, int count) {
  const auto change_link = [&](const std::string& from, const std::string& to) {
    Link& changed = link(from, to);
    changed.partitions += count;
    apply(from, to, changed);
  };
  for (const std::string& from : partition.from) {
    for (const std::string& to : partition.to) {
      change_link(from, to);
      if (partition.is_two_way) change_link(to, from);
    }
  }
}

void SimLinkFaults::apply(const std::string& from, const std::string& to, const Link& link) {
  LinkQuality quality = link.quality;
  quality.is_cut = quality.is_cut || link.partitions > 0;
  system_.set_link(from, to, quality);
}

}  // namespace sidestep
