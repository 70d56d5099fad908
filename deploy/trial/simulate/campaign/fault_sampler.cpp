// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/fault_sampler.hpp"

#include <algorithm>
#include <set>
#include <span>

#include "deploy/trial/simulate/campaign/forger.hpp"
#include "deploy/trial/simulate/campaign/rule_mutations.hpp"
#include "deploy/trial/simulate/system/system_processes.hpp"

namespace sidestep {
namespace {

constexpr double kMaxDelay_s = 0.15;
constexpr double kMaxLoss = 0.3;
constexpr Duration kMinTwinLifetime = std::chrono::milliseconds(50);

class FaultSampler {
 public:
  FaultSampler(const Scenario& scenario, ProcessNames processes, const FaultTimes& times, Rng& rng)
      : scenario_(scenario), processes_(std::move(processes)), times_(times), rng_(rng) {
    plan_.healed_at = times.healed_at();
  }

  FaultPlan sample() {
    if (rng_.chance(0.25)) sample_twins();
    sample_hosts();
    if (rng_.chance(0.8)) sample_network();
    if (rng_.chance(0.55)) repeat(6, [&] { sample_partition(); });
    if (rng_.chance(0.6)) repeat(8, [&] { sample_pause(); });
    if (rng_.chance(0.65)) repeat(8, [&] { sample_kill(); });
    if (rng_.chance(0.1)) repeat(2, [&] { sample_other_rules(); });
    if (rng_.chance(0.1)) sample_forgeries();
    if (rng_.chance(0.1)) repeat(3, [&] { sample_second(); });
    return std::move(plan_);
  }

 private:
  template <typename Do>
  void repeat(std::uint64_t max_count, Do sample_one) {
    for (std::uint64_t left = 1 + rng_.below(max_count); left > 0; --left) sample_one();
  }
  double log_uniform(double low, double high) { return sample_log_uniform(low, high, rng_); }
  Duration time() { return times_.sample(rng_); }
  Duration until_healed(Duration at, double desired_s) const { return times_.until_healed(at, desired_s); }
  template <typename Item>
  const Item& pick(const std::vector<Item>& from) {
    return from[rng_.below(from.size())];
  }
  std::string random_agent() { return agent_process(pick(scenario_.robots).id); }
  /// Processes with more influence are chosen more often.
  std::string random_victim() {
    const double u = rng_.uniform();
    return u < 0.3 ? random_process("coordinator") : u < 0.4 ? "vision" : random_agent();
  }
  /// A random process whose name starts with the prefix.
  std::string random_process(const std::string& prefix) {
    ProcessNames found;
    std::ranges::copy_if(processes_, std::back_inserter(found),
                         [&](const auto& p) { return p.starts_with(prefix); });
    return pick(found);
  }
  ProcessNames random_agents() {
    ProcessNames agents;
    const double share = rng_.uniform(0.1, 0.9);
    for (const RobotSpec& robot : scenario_.robots) {
      if (rng_.chance(share)) agents.push_back(agent_process(robot.id));
    }
    if (agents.empty()) agents.push_back(random_agent());
    return agents;
  }
  ProcessNames all_except(const ProcessNames& group) const {
    ProcessNames others;
    std::ranges::copy_if(processes_, std::back_inserter(others),
                         [&](const auto& p) { return std::ranges::find(group, p) == group.end(); });
    return others;
  }

  void sample_hosts() {
    const bool is_one_per_process = rng_.chance(0.3);
    plan_.hosts.resize(is_one_per_process ? processes_.size() : 1 + rng_.below(5));
    for (std::size_t i = 0; i < processes_.size(); ++i) {
      plan_.hosts[is_one_per_process ? i : rng_.below(plan_.hosts.size())].push_back(processes_[i]);
    }
    std::erase_if(plan_.hosts, [](const ProcessNames& host) { return host.empty(); });
  }

  LinkQuality sample_quality() {
    const bool is_harsh = rng_.chance(0.5);
    LinkQuality quality;
    const double min_s = rng_.chance(0.2) ? rng_.uniform(0, 0.02) : rng_.uniform(0, 0.001);
    const double mean_s = is_harsh ? log_uniform(0.002, 0.05) : log_uniform(0.0002, 0.005);
    quality.delay_min = from_seconds(min_s);
    quality.delay_mean = from_seconds(min_s + mean_s);
    quality.delay_max = from_seconds(std::min(kMaxDelay_s, min_s + mean_s * rng_.uniform(2, 20)));
    if (rng_.chance(0.7)) quality.loss = rng_.uniform(0, is_harsh ? kMaxLoss : 0.03);
    if (rng_.chance(0.6)) quality.mean_burst = log_uniform(1, 30);
    if (rng_.chance(0.5)) quality.duplicate = rng_.uniform(0, is_harsh ? 0.3 : 0.02);
    return quality;
  }

  void sample_network() {
    plan_.add(Duration{0}, LinkChange{processes_, processes_, sample_quality()});
    for (std::uint64_t left = rng_.below(5); left > 0; --left) {
      const ProcessNames& host = pick(plan_.hosts);
      const double u = rng_.uniform();
      const LinkQuality quality = sample_quality();
      const Duration at = time();
      if (u < 0.4)
        plan_.add(at, LinkChange{processes_, processes_, quality});
      else if (u < 0.7)
        plan_.add(at, LinkChange{host, all_except(host), quality});
      else
        plan_.add(at, LinkChange{all_except(host), host, quality});
    }
  }

