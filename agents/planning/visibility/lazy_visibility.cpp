// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/visibility/lazy_visibility.hpp"

#include <algorithm>

namespace sidestep {
namespace {

constexpr std::uint32_t kStart = 0, kGoal = 1;
constexpr std::uint32_t kNone = 0xffffffff;
constexpr double kHalf_rad = 3.14159265358979323846;
// A corner's arc is half a circle at most, or hardly more for who stands closer than ways keep off.
constexpr double kBack_rad = 3.2, kBack = -0.0584;

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
  found_.clear();
  arrivals_.clear();
  queue_.clear();
  candidates_.clear();
  bends_.assign({Bend{start}, Bend{domain.goal(start)}});
  last_.assign(4, kNone);
  discover(domain, start, domain.goal(start));
  arrivals_.push_back({kStart, Side::kLeft, {1, 0}, 0, 0, 0, 0, kNone});
  propose_all(0, kGoal);
}

/// Whether all ways were looked at.
bool LazyVisibility::search(const DiscDomain& domain, const Budget& budget) {
  while (!queue_.empty()) {
    if (budget.is_spent(arrivals_.size(), plan_.samples++)) return false;
    const Promise promise = take();
    Arrival next = candidates_[promise.candidate];
    if (next.corner_rad == 0) {
      const double promised_m = promise.cost_m + measure(next);
      if (!queue_.empty() && promised_m > queue_.front().cost_m) {
        candidates_[promise.candidate] = next;
        put({promised_m, promise.candidate});
        continue;
      }
    }
    if (is_served(domain, next) || !is_free(domain, next)) continue;
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
    propose_all(arrival, kGoal);
  }
  return true;
}

void LazyVisibility::propose_all(std::uint32_t arrival, std::uint32_t first_bend) {
  for (std::uint32_t bend = first_bend; bend < bends_.size(); ++bend) {
    if (bend == arrivals_[arrival].bend) continue;
    propose(arrival, bend, Side::kLeft);
    if (bend != kGoal) propose(arrival, bend, Side::kRight);
  }
}

void LazyVisibility::propose(std::uint32_t arrival, std::uint32_t bend, Side side) {
  const Arrival& at = arrivals_[arrival];
  const Bend &from = bends_[at.bend], &to = bends_[bend];
  if (has_no_tangent(from, at.side, to, side, 5 * settings_.stand_off_m)) return;
  const std::optional<Tangent> way = tangent(from, at.side, to, side, settings_.stand_off_m);
  if (!way) return;
  // Who stands closer to an edge than ways keep off it leaves at a small angle.
  const double slack = at.bend == kStart || bend == kGoal ? 2 * settings_.stand_off_m / way->length_m : 0;
  if (!to.holds(touching_direction(side, way->along), slack)) return;
  double turn = 0;
  if (at.bend != kStart) {
    if (!from.holds(touching_direction(at.side, way->along), slack)) return;
    // The chord is less than the arc; the arc is measured when that is promising.
    const double across = sign(at.side) * cross(at.along, way->along);
    const bool is_far = across < (at.along.dot(way->along) > 0 ? -1e-9 : kBack);
    // Nobody goes round a corner's back.
    if (from.is_corner && is_far) return;
    turn = is_far ? kHalf_rad : (way->along - at.along).norm();
  }
  const double cost = at.cost_m + from.radius_m * turn + way->length_m;
  const Vec2 there = touching_point(to, side, way->along) - bends_[kGoal].centre_m;
  put({cost + there.norm(), static_cast<std::uint32_t>(candidates_.size())});
  candidates_.push_back({bend, side, way->along, cost, turn, 0, arrival, kNone});
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
  std::push_heap(queue_.begin(), queue_.end(), costs_more);
}

LazyVisibility::Promise LazyVisibility::take() {
  std::pop_heap(queue_.begin(), queue_.end(), costs_more);
  const Promise promise = queue_.back();
  queue_.pop_back();
  return promise;
}

bool LazyVisibility::is_served(const DiscDomain& domain, const Arrival& next) {
  const Bend& bend = bends_[next.bend];
  std::uint32_t i = last_[place_of(next.bend, next.side)];
  for (; i != kNone; i = arrivals_[i].previous) {
    const double turn = turn_rad(next.side, arrivals_[i].along, next.along);
    if (bend.is_corner && turn > kBack_rad) continue;
    if (next.cost_m < arrivals_[i].cost_m + bend.radius_m * turn - 1e-9) continue;
    if (is_free_round(domain, arrivals_[i], turn, next.along, settings_.corner_rad)) return true;
  }
  return false;
}

bool LazyVisibility::is_free(const DiscDomain& domain, Arrival& next) {
  const Arrival& at = arrivals_[next.before];
  const Vec2 from = touching_point(bends_[at.bend], at.side, next.along);
  const Vec2 to = touching_point(bends_[next.bend], next.side, next.along);
  if (!is_free(domain, from, to)) return false;
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
  // Most ways that are looked at run into what is known.
  if (is_known(domain, from, to)) return false;
  if (domain.check(from, to)) return true;
  discover(domain, from, to);
  return false;
}

void LazyVisibility::discover(const DiscDomain& domain, const Vec2& from, const Vec2& to) {
  if (found_.size() == domain.world().size()) return;
  const std::optional<Contact> contact = domain.world().first_contact(from, to, domain.radius_m());
  if (!contact) return;
  const Shape& shape = domain.world().shape(contact->obstacle);
  const auto known = static_cast<std::uint32_t>(bends_.size());
  found_.push_back({grown(bounds(shape), domain.radius_m()), &shape});
  append_bends(shape, domain.radius_m() + settings_.stand_off_m, bends_);
  last_.resize(bends_.size() * 2, kNone);
  for (std::uint32_t arrival = 0; arrival < arrivals_.size(); ++arrival) propose_all(arrival, known);
}

bool LazyVisibility::is_known(const DiscDomain& domain, const Vec2& from, const Vec2& to) {
  const Segment way{from, to};
  const Box box{from.cwiseMin(to), from.cwiseMax(to)};
  const auto stops = [&](const Found& found) {
    if (!overlap(box, found.box)) return false;
    const auto* circle = std::get_if<Circle>(found.shape);
    const double reach_m = domain.radius_m() + (circle ? circle->radius_m : 0);
    return (circle ? squared_distance(circle->centre_m, way) : squared_distance(way, *found.shape)) <=
           reach_m * reach_m;
  };
  const auto first = std::find_if(found_.begin(), found_.end(), stops);
  if (first == found_.end()) return false;
  // What stopped one way often stops the next.
  std::swap(*first, found_.front());
  return true;
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
