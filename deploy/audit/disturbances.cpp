// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/disturbances.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {
namespace {

constexpr Duration kMaxDuration{60'000'000'000};
// Time after a disturbance during which a displaced robot may pass through its prescribed place by chance.
constexpr Duration kSettlingTime{1'000'000'000};
// A robot that is not back in place after this time is not expected to return.
constexpr Duration kMaxDisplacement{20'000'000'000};
constexpr double kRestSpeed_mps = 0.05;
constexpr Duration kRestTime{100'000'000};
constexpr Duration kMaxStep{10'000'000'000};

}  // namespace

std::optional<std::string_view> cause_of(msg::DisturbanceKind kind) {
  switch (kind) {
    case msg::DisturbanceKind::DISTURBANCE_PUSH:
      return "push";
    case msg::DisturbanceKind::DISTURBANCE_SLIP:
      return "slip";
    case msg::DisturbanceKind::DISTURBANCE_BLOCK:
      return "block";
    case msg::DisturbanceKind::DISTURBANCE_LIFT:
      return "lift";
    case msg::DisturbanceKind::DISTURBANCE_PLACE:
      return "place";
    case msg::DisturbanceKind::DISTURBANCE_REBOOT:
      return "reboot";
    case msg::DisturbanceKind::DISTURBANCE_FORGET_POSE:
      return "forget pose";
    case msg::DisturbanceKind::DISTURBANCE_CLOCK:
      return Disturbances::kClockCause;
    case msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF:
      return "switch off";
    case msg::DisturbanceKind::DISTURBANCE_SWITCH_ON:
      return "switch on";
    case msg::DisturbanceKind::DISTURBANCE_CARRY:
      return "carry";
    case msg::DisturbanceKind::DISTURBANCE_SEEN_BESIDE:
      return "seen beside";
    case msg::DisturbanceKind::DISTURBANCE_SEEN_AS:
      return "seen as";
    case msg::DisturbanceKind::DISTURBANCE_SEEN_FROZEN:
      return "seen frozen";
  }
  return std::nullopt;
}

Disturbances::Disturbances(std::size_t robots, const DisturbanceSettings& settings)
    : settings_(settings), robots_(robots), states_(robots) {}

void Disturbances::on_missed() {
  for (State& state : states_) state.is_uncertain |= state.displacement.has_value();
}

void Disturbances::on_reference_missed() {
  on_missed();
  // The robots may have moved while their positions were not received.
  for (State& state : states_) state.rests_since.reset();
}

bool Disturbances::is_displaced(std::size_t robot) const {
  const auto& displacement = states_[robot].displacement;
  return displacement && !displacement->back_at;
}

void Disturbances::displace(std::size_t robot, std::string_view cause, Time end) {
  auto& displacement = states_[robot].displacement;
  if (displacement) end = std::max(end, displacement->end);
  displacement = Displacement{cause, end, std::nullopt, std::vector<bool>(states_.size()), false};
}

void Disturbances::announce(std::size_t robot, std::string_view cause) {
  State& state = states_[robot];
  // The message may arrive after the report of the disturbance.
  if (state.displacement && state.displacement->cause == kUnknownCause)
    state.displacement->cause = cause;
  else
    state.announced = cause;
}

void Disturbances::disturb(std::size_t robot, Time end, Time now) {
  State& state = states_[robot];
  if (state.reported_end == end) return;
  state.reported_end = end;
  std::string_view cause = state.displacement ? state.displacement->cause : kUnknownCause;
  if (state.announced) cause = *std::exchange(state.announced, std::nullopt);
  displace(robot, cause, end == Time::max() ? now : std::min(end, now + kMaxDuration));
}

std::optional<std::string_view> Disturbances::excuse(std::optional<std::size_t> first,
                                                     std::optional<std::size_t> second) const {
  const auto cause_from = [this](std::optional<std::size_t> disturbed,
                                 std::optional<std::size_t> other) -> std::optional<std::string_view> {
    if (!disturbed || !states_[*disturbed].displacement) return std::nullopt;
    const Displacement& displacement = *states_[*disturbed].displacement;
    const bool is_excused = other ? !displacement.is_over[*other] : !displacement.is_over_for_obstacles;
    return is_excused ? std::optional(displacement.cause) : std::nullopt;
  };
  const auto cause = cause_from(first, second);
  return cause ? cause : cause_from(second, first);
}

std::optional<std::string_view> Disturbances::on_contact(std::optional<std::size_t> first,
                                                         std::optional<std::size_t> second, Time now) {
  const auto cause = excuse(first, second);
  if (!cause || !first || !second) return cause;
  const bool is_first_displaced = is_displaced(*first), is_second_displaced = is_displaced(*second);
  if (is_first_displaced != is_second_displaced)
    pushes_.push_back(is_first_displaced ? Push{*first, *second} : Push{*second, *first});
  for (const std::size_t robot : {*first, *second}) {
    const auto& displacement = states_[robot].displacement;
    displace(robot, displacement ? displacement->cause : *cause, now);
  }
  return cause;
}

void Disturbances::update(Time now, const std::vector<std::optional<ObservedRobot>>& robots) {
  add_pair_time(now);
  now_ = now;
  robots_ = robots;
  for (std::size_t i = 0; i < states_.size(); ++i) update_rest(i);
  update_pushes();
  for (std::size_t i = 0; i < states_.size(); ++i) update_displacement(i);
}

void Disturbances::update_rest(std::size_t robot) {
  State& state = states_[robot];
  const bool rests = robots_[robot] && robots_[robot]->speed_mps < kRestSpeed_mps;
  if (rests)
    state.rests_since = std::min(state.rests_since.value_or(*now_), *now_);
  else
    state.rests_since.reset();
  state.rests_displaced =
      rests && !robots_[robot]->is_in_place && (state.rests_displaced || is_displaced(robot));
}

void Disturbances::update_pushes() {
  std::erase_if(pushes_, [&](const Push& push) {
    const auto &pushing = robots_[push.pushing], &pushed = robots_[push.pushed];
    return !pushing || !pushed ||
           (pushing->position_m - pushed->position_m).norm() > settings_.contact_distance_m;
  });
  for (const Push& push : pushes_) {
    if (is_displaced(push.pushing)) displace(push.pushed, states_[push.pushing].displacement->cause, *now_);
  }
}

void Disturbances::update_displacement(std::size_t robot) {
  auto& displacement = states_[robot].displacement;
  if (!displacement) return;
  // The clock of ground truth or vision may have been set back.
  displacement->end = std::min(displacement->end, *now_ + kMaxDuration);
  if (displacement->back_at) displacement->back_at = std::min(*displacement->back_at, *now_);
  const Duration elapsed = *now_ - displacement->end;
  if (elapsed < Duration{0}) return;
  if (!displacement->back_at) {
    // By its own clock, a robot whose clock has jumped is in place; other robots expect it elsewhere.
    const bool may_be_clock = displacement->cause == kClockCause ||
                              (displacement->cause == kUnknownCause && !settings_.knows_causes);
    const bool may_drive = !may_be_clock && elapsed >= kSettlingTime;
    const bool is_settled = has_rested(robot, displacement->end) || may_drive;
    const bool is_back = is_settled && robots_[robot] && robots_[robot]->is_in_place;
    if (!is_back && elapsed < kMaxDisplacement) return;
    displacement->back_at = now_;
  }
  const Time back_at = *displacement->back_at;
  if (!robots_[robot] || robots_[robot]->from_obstacles_m >= settings_.margin_m + robots_[robot]->inflation_m)
    displacement->is_over_for_obstacles = true;
  bool are_all_over = displacement->is_over_for_obstacles;
  for (std::size_t other = 0; other < states_.size(); ++other) {
    if (other == robot || displacement->is_over[other]) continue;
    const bool has_stopped =
        !robots_[other] || has_rested(other, back_at) || *now_ - back_at >= settings_.braking_time;
    const bool is_over = has_stopped && !are_in_conflict(robot, other);
    displacement->is_over[other] = is_over;
    are_all_over = are_all_over && is_over;
  }
  if (are_all_over) displacement.reset();
}

bool Disturbances::has_rested(std::size_t robot, Time since) const {
  const std::optional<Time>& rests_since = states_[robot].rests_since;
  return rests_since && *now_ - std::max(*rests_since, since) >= kRestTime;
}

bool Disturbances::are_in_conflict(std::size_t a, std::size_t b) const {
  if (!robots_[a] || !robots_[b]) return false;
  const double separation_m = settings_.separation_m + robots_[a]->inflation_m + robots_[b]->inflation_m;
  return (robots_[a]->position_m - robots_[b]->position_m).norm() < separation_m;
}

void Disturbances::add_pair_time(Time now) {
  if (!now_) return;
  const double step_s = to_seconds(std::clamp(now - *now_, Duration{0}, kMaxStep));
  std::size_t on_floor = 0, excused = 0;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (!robots_[i]) continue;
    ++on_floor;
    if (!states_[i].displacement) continue;
    for (std::size_t j = 0; j < states_.size(); ++j) {
      // A pair in which both robots were disturbed counts once.
      const bool is_counted_at_j = j < i && states_[j].displacement;
      excused += j != i && robots_[j] && !is_counted_at_j && excuse(i, j);
    }
  }
  pair_s_ += static_cast<double>(on_floor * (on_floor - 1) / 2) * step_s;
  excused_pair_s_ += static_cast<double>(excused) * step_s;
}

}  // namespace sidestep
