// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/runs/sim_link_faults.hpp"

namespace sidestep {
namespace {

/// The probability that at least one of two independent events happens.
double either(double a, double b) { return 1 - (1 - a) * (1 - b); }

LinkQuality impaired(const NetworkSpec& network, const LinkQuality& fault) {
  LinkQuality quality = fault;
  quality.loss = either(network.loss, fault.loss);
  quality.duplicate = either(network.duplicate, fault.duplicate);
  quality.delay_min += network.delay_min;
  quality.delay_mean += (network.delay_min + network.delay_max) / 2;
  quality.delay_max += network.delay_max;
  return quality;
}

}  // namespace

SimLinkFaults::SimLinkFaults(SimSystem& system, const Scenario& scenario)
    : system_(system), network_(scenario.network), processes_(system_process_names(scenario)) {
  for (const RobotSpec& robot : scenario.robots) processes_.push_back(twin_process(robot.id));
}

void SimLinkFaults::cut(const PartitionFault& partition, int count) {
  for (const std::string& inside : partition.group) {
    for (const std::string& outside : partition.others) {
      if (partition.cuts_in) {
        cuts_[{outside, inside}] += count;
        update(outside, inside);
      }
      if (partition.cuts_out) {
        cuts_[{inside, outside}] += count;
        update(inside, outside);
      }
    }
  }
}

void SimLinkFaults::impair(const std::string& target, const LinkQuality& quality) {
  for (const std::string& to : processes_) {
    if (target != "all" && target != to) continue;
    impairments_[to] = quality;
    for (const std::string& from : processes_) {
      if (from != to) update(from, to);
    }
  }
}

void SimLinkFaults::update(const std::string& from, const std::string& to) {
  const auto fault = impairments_.find(to);
  LinkQuality quality = impaired(network_, fault == impairments_.end() ? kUnimpairedLink : fault->second);
  if (const auto count = cuts_.find({from, to}); count != cuts_.end() && count->second > 0)
    quality.is_cut = true;
  system_.set_link(from, to, quality);
}

}  // namespace sidestep
