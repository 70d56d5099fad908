// SPDX-License-Identifier: Apache-2.0
#include "deploy/simulate/campaign/fault_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "deploy/simulate/system/sim_system.hpp"

namespace sidestep {
namespace {

constexpr double kLongestDelay_s = 0.15;
constexpr double kMostLoss = 0.3;
// Nothing begins later than so long before everything heals.
constexpr Duration kLeastTime = std::chrono::milliseconds(1);
constexpr Duration kTwinLeast = std::chrono::milliseconds(50);

class Draw {
 public:
  Draw(const Scenario& scenario, ProcessNames processes, Duration duration, Duration calm, Rng& rng)
      : scenario_(scenario), processes_(std::move(processes)), rng_(rng) {
    plan_.healed_at = std::max(Duration{0}, duration - calm);
    // Troubles come in flocks, because two at once do what one does not.
    for (std::uint64_t left = 1 + rng_.below(5); left > 0; --left) flocks_s_.push_back(any_time_s());
  }

  FaultPlan make() {
    if (rng_.chance(0.25)) sample_twins();
    sample_hosts();
    if (rng_.chance(0.8)) sample_network();
    if (rng_.chance(0.55)) repeat(6, [&] { sample_partition(); });
    if (rng_.chance(0.6)) repeat(8, [&] { sample_pause(); });
    if (rng_.chance(0.65)) repeat(8, [&] { sample_kill(); });
    if (rng_.chance(0.12)) repeat(8, [&] { sample_disturbance(); });
    std::ranges::stable_sort(plan_.faults, {}, &TimedFault::at);
    return std::move(plan_);
  }

 private:
  template <typename Do>
  void repeat(std::uint64_t most, Do draw) {
    for (std::uint64_t left = 1 + rng_.below(most); left > 0; --left) draw();
  }
  double log_uniform(double low, double high) { return low * std::pow(high / low, rng_.uniform()); }
  double any_time_s() { return rng_.uniform(0, to_seconds(plan_.healed_at)); }
  Duration time() {
    const double any_s = rng_.chance(0.35) ? any_time_s() : pick(flocks_s_) + 0.4 * rng_.normal();
    return std::clamp(from_seconds(any_s), Duration{0}, std::max(Duration{0}, plan_.healed_at - kLeastTime));
  }
  template <typename Item>
  const Item& pick(const std::vector<Item>& from) {
    return from[rng_.below(from.size())];
  }
  void add(Duration at, Fault fault) {
    if (at < plan_.healed_at) plan_.faults.push_back({at, std::move(fault)});
  }
  Duration until_healed(Duration at, double wish_s) {
    return std::min(from_seconds(wish_s), plan_.healed_at - at);
  }

  std::string any_agent() { return agent_process(pick(scenario_.robots).id); }
  /// What matters more comes more often.
  std::string any_victim() {
    const double u = rng_.uniform();
    return u < 0.3 ? any_of("coordinator") : u < 0.4 ? "vision" : any_agent();
  }
  /// One of the processes whose names begin so.
  std::string any_of(const std::string& begin) {
    ProcessNames found;
    std::ranges::copy_if(processes_, std::back_inserter(found),
                         [&](const auto& p) { return p.starts_with(begin); });
    return pick(found);
  }
  ProcessNames some_agents() {
    ProcessNames agents;
    const double share = rng_.uniform(0.1, 0.9);
    for (const RobotSpec& robot : scenario_.robots) {
      if (rng_.chance(share)) agents.push_back(agent_process(robot.id));
    }
    if (agents.empty()) agents.push_back(any_agent());
    return agents;
  }
  ProcessNames others_than(const ProcessNames& group) const {
    ProcessNames others;
    std::ranges::copy_if(processes_, std::back_inserter(others),
                         [&](const auto& p) { return std::ranges::find(group, p) == group.end(); });
    return others;
  }

