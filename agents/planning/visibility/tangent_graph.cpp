// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/visibility/tangent_graph.hpp"

#include <algorithm>

namespace sidestep {
namespace {

constexpr double kTangentStandoff_m = 1e-7;  ///< clearance beyond the disc's radius
constexpr double kTangentTurn_rad = 0.02;    ///< maximum turn at a vertex of the path

constexpr std::uint32_t kStart = 0, kGoal = 1, kObstacles = 2;
constexpr double kFar = std::numeric_limits<double>::infinity();

double angle_on(Side side, const Vec2& along) { return sign(side) * std::atan2(along.y(), along.x()); }

}  // namespace

TangentGraph::TangentGraph(const ObstacleWorld& world, const Field& field, double radius_m)
    : domain_(world, field, radius_m, {0, 0}, {0, 0}), arcs_(kObstacles) {
  for (const ObstacleId id : world.obstacles())
    append_arcs(world.shape(id), radius_m + kTangentStandoff_m, arcs_);
  for (std::uint32_t a = kObstacles; a < arcs_.size(); ++a)
    for (std::uint32_t b = a + 1; b < arcs_.size(); ++b) join(a, b);
  world_nodes_ = nodes_.size();
}

Vec2 TangentGraph::position_of(const Node& node) const {
  return tangent_point(arc_of(node.ring), side_of(node.ring), node.along);
}

bool TangentGraph::is_free(const Vec2& from, const Vec2& to) const {
  const double radius_m = domain_.radius_m();
  return domain_.field().contains(from, radius_m) && domain_.field().contains(to, radius_m) &&
         !domain_.world().touches(from, to, radius_m);
}

void TangentGraph::join(std::uint32_t a, std::uint32_t b) {
  for (const Side a_side : {Side::kLeft, Side::kRight}) {
    for (const Side b_side : {Side::kLeft, Side::kRight}) {
      // A start or goal has only one side.
      if ((a < kObstacles && a_side == Side::kRight) || (b < kObstacles && b_side == Side::kRight)) continue;
      join(a, a_side, b, b_side);
    }
  }
}

void TangentGraph::join(std::uint32_t a, Side a_side, std::uint32_t b, Side b_side) {
  const auto tangent_ab = tangent(arcs_[a], a_side, arcs_[b], b_side, kTangentStandoff_m);
  if (!tangent_ab) return;
  const bool a_contains =
      a < kObstacles || arcs_[a].contains(tangent_point_direction(a_side, tangent_ab->along));
  const bool b_contains =
      b < kObstacles || arcs_[b].contains(tangent_point_direction(b_side, tangent_ab->along));
  if (!a_contains || !b_contains) return;
  const Vec2 from = tangent_point(arcs_[a], a_side, tangent_ab->along);
  const Vec2 to = tangent_point(arcs_[b], b_side, tangent_ab->along);
  // Tangents of the world do not depend on the query, so they must not use the domain's exception for blocked
  // starts.
  const bool is_of_world = a >= kObstacles && b >= kObstacles;
  if (is_of_world ? !is_free(from, to) : !domain_.check(from, to)) return;
  add_tangent(ring_of(a, a_side), ring_of(b, b_side), *tangent_ab);
  const auto other = [](Side side) { return side == Side::kLeft ? Side::kRight : Side::kLeft; };
  if (a == kStart || b == kGoal) return;
  add_tangent(ring_of(b, other(b_side)), ring_of(a, other(a_side)),
              {-tangent_ab->along, tangent_ab->length_m});
}

void TangentGraph::add_tangent(std::uint32_t from, std::uint32_t to, const Tangent& tangent) {
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back(
      {from, tangent.along, angle_on(side_of(from), tangent.along), first + 1, tangent.length_m, true});
  nodes_.push_back({to, tangent.along, angle_on(side_of(to), tangent.along)});
}

void TangentGraph::sort_rings() {
  rings_.resize(2 * arcs_.size());
  for (auto& ring : rings_) ring.clear();
  for (std::uint32_t node = 0; node < nodes_.size(); ++node) rings_[nodes_[node].ring].push_back(node);
  index_in_ring_.resize(nodes_.size());
  for (auto& ring : rings_) {
    std::sort(ring.begin(), ring.end(),
              [&](std::uint32_t a, std::uint32_t b) { return nodes_[a].angle_rad < nodes_[b].angle_rad; });
    for (std::uint32_t i = 0; i < ring.size(); ++i) index_in_ring_[ring[i]] = i;
  }
}

const Plan<Vec2>& TangentGraph::plan(const Vec2& start, const Vec2& goal) {
  domain_ = DiscDomain(domain_.world(), domain_.field(), domain_.radius_m(), start, goal);
  begin_plan(domain_, start, plan_);
  if (plan_straight(domain_, start, plan_)) {
    shortest_m_ = plan_.length;
    return plan_;
  }
  nodes_.resize(world_nodes_);
  arcs_[kStart] = {start};
  arcs_[kGoal] = {goal};
  for (std::uint32_t arc = kObstacles; arc < arcs_.size(); ++arc) {
    join(kStart, arc);
    join(arc, kGoal);
  }
  sort_rings();
  search();
  return plan_;
}

void TangentGraph::relax(std::uint32_t from, std::uint32_t to, double length_m) {
  const double cost = labels_[from].cost_m + length_m;
  if (cost >= labels_[to].cost_m) return;
  labels_[to] = {cost, from, false};
  queue_.push_back({cost + (position_of(nodes_[to]) - arcs_[kGoal].centre_m).norm(), to});
  std::push_heap(queue_.begin(), queue_.end(), has_higher_estimate);
}

void TangentGraph::search() {
  labels_.assign(nodes_.size(), {kFar, 0, false});
  queue_.clear();
  plan_.reason = PlanReason::kUnreachable;
  shortest_m_ = kFar;
  plan_.states.assign(1, arcs_[kStart].centre_m);
  for (const std::uint32_t node : rings_[ring_of(kStart, Side::kLeft)]) {
    labels_[node] = {0, node, false};
    queue_.push_back({nodes_[node].length_m, node});
  }
  std::make_heap(queue_.begin(), queue_.end(), has_higher_estimate);
  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end(), has_higher_estimate);
    const std::uint32_t node = queue_.back().node;
    queue_.pop_back();
    if (labels_[node].is_done) continue;
    labels_[node].is_done = true;
    ++plan_.nodes;
    if (nodes_[node].ring == ring_of(kGoal, Side::kLeft)) {
      plan_.reason = PlanReason::kSolved;
      shortest_m_ = labels_[node].cost_m;
      return write_plan(node);
    }
    if (nodes_[node].leaves) relax(node, nodes_[node].to, nodes_[node].length_m);
    follow_ring(node);
  }
}