  void sample_partition() {
    const Duration at = time();
    const Duration length = until_healed(at, log_uniform(0.05, 8));
    const double u = rng_.uniform();
    ProcessNames group = u < 0.4   ? pick(plan_.hosts)
                         : u < 0.6 ? random_agents()
                                   : ProcessNames{random_victim()};
    ProcessNames rest = all_except(group);
    if (group.size() == 1 && rng_.chance(0.6)) rest = {pick(rest)};
    if (rest.empty()) return;
    const double direction = rng_.uniform();
    if (direction < 0.7) plan_.add(at, Partition{group, rest}, length);
    if (direction > 0.35) plan_.add(at, Partition{rest, group}, length);
  }

  void sample_pause() {
    const double u = rng_.uniform();
    Pause pause;
    pause.processes = u < 0.12   ? pick(plan_.hosts)
                      : u < 0.25 ? random_agents()
                      : u < 0.3  ? ProcessNames{"simulator"}
                                 : ProcessNames{random_victim()};
    const Duration at = time();
    const Duration length = until_healed(at, log_uniform(0.1, 5));
    pause.max_queued = static_cast<std::size_t>(log_uniform(10, 5000));
    plan_.add(at, pause, length);
  }

  void sample_kill() {
    const std::string victim = random_victim();
    const Duration at = time();
    plan_.add(at, Kill{victim});
    // Every killed process is restarted, because a later coordinator grants only after all agents have
    // registered.
    const double dead_s = rng_.chance(0.3) ? 0 : log_uniform(0.01, 4);
    plan_.add(times_.after(at, dead_s), Start{victim});
  }

  /// Makes a process work with different rules for a while. A standby may keep them permanently if there is
  /// another coordinator.
  void sample_other_rules() {
    const double u = rng_.uniform();
    const std::string victim = u < 0.4   ? coordinator_process(scenario_.coordinators - 1)
                               : u < 0.8 ? random_agent()
                                         : "vision";
    if (!with_changed_rules_.insert(victim).second) return;
    std::size_t rule = rng_.below(rule_mutations().size());
    // An agent needs its own robot on the roster.
    while (victim.starts_with("agent") && rule_mutations()[rule].changes_roster)
      rule = rng_.below(rule_mutations().size());
    const Duration at = time();
    plan_.add(at, StartWithMutatedRule{victim, rule});
    const bool is_for_good = scenario_.coordinators > 1 && u < 0.15;
    if (!is_for_good) plan_.add(times_.after(at, log_uniform(0.2, 8)), StartWithOwnRules{victim});
  }
  void sample_forgeries() {
    const RobotId victim = pick(scenario_.robots).id;
    repeat(12, [&] {
      const std::size_t forgery = rng_.below(forgeries().size());
      const Duration at = time();
      if (!forgeries()[forgery].is_plausible_report) plan_.add(at, SendForgery{victim, forgery});
    });
  }

  /// Runs two agents for one robot at the same time, until one of them dies.
  void sample_twins() {
    repeat(3, [&] {
      const RobotId robot = pick(scenario_.robots).id;
      const std::string first = agent_process(robot), second = twin_process(robot);
      if (std::ranges::find(processes_, second) != processes_.end()) return;
      processes_.push_back(second);
      // Leaves at least kMinTwinLifetime between the start of the second agent and the restart of the first
      // one.
      const Duration at = std::max(Duration{0}, std::min(time(), plan_.healed_at - kMinTwinLifetime));
      plan_.add(at, Start{second});
      const Duration first_kill = at + until_healed(at, log_uniform(0.02, 10)) - Duration{4};
      plan_.add(first_kill, Kill{first});
      // The surviving agent may have yielded permanently to the dead one, so both are killed and one is
      // restarted.
      const Duration end =
          rng_.chance(0.5) ? first_kill + until_healed(first_kill, log_uniform(0.02, 10)) : plan_.healed_at;
      plan_.add(std::max(first_kill, end - Duration{3}), Kill{first});
      plan_.add(std::max(first_kill, end - Duration{3}), Kill{second});
      plan_.add(std::max(first_kill, end - Duration{3}) + Duration{1}, Start{first});
    });
  }

  /// Starts a second process of a kind that must run alone, on a host of its own. For a while, the second
  /// process may not hear the first one or some other processes.
  void sample_second() {
    const std::string first = rng_.chance(0.6) ? "simulator" : "vision", second = second_process(first);
    const Duration at = time();
    if (!seconds_.insert(second).second) return;
    plan_.hosts.push_back({second});
    plan_.add(at, Start{second});
    if (rng_.chance(0.5)) {
      const ProcessNames rest{rng_.chance(0.5) ? first : random_victim()};
      const Duration length = until_healed(at, log_uniform(0.05, 8));
      if (rng_.chance(0.7)) plan_.add(at, Partition{{second}, rest}, length);
      plan_.add(at, Partition{rest, {second}}, length);
    }
    plan_.add(plan_.healed_at - Duration{1}, Kill{second});
    // If the first process was restarted in the meantime, it was the later one of the two, and has therefore
    // ended.
    plan_.add(plan_.healed_at - Duration{1}, Start{first});
  }

  const Scenario& scenario_;
  ProcessNames processes_;
  const FaultTimes& times_;
  Rng& rng_;
  FaultPlan plan_;
  std::set<std::string> with_changed_rules_;
  std::set<std::string> seconds_;
};

}  // namespace

FaultPlan sample_faults(const Scenario& scenario, const ProcessNames& processes, const FaultTimes& times,
                        Rng& rng) {
  return FaultSampler(scenario, processes, times, rng).sample();
}

}  // namespace sidestep
