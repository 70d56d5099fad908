// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/audit/disturbances.hpp"

#include <algorithm>

namespace sidestep {
namespace {

constexpr Duration kLongest{60'000'000'000};
// So long after it was let go it may still look as if it were in place.
constexpr Duration kSettles{1'000'000'000};

}  // namespace

Hands::Hands(std::size_t robots, bool sees_places) : sees_places_(sees_places), held_(robots) {}

void Hands::hold(std::size_t robot, Time let_go) {
  std::optional<Time>& until = held_[robot].until;
  until = std::max(until.value_or(Time::min()), let_go + kSettles);
}

void Hands::move(std::size_t robot, Time let_go, Time now) {
  if (held_[robot].let_go == let_go) return;
  held_[robot].let_go = let_go;
  hold(robot, std::min(let_go, now + kLongest));
}

void Hands::step(Time now, const std::vector<std::optional<Vec2>>& places_m, double touching_m) {
  now_ = now;
  for (Held& held : held_) {
    if (!held.until) continue;
    held.until = std::min(*held.until, now + kLongest + kSettles);  // its clock may have been set back
    // Only who sees that it is back in its place knows.
    if (*held.until <= now && !sees_places_) held.until.reset();
  }
  std::erase_if(pushes_, [&](const Push& push) {
    const auto &by = places_m[push.by], &of = places_m[push.of];
    return !by || !of || (*by - *of).norm() > touching_m;
  });
  for (const Push& push : pushes_) {
    if (are_on(push.by)) hold(push.of, now);
  }
}

bool Hands::touch(std::optional<std::size_t> first, std::optional<std::size_t> second) {
  const bool by_first = first && are_on(*first), by_second = second && are_on(*second);
  if (first && second && by_first != by_second) {
    const Push push = by_first ? Push{*first, *second} : Push{*second, *first};
    hold(push.of, now_);
    pushes_.push_back(push);
  }
  return by_first || by_second;
}

void Hands::see_in_place(std::size_t robot) {
  std::optional<Time>& until = held_[robot].until;
  if (until && *until <= now_) until.reset();
}

}  // namespace sidestep
