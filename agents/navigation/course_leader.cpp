// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/course_leader.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "agents/navigation/right_of_way.hpp"

namespace sidestep {
namespace {

/// A robot plans for the same group for this long, even if its own course conflicts with none of them any
/// more.
constexpr Duration kLeads{300'000'000};
/// An offer that has not been taken after this time counts no more.
constexpr Duration kOfferLife{200'000'000};
constexpr std::size_t kOffersPerCycle = 4;
/// No further course is planned in a cycle after this effort: messages wait meanwhile.
constexpr std::size_t kMaxOfferEffort = 3'000;
/// Courses are offered to robots whose goals are at most this many times as far away as those for which they
/// search themselves.
constexpr double kReaches = 2;

/// Nobody knows the speed limits of other robots, but they drive as fast as they may where there is room.
MotionLimits limits_of(const DrivingCourse& course, MotionLimits limits) {
  double fastest_mps = 0;
  for (const State& state : course.states) fastest_mps = std::max(fastest_mps, state.velocity_mps.norm());
  limits.speed_mps = std::min(limits.speed_mps, fastest_mps);
  return limits;
}

bool contains(std::span<const std::size_t> group, std::size_t i) {
  return std::ranges::find(group, i) != group.end();
}

}  // namespace

std::span<const CourseOffer> CourseLeader::plan(const Query& query, Rng& rng) {
  offers_.clear();
  collect_others(query);
  const std::vector<std::size_t> group = find_group(query);
  if (group.empty()) return offers_;
  remember_group(query, group);
  offer_courses(query, group, rng);
  for (const CourseOffer& offer : offers_) {
    std::erase_if(made_, [&](const Made& made) { return made.offer.course.robot == offer.course.robot; });
    made_.push_back({offer, query.start});
  }
  return offers_;
}

void CourseLeader::give_up() {
  led_.clear();
  leads_until_ = {};
  made_.clear();
}

void CourseLeader::collect_others(const Query& query) {
  std::erase_if(made_,
                [&](const Made& made) { return std::chrono::abs(query.start - made.made_at) > kOfferLife; });
  others_.clear();
  for (const DrivingCourse* other : query.others) {
    const auto made = std::ranges::find_if(made_, [&](const Made& own) {
      return own.offer.course.robot == other->robot && own.offer.replaces == other->planned_at;
    });
    others_.push_back({other, made == made_.end() ? other : &made->offer.course});
  }
}

std::vector<std::size_t> CourseLeader::find_group(const Query& query) {
  std::vector<std::size_t> group;
  if (query.start < leads_until_)
    for (std::size_t i = 0; i < others_.size(); ++i)
      if (std::ranges::find(led_, others_[i].known->robot) != led_.end() &&
          precedes(query.own, *others_[i].course))
        group.push_back(i);
  bool has_conflict = false;
  // Adds the robots whose courses conflict with that of a member. Returns false if one of them leads.
  const auto add_conflicts = [&](const DrivingCourse& member) {
    for (std::size_t i = 0; i < others_.size(); ++i) {
      const DrivingCourse& other = *others_[i].course;
      const bool is_member = contains(group, i);
      if (other.robot == member.robot || (is_member && has_conflict)) continue;
      if (!conflicts_.first_after(member, other, query.start)) continue;
      has_conflict = true;
      if (is_member) continue;
      if (precedes(other, query.own)) return false;
      group.push_back(i);
    }
    return true;
  };
  bool leads = add_conflicts(query.own);
  for (std::size_t k = 0; k < group.size() && leads; ++k) leads = add_conflicts(*others_[group[k]].course);
  if (!leads || !has_conflict) return {};
  std::ranges::sort(
      group, [&](std::size_t a, std::size_t b) { return precedes(*others_[a].course, *others_[b].course); });
  return group;
}

void CourseLeader::remember_group(const Query& query, std::span<const std::size_t> group) {
  if (query.start >= leads_until_) {
    led_.clear();
    leads_until_ = query.start + kLeads;
  }
  for (const std::size_t i : group)
    if (std::ranges::find(led_, others_[i].known->robot) == led_.end())
      led_.push_back(others_[i].known->robot);
}

void CourseLeader::offer_courses(const Query& query, std::span<const std::size_t> group, Rng& rng) {
  const Time start = query.start + kOfferLead;
  const std::size_t effort_before = search_.effort();
  std::vector<const DrivingCourse*> planned_for{&query.own};  // courses that all later ones avoid
  offers_.reserve(kOffersPerCycle);
  for (const std::size_t i : group) {
    const DrivingCourse& course = *others_[i].course;
    std::vector<const DrivingCourse*> avoided = planned_for, later;
    for (std::size_t k = 0; k < others_.size(); ++k)
      if (!contains(group, k))
        (precedes(course, *others_[k].course) ? later : avoided).push_back(others_[k].course);
    const bool is_free = std::ranges::none_of(avoided, [&](const DrivingCourse* other) {
      return conflicts_.first_after(*other, course, query.start).has_value();
    });
    if (is_free) {
      planned_for.push_back(&course);
      continue;
    }
    if (offers_.size() == kOffersPerCycle || search_.effort() - effort_before > kMaxOfferEffort) return;
    const CourseTask task{course.robot, course.state_at(start), course.goal_m(),
                          limits_of(course, query.limits)};
    const Vec2 way_m = task.goal_m - task.at_start.position_m;
    if (way_m.cwiseAbs().maxCoeff() > kReaches * CourseSearch::reach_m(task.limits.speed_mps)) continue;
    CourseObstruction obstruction(start);
    obstruction.add_staying(query.staying_m);
    obstruction.add_leaving(query.leaving_m);
    for (const DrivingCourse* other : avoided) obstruction.add(*other);
    for (const DrivingCourse* other : later) obstruction.add_leaving(other->position_at(start));
    std::optional<DrivingCourse> planned = search_.find(task, obstruction, rng);
    if (!planned) continue;
    planned->continues = course.continues;
    planned->due = course.due;
    offers_.push_back({std::move(*planned), others_[i].known->planned_at, query.own.robot});
    planned_for.push_back(&offers_.back().course);
  }
}

}  // namespace sidestep