void TangentGraph::follow_ring(std::uint32_t node) {
  const Node& at = nodes_[node];
  if (at.ring < 2 * kObstacles) return;
  const auto& ring = rings_[at.ring];
  const std::uint32_t next = ring[(index_in_ring_[node] + 1) % ring.size()];
  if (next == node || labels_[next].is_done) return;
  const TangentArc& arc = arc_of(at.ring);
  const double turn = turn_rad(side_of(at.ring), at.along, nodes_[next].along);
  if (arc.is_corner && turn > 3.2) return;
  vertices_.assign(1, position_of(at));
  append_vertices(arc, side_of(at.ring), at.along, turn, kTangentTurn_rad, vertices_);
  vertices_.push_back(position_of(nodes_[next]));
  for (std::size_t i = 1; i < vertices_.size(); ++i)
    if (!domain_.check(vertices_[i - 1], vertices_[i])) return;
  relax(node, next, arc.radius_m * turn);
}

void TangentGraph::write_plan(std::uint32_t node) {
  path_.assign(1, node);
  for (; labels_[node].parent != node; node = labels_[node].parent) path_.push_back(labels_[node].parent);
  for (std::size_t i = path_.size() - 1; i > 0; --i) {
    const Node &from = nodes_[path_[i]], &to = nodes_[path_[i - 1]];
    if (from.ring != to.ring) continue;
    const Side side = side_of(from.ring);
    append_vertices(arc_of(from.ring), side, from.along, turn_rad(side, from.along, to.along),
                    kTangentTurn_rad, plan_.states);
  }
  plan_.states.push_back(arcs_[kGoal].centre_m);
  plan_.length = length_of(domain_, plan_.states);
}

std::vector<Segment> TangentGraph::tangents() const {
  std::vector<Segment> segments;
  for (const Node& node : nodes_)
    if (node.leaves) segments.push_back({position_of(node), position_of(nodes_[node.to])});
  return segments;
}

}  // namespace sidestep
