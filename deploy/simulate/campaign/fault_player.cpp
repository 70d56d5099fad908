// SPDX-License-Identifier: Apache-2.0
#include "deploy/simulate/campaign/fault_player.hpp"

#include <algorithm>

#include "simulator/world/disturbance_codec.hpp"

namespace sidestep {
namespace {

using std::chrono::microseconds;

LinkQuality within_host() { return {0, 1, 0, microseconds(30), microseconds(60), microseconds(300), false}; }
LinkQuality between_hosts() {
  return {0, 1, 0, microseconds(200), microseconds(350), microseconds(1000), false};
}

}  // namespace

FaultPlayer::FaultPlayer(SimSystem& system, const FaultPlan& plan) : system_(system), plan_(plan) {
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
  quality.is_cut = link.cuts > 0;
  system_.set_link(link.from, link.to, quality);
}

void FaultPlayer::operator()(const LinkChange& change) {
  for_each_link(change.from, change.to, [&](Link& link) { link.quality = change.quality; });
}

void FaultPlayer::operator()(const Partition& partition) {
  for_each_link(partition.from, partition.to, [](Link& link) { ++link.cuts; });
  ends_.push_back({system_.now() - system_.begin() + partition.duration, partition});
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

void FaultPlayer::end_partitions(Duration until) {
  const auto earlier = [](const End& a, const End& b) { return a.at < b.at; };
  while (!ends_.empty()) {
    const auto first = std::ranges::min_element(ends_, earlier);
    if (first->at > until) return;
    const End end = *first;
    ends_.erase(first);
    system_.run_until(system_.begin() + end.at);
    for_each_link(end.partition.from, end.partition.to, [](Link& link) { --link.cuts; });
  }
}

void FaultPlayer::heal() {
  is_healed_ = true;
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
    end_partitions(timed.at);
    system_.run_until(system_.begin() + timed.at);
    std::visit(*this, timed.fault);
  }
  if (!is_healed_ && plan_.healed_at <= after_begin) {
    end_partitions(plan_.healed_at);
    system_.run_until(system_.begin() + plan_.healed_at);
    heal();
  }
  end_partitions(after_begin);
  system_.run_until(system_.begin() + after_begin);
}

}  // namespace sidestep
