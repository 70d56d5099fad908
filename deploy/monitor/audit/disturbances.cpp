// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/audit/disturbances.hpp"

#include <algorithm>

namespace sidestep {
namespace {

constexpr Duration kMaxDuration{60'000'000'000};
// For this long after the disturbance, a displaced robot may pass through its place by chance.
constexpr Duration kSettlingTime{1'000'000'000};

}  // namespace

Disturbances::Disturbances(std::size_t robots, bool has_position_checks)
    : has_position_checks_(has_position_checks), states_(robots) {}

void Disturbances::extend(std::size_t robot, Time end_time) {
  std::optional<Time>& until = states_[robot].until;
  until = std::max(until.value_or(Time::min()), end_time + kSettlingTime);
}

void Disturbances::disturb(std::size_t robot, Time end_time, Time now) {
  if (states_[robot].reported_end == end_time) return;
  states_[robot].reported_end = end_time;
  extend(robot, std::min(end_time, now + kMaxDuration));
}

void Disturbances::update(Time now, const std::vector<std::optional<Vec2>>& positions_m,
                          double contact_distance_m) {
  now_ = now;
  for (State& state : states_) {
    if (!state.until) continue;
    // The simulator's clock may have been set back.
    state.until = std::min(*state.until, now + kMaxDuration + kSettlingTime);
    if (*state.until <= now && !has_position_checks_) state.until.reset();
  }
  std::erase_if(pushes_, [&](const Push& push) {
    const auto &pushing = positions_m[push.pushing], &pushed = positions_m[push.pushed];
    return !pushing || !pushed || (*pushing - *pushed).norm() > contact_distance_m;
  });
  for (const Push& push : pushes_) {
    if (is_disturbed(push.pushing)) extend(push.pushed, now);
  }
}

bool Disturbances::on_contact(std::optional<std::size_t> first, std::optional<std::size_t> second) {
  const bool is_first_disturbed = first && is_disturbed(*first);
  const bool is_second_disturbed = second && is_disturbed(*second);
  if (first && second && is_first_disturbed != is_second_disturbed) {
    const Push push = is_first_disturbed ? Push{*first, *second} : Push{*second, *first};
    extend(push.pushed, now_);
    pushes_.push_back(push);
  }
  return is_first_disturbed || is_second_disturbed;
}

void Disturbances::confirm_in_place(std::size_t robot) {
  std::optional<Time>& until = states_[robot].until;
  if (until && *until <= now_) until.reset();
}

}  // namespace sidestep
