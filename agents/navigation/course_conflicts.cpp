// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/course_conflicts.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {
namespace {

constexpr std::size_t kMaxKnown = 4096;  ///< number of results that are remembered

}  // namespace

std::optional<Time> CourseConflicts::first_after(const DrivingCourse& a, const DrivingCourse& b, Time from) {
  if (a.robot > b.robot) return first_after(b, a, from);
  if (known_.size() > kMaxKnown) known_.clear();
  Known& known = known_[std::uint64_t{a.robot} << 32 | b.robot];
  const Version of_a{a.planned_at, a.start}, of_b{b.planned_at, b.start};
  const bool is_known = known.a == of_a && known.b == of_b && known.searched_from &&
                        *known.searched_from <= from && (!known.first || *known.first >= from);
  if (!is_known) known = {of_a, of_b, from, search(a, b, from)};
  return known.first;
}

std::optional<Time> CourseConflicts::search(const DrivingCourse& a, const DrivingCourse& b, Time from) const {
  // Nobody knows where a robot will be after the end of a course that it will continue.
  Time end = std::max(a.end(), b.end());
  if (a.continues) end = std::min(end, a.end());
  if (b.continues) end = std::min(end, b.end());
  // Robots that rest at last are compared at rest, too.
  if (!a.continues && !b.continues) end = std::max(end + DrivingCourse::kSample, from);
  for (Time t = from; t <= end; t += DrivingCourse::kSample)
    if ((a.position_at(t) - b.position_at(t)).squaredNorm() < separation_m_ * separation_m_) return t;
  return std::nullopt;
}

}  // namespace sidestep
