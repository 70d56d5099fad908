// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/space_time_path.hpp"

#include <algorithm>

#include "agents/planning/joint/leg.hpp"

namespace sidestep {
namespace {

using Path = std::vector<SpaceTimeState>;

bool is_free(const SpaceTimeDomain& domain, const Path& path, std::size_t first) {
  for (std::size_t i = std::max<std::size_t>(first, 1); i < path.size(); ++i)
    if (!domain.check(path[i - 1], path[i])) return false;
  return true;
}

/// Removes the state `left_out` and moves everything after it to an earlier time, by all or part of the time
/// saved. Returns whether it succeeded.
bool remove_state(const SpaceTimeDomain& domain, Path& path, std::size_t left_out) {
  Path candidate = path;
  candidate.erase(candidate.begin() + static_cast<std::ptrdiff_t>(left_out));
  const Duration saved =
      candidate[left_out].at - domain.earliest_arrival(candidate[left_out - 1], candidate[left_out].at_m);
  if (saved < Duration{0}) return false;
  const Path unshifted = candidate;
  for (const int quarters : {4, 2, 1, 0}) {
    candidate = unshifted;
    for (std::size_t i = left_out; i < candidate.size(); ++i) candidate[i].at -= saved * quarters / 4;
    if (!is_free(domain, candidate, left_out)) continue;
    path = candidate;
    return true;
  }
  return false;
}

/// Moves the state `next` and everything after it to an earlier time, by the part of the wait before it that
/// can be skipped while the path stays free.
void shorten_wait(const SpaceTimeDomain& domain, Path& path, std::size_t next) {
  constexpr int kHalvings = 6;
  Duration step = path[next].at - domain.earliest_arrival(path[next - 1], path[next].at_m);
  Path candidate;
  for (int i = 0; i < kHalvings && step > Duration{0}; ++i) {
    candidate = path;
    for (std::size_t j = next; j < path.size(); ++j) candidate[j].at -= step;
    const bool has_time = candidate[next].at >= domain.earliest_arrival(path[next - 1], path[next].at_m);
    if (has_time && is_free(domain, candidate, next)) path = candidate;
    step /= 2;
  }
}

}  // namespace

void shorten(const SpaceTimeDomain& domain, std::vector<SpaceTimeState>& path) {
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    for (std::size_t i = 1; i + 1 < path.size();) {
      const bool is_left_out = remove_state(domain, path, i);
      has_changed = has_changed || is_left_out;
      if (!is_left_out) ++i;
    }
  }
  for (std::size_t i = 1; i < path.size(); ++i) shorten_wait(domain, path, i);
}

Course course_along(const std::vector<SpaceTimeState>& path, const MotionLimits& limits) {
  Course course(path.front().at, path.front().at_m);
  for (std::size_t i = 1; i < path.size(); ++i) {
    const SpaceTimeState &from = path[i - 1], &to = path[i];
    if (from.at_m == to.at_m) continue;
    const LegTimes times = leg_times((to.at_m - from.at_m).norm(), limits);
    course.append(make_leg(to.at - times.total(), from.at_m, to.at_m, times));
  }
  return course;
}

}  // namespace sidestep
