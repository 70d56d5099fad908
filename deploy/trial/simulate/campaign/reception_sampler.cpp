// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/reception_sampler.hpp"

#include <algorithm>
#include <iterator>

#include "deploy/trial/simulate/system/sim_system.hpp"

namespace sidestep {
namespace {

class ReceptionSampler {
 public:
  ReceptionSampler(const Scenario& scenario, const FaultTimes& times, FaultPlan& plan, Rng& rng)
      : scenario_(scenario),
        times_(times),
        plan_(plan),
        rng_(rng),
        processes_(system_process_names(scenario)) {}

  void sample() {
    if (rng_.chance(0.15)) {
      for (std::uint64_t left = 1 + rng_.below(3); left > 0; --left) sample_temporary_fault();
    }
    if (scenario_.coordinators > 1 && rng_.chance(0.12) && can_others_serve()) sample_permanent_fault();
  }

 private:
  /// A coordinator with different rules cannot serve, and a coordinator whose clock is so wrong that it
  /// refuses vision's messages cannot take over.
  bool can_others_serve() const {
    const bool has_other_rules = std::ranges::any_of(plan_.faults, [](const TimedFault& timed) {
      return std::holds_alternative<StartWithMutatedRule>(timed.fault);
    });
    const std::size_t out_of_bound = robots_with(plan_, RobotEnd::kClockOutOfBound).size();
    return !has_other_rules && out_of_bound < scenario_.robots.size();
  }
  std::string random_coordinator() {
    return coordinator_process(
        static_cast<int>(rng_.below(static_cast<std::uint64_t>(scenario_.coordinators))));
  }
  std::string random_process() {
    const double u = rng_.uniform();
    return u < 0.6   ? random_coordinator()
           : u < 0.7 ? "vision"
                     : agent_process(scenario_.robots[rng_.below(scenario_.robots.size())].id);
  }
  /// All processes except this one, or some of them.
  ProcessNames sample_others(const std::string& process) {
    ProcessNames others;
    const double share = rng_.chance(0.5) ? 1 : rng_.uniform(0.1, 0.9);
    std::ranges::copy_if(processes_, std::back_inserter(others),
                         [&](const auto& other) { return other != process && rng_.chance(share); });
    return others;
  }
  void sample_temporary_fault() {
    const std::string process = random_process();
    const ProcessNames others = sample_others(process);
    const bool cannot_receive = rng_.chance(0.5);
    const Duration at = times_.sample(rng_);
    const Duration length = times_.until_healed(at, sample_log_uniform(0.5, 15, rng_));
    if (others.empty()) return;
    plan_.add(at, cannot_receive ? Partition{others, {process}} : Partition{{process}, others}, length);
  }
  void sample_permanent_fault() {
    const std::string process = random_coordinator();
    const ProcessNames others = sample_others(process);
    const bool cannot_receive = rng_.chance(0.5);
    const Duration at = times_.sample(rng_);
    if (others.empty()) return;
    plan_.add(at, cannot_receive ? Partition{others, {process}} : Partition{{process}, others});
  }

  const Scenario& scenario_;
  const FaultTimes& times_;
  FaultPlan& plan_;
  Rng& rng_;
  const ProcessNames processes_;
};

}  // namespace

void sample_reception(const Scenario& scenario, const FaultTimes& times, FaultPlan& plan, Rng& rng) {
  ReceptionSampler(scenario, times, plan, rng).sample();
}

}  // namespace sidestep
