// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/hands.hpp"

#include <algorithm>

namespace sidestep {
namespace {

constexpr Duration kLongest{60'000'000'000};
// So long after it was let go it may still look as if it were in place.
constexpr Duration kSettles{1'000'000'000};

}  // namespace

Hands::Hands(std::size_t robots, Duration period, bool sees_places)
    : period_(period), sees_places_(sees_places), left_(robots) {}

void Hands::begin(std::size_t robot, Duration lasts) {
  left_[robot] = std::max(left_[robot].value_or(0), (lasts + kSettles) / period_);
}

void Hands::move(std::size_t robot, Duration lasts) {
  begin(robot, std::clamp(lasts, Duration{0}, kLongest));
}

bool Hands::touch(std::optional<std::size_t> first, std::optional<std::size_t> second) {
  const bool by_first = first && are_on(*first), by_second = second && are_on(*second);
  if (first && second && by_first != by_second) {
    const Push push = by_first ? Push{*first, *second} : Push{*second, *first};
    begin(push.of, Duration{0});
    pushes_.push_back(push);
  }
  return by_first || by_second;
}

void Hands::step(const std::vector<std::optional<Vec2>>& places_m, double touching_m) {
  for (std::optional<std::int64_t>& left : left_) {
    // Only who sees that it is back in its place knows.
    if (left && --*left <= 0 && !sees_places_) left.reset();
  }
  std::erase_if(pushes_, [&](const Push& push) {
    const auto &by = places_m[push.by], &of = places_m[push.of];
    return !by || !of || (*by - *of).norm() > touching_m;
  });
  for (const Push& push : pushes_) {
    if (are_on(push.by)) begin(push.of, Duration{0});
  }
}

void Hands::see_in_place(std::size_t robot) {
  if (left_[robot] && *left_[robot] <= 0) left_[robot].reset();
}

}  // namespace sidestep
