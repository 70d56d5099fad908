// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/visibility/lazy_visibility.hpp"

#include <algorithm>

#include "agents/planning/visibility/both_sides.hpp"

namespace sidestep {
namespace {

constexpr std::uint32_t kStart = 0, kGoal = 1, kObstacles = 2;
constexpr std::uint32_t kNone = 0xffffffff;
constexpr double kHalf_rad = 3.14159265358979323846;
// A corner's arc is half a circle at most, or hardly more for who stands closer than ways keep off.
constexpr double kBack_rad = 3.2, kBack = -0.0584;

/// Hardly less than the angles from a direction, where they are at most right ones: the series of arcs by
/// their chords.
BothSides least_turns_rad(const Vec2& from, const BothDirections& to) {
  const BothSides chord2 = (to.x - from.x()).square() + (to.y - from.y()).square();
  return chord2.sqrt() * (1 + chord2 * (1.0 / 24 + chord2 * (3.0 / 640 + chord2 * (5.0 / 7168))));
}

std::size_t place_of(std::uint32_t bend, Side side) { return 2 * bend + (side == Side::kLeft ? 0 : 1); }

}  // namespace

const Plan<Vec2>& LazyVisibility::plan(const DiscDomain& domain, const Vec2& start, const Budget& budget,
                                       Rng&) {
  begin_plan(domain, start, plan_);
  if (plan_straight(domain, start, plan_)) return plan_;
  if (plan_.start_blocked) {
    plan_out(domain, start, budget);
  } else {
    plan_from(domain, start, budget);
  }
  plan_.length = length_of(domain, plan_.states);
  return plan_;
}

void LazyVisibility::plan_from(const DiscDomain& domain, const Vec2& start, const Budget& budget) {
  begin(domain, start);
  const bool ended = search(domain, budget);
  plan_.nodes = arrivals_.size();
  if (plan_.arrives()) return;
  plan_.reason = ended ? PlanReason::kUnreachable : PlanReason::kBudgetSpent;
  std::uint32_t nearest = 0;
  const auto to_goal = [&](const Arrival& arrival) {
    const Vec2 at = touching_point(bends_[arrival.bend], arrival.side, arrival.along);
    return domain.distance(at, bends_[kGoal].centre_m);
  };
  for (std::uint32_t i = 1; i < arrivals_.size(); ++i)
    if (to_goal(arrivals_[i]) < to_goal(arrivals_[nearest])) nearest = i;
  write_plan(nearest);
}

void LazyVisibility::plan_out(const DiscDomain& domain, const Vec2& start, const Budget& budget) {
  const std::optional<Vec2> exit = domain.exit();
  if (!exit) {
    plan_.reason = PlanReason::kUnreachable;
    plan_.states.assign(1, start);
    return;
  }
  if (!plan_straight(domain, *exit, plan_)) plan_from(domain, *exit, budget);
  // The first state that the start can make for takes the exit's place.
  std::size_t first = plan_.states.size() - 1;
  while (first > 0 && !domain.check(start, plan_.states[first])) --first;
  plan_.states.erase(plan_.states.begin(), plan_.states.begin() + static_cast<std::ptrdiff_t>(first));
  plan_.states.insert(plan_.states.begin(), start);
}

void LazyVisibility::begin(const DiscDomain& domain, const Vec2& start) {
  known_.clear(domain.radius_m());
  arrivals_.clear();
  queue_.clear();
  candidates_.clear();
  bends_.assign({Bend{start}, Bend{domain.goal(start)}});
  last_.assign(4, kNone);
  is_hidden_.assign(kObstacles, false);
  discover(domain, start, domain.goal(start));
  arrivals_.push_back({kStart, Side::kLeft, {1, 0}, 0, 0, 0, 0, kNone});
  propose_all(domain, 0, kGoal);
}

/// Whether all ways were looked at.
bool LazyVisibility::search(const DiscDomain& domain, const Budget& budget) {
  while (!queue_.empty()) {
    if (budget.is_spent(arrivals_.size(), plan_.samples++)) return false;
    const Promise promise = take();
    Arrival next = candidates_[promise.candidate];
    if (next.corner_rad == 0) {
      // Most ways that are promising run into something.
      if (!is_free_straight(domain, next)) continue;
      const double promised_m = promise.cost_m + measure(next);
      if (!queue_.empty() && promised_m > queue_.front().cost_m) {
        candidates_[promise.candidate] = next;
        put({promised_m, promise.candidate});
        continue;
      }
    }
    if (is_served(domain, next) || !is_free_round(domain, next)) continue;
    const auto arrival = static_cast<std::uint32_t>(arrivals_.size());
    std::uint32_t& last = last_[place_of(next.bend, next.side)];
    next.previous = last;
    last = arrival;
    arrivals_.push_back(next);
    if (next.bend == kGoal) {
      plan_.reason = PlanReason::kSolved;
      write_plan(arrival);
      return true;
    }
    propose_all(domain, arrival, kGoal);
  }
  return true;
}

void LazyVisibility::propose_all(const DiscDomain& domain, std::uint32_t arrival, std::uint32_t first_bend) {
  const Arrival at = arrivals_[arrival];
  Bend from = bends_[at.bend];
  // Nobody goes round a corner's back.
  if (from.is_corner)
    (at.side == Side::kLeft ? from.first : from.last) = touching_direction(at.side, at.along);
  likely_.resize(bends_.size() - first_bend);
  std::size_t count = 0;
  for (std::uint32_t bend = first_bend; bend < bends_.size(); ++bend) {
    likely_[count] = bend;
    count += bend != at.bend && is_hidden_[bend] == 0 &&
             may_have_tangent(from, at.side, bends_[bend], 5 * settings_.stand_off_m);
  }
  for (std::size_t i = 0; i < count; ++i) propose(domain, arrival, from, likely_[i]);
}

void LazyVisibility::propose(const DiscDomain& domain, std::uint32_t arrival, const Bend& from,
                             std::uint32_t bend) {
  const Arrival& at = arrivals_[arrival];
  const Bend& to = bends_[bend];
  const Tangents ways = tangents(from, at.side, to, settings_.stand_off_m);
  const BothSides from_sides = BothSides::Constant(sign(at.side));
  BothSides room = within(from, from_sides, ways.along).min(within(to, kSigns, ways.along)) + 1e-9;
  // Who stands closer to an edge than ways keep off it leaves at a small angle.
  if (at.bend == kStart || bend == kGoal) room += 2 * settings_.stand_off_m / ways.length_m;
  const BothSides across = from_sides * cross(at.along, ways.along), ahead = dot(at.along, ways.along);
  const BothSides turns_rad = least_turns_rad(at.along, ways.along);
  const BothSides x_m = to.centre_m.x() + kSigns * to.radius_m * ways.along.y;
  const BothSides y_m = to.centre_m.y() - kSigns * to.radius_m * ways.along.x;
  const Vec2& goal = bends_[kGoal].centre_m;
  const BothSides to_goal_m = ((x_m - goal.x()).square() + (y_m - goal.y()).square()).sqrt();
  for (Eigen::Index lane = 0; lane < (bend == kGoal ? 1 : 2); ++lane) {
    if (!ways.exist[lane] || !(room[lane] >= 0)) continue;
    const bool is_far = at.bend != kStart && across[lane] < (ahead[lane] > 0 ? -1e-9 : kBack);
    if (from.is_corner && is_far) continue;
    const Vec2 there(x_m[lane], y_m[lane]);
    if (!domain.field().contains(there, domain.radius_m())) continue;
    const double turn = is_far ? kHalf_rad : turns_rad[lane];
    const double cost = at.cost_m + from.radius_m * turn + ways.length_m[lane];
    put({cost + to_goal_m[lane], static_cast<std::uint32_t>(candidates_.size())});
    candidates_.push_back({bend, side_of(lane), ways.along.at(lane), cost, turn, 0, arrival, kNone});
  }
}

double LazyVisibility::measure(Arrival& next) const {
  next.corner_rad = settings_.corner_rad;
  const Arrival& at = arrivals_[next.before];
  if (at.bend == kStart) return 0;
  const double turn = turn_rad(at.side, at.along, next.along);
  const double more_m = bends_[at.bend].radius_m * (turn - next.turn_rad);
  next.turn_rad = turn;
  next.cost_m += more_m;
  return more_m;
}

void LazyVisibility::put(const Promise& promise) {
  queue_.push_back(promise);
  std::push_heap(queue_.begin(), queue_.end(), CostsMore());
}

LazyVisibility::Promise LazyVisibility::take() {
  std::pop_heap(queue_.begin(), queue_.end(), CostsMore());
  const Promise promise = queue_.back();
  queue_.pop_back();
  return promise;
}

bool LazyVisibility::is_served(const DiscDomain& domain, const Arrival& next) {
  const Bend bend = bends_[next.bend];
  std::uint32_t i = last_[place_of(next.bend, next.side)];
  for (; i != kNone; i = arrivals_[i].previous) {
    const double turn = turn_rad(next.side, arrivals_[i].along, next.along);
    if (bend.is_corner && turn > kBack_rad) continue;
    if (next.cost_m < arrivals_[i].cost_m + bend.radius_m * turn - 1e-9) continue;
    if (is_free_round(domain, arrivals_[i], turn, next.along, settings_.corner_rad)) return true;
  }
  return false;
}

bool LazyVisibility::is_free_straight(const DiscDomain& domain, const Arrival& next) {
  const Arrival& at = arrivals_[next.before];
  const Vec2 from = touching_point(bends_[at.bend], at.side, next.along);
  return is_free(domain, from, touching_point(bends_[next.bend], next.side, next.along));
}

bool LazyVisibility::is_free_round(const DiscDomain& domain, Arrival& next) {
  const Arrival& at = arrivals_[next.before];
  if (is_free_round(domain, at, next.turn_rad, next.along, next.corner_rad)) return true;
  // Small corners keep closer to the bend.
  next.corner_rad = settings_.corner_rad / 8;
  return is_free_round(domain, at, next.turn_rad, next.along, next.corner_rad);
}

bool LazyVisibility::is_free_round(const DiscDomain& domain, const Arrival& at, double turn_rad,
                                   const Vec2& along, double corner_rad) {
  if (bends_[at.bend].radius_m == 0 || turn_rad == 0) return true;
  corners_.assign(1, touching_point(bends_[at.bend], at.side, at.along));
  append_corners(bends_[at.bend], at.side, at.along, turn_rad, corner_rad, corners_);
  corners_.push_back(touching_point(bends_[at.bend], at.side, along));
  for (std::size_t i = 1; i < corners_.size(); ++i)
    if (!is_free(domain, corners_[i - 1], corners_[i])) return false;
  return true;
}

bool LazyVisibility::is_free(const DiscDomain& domain, const Vec2& from, const Vec2& to) {
  const Segment way{from, to};
  if (known_.stop_again(way)) return false;
  if (domain.check(from, to)) return true;
  if (!known_.stop(way)) discover(domain, from, to);
  return false;
}

void LazyVisibility::discover(const DiscDomain& domain, const Vec2& from, const Vec2& to) {
  if (known_.size() == domain.world().size()) return;
  const std::optional<Contact> contact = domain.world().first_contact(from, to, domain.radius_m());
  if (!contact) return;
  const Shape& shape = domain.world().shape(contact->obstacle);
  const auto first_bend = static_cast<std::uint32_t>(bends_.size());
  append_bends(shape, domain.radius_m() + settings_.stand_off_m, bends_);
  known_.add(shape);
  hide_corners(domain.field(), first_bend);
  last_.resize(bends_.size() * 2, kNone);
  for (std::uint32_t arrival = 0; arrival < arrivals_.size(); ++arrival)
    propose_all(domain, arrival, first_bend);
}

void LazyVisibility::hide_corners(const Field& field, std::size_t first_bend) {
  const std::size_t obstacle = known_.size() - 1;
  for (std::size_t i = first_bend; i < bends_.size(); ++i) {
    const Bend& bend = bends_[i];
    is_hidden_.push_back(bend.is_corner && (known_.hold(bend.centre_m, 0, obstacle) ||
                                            !field.contains(bend.centre_m, kTouching_m)));
  }
  // Of corners at the same place, one counts.
  const auto is_there_anyway = [&](const Bend& bend) {
    for (std::size_t i = first_bend; i < bends_.size(); ++i)
      if (is_hidden_[i] != 0 && (bends_[i].centre_m - bend.centre_m).norm() < 2 * kTouching_m) return true;
    return false;
  };
  for (std::size_t i = kObstacles; i < first_bend; ++i)
    if (bends_[i].is_corner && known_.hold(bends_[i].centre_m, obstacle, obstacle + 1) &&
        !is_there_anyway(bends_[i]))
      is_hidden_[i] = true;
}

void LazyVisibility::write_plan(std::uint32_t arrival) {
  way_.clear();
  for (; arrival != 0; arrival = arrivals_[arrival].before) way_.push_back(arrival);
  plan_.states.assign(1, bends_[kStart].centre_m);
  Arrival last = arrivals_[0];
  for (std::size_t i = way_.size(); i-- > 0;) {
    const Arrival& next = arrivals_[way_[i]];
    if (last.bend != kStart) {
      append_corners(bends_[last.bend], last.side, last.along, next.turn_rad, next.corner_rad, plan_.states);
    }
    last = next;
  }
  if (last.bend != kStart || way_.empty())
    plan_.states.push_back(touching_point(bends_[last.bend], last.side, last.along));
}

std::vector<Segment> LazyVisibility::ways() const {
  std::vector<Segment> ways;
  for (std::size_t i = 1; i < arrivals_.size(); ++i) {
    const Arrival &to = arrivals_[i], &from = arrivals_[to.before];
    ways.push_back({touching_point(bends_[from.bend], from.side, to.along),
                    touching_point(bends_[to.bend], to.side, to.along)});
  }
  return ways;
}

}  // namespace sidestep
