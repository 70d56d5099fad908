// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/fault_player.hpp"

#include <algorithm>

#include "deploy/trial/simulate/campaign/other_rules.hpp"
#include "simulator/world/disturbance_codec.hpp"

namespace sidestep {
namespace {

using std::chrono::microseconds;

LinkQuality within_host() { return {0, 1, 0, microseconds(30), microseconds(60), microseconds(300), false}; }
LinkQuality between_hosts() {
  return {0, 1, 0, microseconds(200), microseconds(350), microseconds(1000), false};
}

}  // namespace

FaultPlayer::FaultPlayer(SimSystem& system, const Scenario& scenario, const FaultPlan& plan)
    : system_(system), scenario_(scenario), plan_(plan), operator_(system, scenario) {
  for (const TimedFault& timed : plan.faults) {
    const auto* const send = std::get_if<SendForgery>(&timed.fault);
    const auto is_of = [send](const auto& forger) { return forger->victim() == send->victim; };
    if (send && std::ranges::none_of(forgers_, is_of))
      forgers_.push_back(std::make_unique<Forger>(system.network(), scenario, send->victim));
  }
  const auto is_order = [](const TimedFault& timed) {
    return std::holds_alternative<GiveOrder>(timed.fault);
  };
  if (std::ranges::any_of(plan.faults, is_order)) clients_.emplace(system, scenario.radius_m);
  for (const ProcessNames& from_host : plan.hosts) {
    for (const ProcessNames& to_host : plan.hosts) {
      for (const std::string& from : from_host) {
        for (const std::string& to : to_host) {
          Link link{from, to, between_hosts(), &from_host == &to_host, 0};
          set(links_[from][to] = link);
        }
      }
    }
  }
}

template <typename Do>
void FaultPlayer::for_each_link(const ProcessNames& from, const ProcessNames& to, Do change) {
  for (const std::string& sender : from) {
    for (const std::string& receiver : to) {
      Link& link = links_.at(sender).at(receiver);
      change(link);
      set(link);
    }
  }
}

void FaultPlayer::set(const Link& link) {
  LinkQuality quality = link.is_within_host ? within_host() : link.quality;
  quality.is_cut = link.cuts > 0 || link.is_cut_for_good;
  system_.set_link(link.from, link.to, quality);
}

void FaultPlayer::operator()(const LinkChange& change) {
  for_each_link(change.from, change.to, [&](Link& link) { link.quality = change.quality; });
}

void FaultPlayer::operator()(const Partition& partition) {
  for_each_link(partition.from, partition.to, [](Link& link) { ++link.cuts; });
  ends_.push_back({system_.now() - system_.begin() + partition.duration, partition});
}

void FaultPlayer::operator()(const LastingCut& cut) {
  for_each_link(cut.from, cut.to, [](Link& link) { link.is_cut_for_good = true; });
  if (!clients_) return;
  for (const std::string& process : cut.to) clients_->expect_nothing_of(process);
}

void FaultPlayer::operator()(const Pause& pause) {
  for (const std::string& process : pause.processes) {
    system_.pause(process, pause.duration, pause.max_queued);
  }
}

void FaultPlayer::operator()(const RobotDisturbance& disturbance) {
  msg::Disturbance message = encode(disturbance);
  system_.disturb(message);
}

void FaultPlayer::start_with(const Scenario& scenario, const std::string& process) {
  system_.kill(process);
  system_.use_scenario(process, scenario);
  system_.restart(process);
}

void FaultPlayer::operator()(const StartWithOtherRule& start) {
  Scenario other = scenario_;
  other_rules()[start.rule].change(other);
  start_with(other, start.process);
}

void FaultPlayer::operator()(const SendForgery& send) {
  for (const auto& forger : forgers_) {
    if (forger->victim() != send.victim) continue;
    forgeries()[send.forgery].change(*forger);
    forger->send();
  }
}

std::vector<std::string> FaultPlayer::order_failures() const {
  return clients_ ? clients_->failures() : std::vector<std::string>{};
}

void FaultPlayer::advance(Duration until) {
  for (;;) {
    Duration next = until;
    for (const End& end : ends_) next = std::min(next, end.at);
    if (const auto due = operator_.due()) next = std::min(next, *due - system_.begin());
    system_.run_until(system_.begin() + next);
    std::erase_if(ends_, [&](const End& end) {
      if (end.at > next) return false;
      for_each_link(end.partition.from, end.partition.to, [](Link& link) { --link.cuts; });
      return true;
    });
    operator_.update();
    if (next >= until) return;
  }
}

void FaultPlayer::heal() {
  is_healed_ = true;
  operator_.resume_held();
  ends_.clear();
  for (auto& [sender, row] : links_) {
    for (auto& [receiver, link] : row) {
      link.quality = between_hosts();
      link.cuts = 0;
      set(link);
    }
  }
}

void FaultPlayer::run_until(Duration after_begin) {
  while (next_ < plan_.faults.size() && plan_.faults[next_].at <= after_begin) {
    const TimedFault& timed = plan_.faults[next_++];
    advance(timed.at);
    std::visit(*this, timed.fault);
  }
  if (!is_healed_ && plan_.healed_at <= after_begin) {
    advance(plan_.healed_at);
    heal();
  }
  advance(after_begin);
}

}  // namespace sidestep