  void sample_hosts() {
    const bool each_on_its_own = rng_.chance(0.3);
    plan_.hosts.resize(each_on_its_own ? processes_.size() : 1 + rng_.below(5));
    for (std::size_t i = 0; i < processes_.size(); ++i) {
      plan_.hosts[each_on_its_own ? i : rng_.below(plan_.hosts.size())].push_back(processes_[i]);
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
    quality.delay_max = from_seconds(std::min(kLongestDelay_s, min_s + mean_s * rng_.uniform(2, 20)));
    if (rng_.chance(0.7)) quality.loss = rng_.uniform(0, is_harsh ? kMostLoss : 0.03);
    if (rng_.chance(0.6)) quality.mean_burst = log_uniform(1, 30);
    if (rng_.chance(0.5)) quality.duplicate = rng_.uniform(0, is_harsh ? 0.3 : 0.02);
    return quality;
  }

  void sample_network() {
    add(Duration{0}, WeatherChange{processes_, processes_, sample_quality()});
    for (std::uint64_t left = rng_.below(5); left > 0; --left) {
      const ProcessNames& host = pick(plan_.hosts);
      const double u = rng_.uniform();
      if (u < 0.4)
        add(time(), WeatherChange{processes_, processes_, sample_quality()});
      else if (u < 0.7)
        add(time(), WeatherChange{host, others_than(host), sample_quality()});
      else
        add(time(), WeatherChange{others_than(host), host, sample_quality()});
    }
  }

  void sample_partition() {
    const Duration at = time();
    const Duration length = until_healed(at, log_uniform(0.05, 8));
    const double u = rng_.uniform();
    ProcessNames group = u < 0.4 ? pick(plan_.hosts) : u < 0.6 ? some_agents() : ProcessNames{any_victim()};
    ProcessNames rest = others_than(group);
    if (group.size() == 1 && rng_.chance(0.6)) rest = {pick(rest)};
    if (rest.empty()) return;
    const double way = rng_.uniform();
    if (way < 0.7) add(at, Partition{group, rest, length});
    if (way > 0.35) add(at, Partition{rest, group, length});
  }

  void sample_pause() {
    const double u = rng_.uniform();
    Pause pause;
    pause.processes = u < 0.12   ? pick(plan_.hosts)
                      : u < 0.25 ? some_agents()
                      : u < 0.3  ? ProcessNames{"simulator"}
                                 : ProcessNames{any_victim()};
    const Duration at = time();
    pause.duration = until_healed(at, log_uniform(0.1, 5));
    pause.most_waiting = static_cast<std::size_t>(log_uniform(10, 5000));
    add(at, pause);
  }

  void sample_kill() {
    const std::string victim = any_victim();
    const Duration at = time();
    add(at, Kill{victim});
    // Everybody comes back: no later coordinator grants anything while an agent is missing.
    const double dead_s = rng_.chance(0.3) ? 0 : log_uniform(0.01, 4);
    add(std::max(at + Duration{1}, at + until_healed(at, dead_s) - Duration{1}), Start{victim});
  }

  void sample_disturbance() {
    static constexpr msg::DisturbanceKind kKinds[] = {msg::DISTURBANCE_PUSH, msg::DISTURBANCE_SLIP,
                                                      msg::DISTURBANCE_BLOCK, msg::DISTURBANCE_REBOOT};
    Hand hand;
    hand.robot = pick(scenario_.robots).id;
    hand.kind = kKinds[rng_.below(std::size(kKinds))];
    const Duration at = time();
    hand.push_mps = rotated(Vec2(log_uniform(0.05, 2), 0), rng_.uniform(-3.14, 3.14));
    hand.grip = rng_.uniform(0.05, 0.9);
    hand.heading_rad = rng_.uniform(-3.14, 3.14);
    hand.duration = until_healed(at, log_uniform(0.05, 3));
    add(at, hand);
  }

  /// Two agents for one robot, alive at once, until one of them dies.
  void sample_twins() {
    repeat(3, [&] {
      const RobotId robot = pick(scenario_.robots).id;
      const std::string first = agent_process(robot), second = twin_process(robot);
      if (std::ranges::find(processes_, second) != processes_.end()) return;
      processes_.push_back(second);
      // Nobody starts an agent again within less than this of its twin's start.
      const Duration at = std::max(Duration{0}, std::min(time(), plan_.healed_at - kTwinLeast));
      add(at, Start{second});
      const Duration yields = at + until_healed(at, log_uniform(0.02, 10)) - Duration{4};
      add(yields, Kill{first});
      // Whoever of the two lives then has yielded to the other, for ever.
      const Duration end =
          rng_.chance(0.5) ? yields + until_healed(yields, log_uniform(0.02, 10)) : plan_.healed_at;
      add(std::max(yields, end - Duration{3}), Kill{first});
      add(std::max(yields, end - Duration{3}), Kill{second});
      add(std::max(yields, end - Duration{3}) + Duration{1}, Start{first});
    });
  }

  const Scenario& scenario_;
  ProcessNames processes_;
  Rng& rng_;
  FaultPlan plan_;
  std::vector<double> flocks_s_;
};

}  // namespace

FaultPlan sample_faults(const Scenario& scenario, const ProcessNames& processes, Duration duration,
                      Duration calm, Rng& rng) {
  return Draw(scenario, processes, duration, calm, rng).make();
}

}  // namespace sidestep
