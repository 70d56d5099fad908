// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/content_audit.hpp"

#include <algorithm>
#include <cmath>

#include "common/config/obstacle_list.hpp"

namespace sidestep {
namespace {

constexpr double kContinuityTolerance = 1e-7;  // in m and in m/s
constexpr double kSpeedTolerance_mps = 1e-5;
constexpr double kEffortTolerance = 2e-3;

/// The acceleration relative to the robot's limit: F forwards and sideways, D against the velocity.
double effort(const AuditPath::Node& n, const MotionLimits& limits) {
  const double f = limits.acceleration_mps2, d = limits.deceleration_mps2;
  const double speed = std::hypot(n.vx, n.vy), acceleration = std::hypot(n.ax, n.ay);
  if (speed < 1e-6) return acceleration / f;
  const double along = (n.ax * n.vx + n.ay * n.vy) / speed, across = (n.vx * n.ay - n.vy * n.ax) / speed;
  if (along >= 0) return acceleration / f;
  return std::sqrt(along * along / (d * d) + across * across / (f * f));
}

/// The largest effort in a phase. It occurs at an end, because the velocity turns towards the acceleration.
double largest_effort(const AuditPath::Node& begin, const AuditPath::Node& end, const MotionLimits& limits) {
  AuditPath::Node last = end;
  last.ax = begin.ax;
  last.ay = begin.ay;
  // At the end of a phase that brakes to rest, the velocity has no direction.
  const bool ends_at_rest = std::hypot(end.vx, end.vy) <= kSpeedTolerance_mps;
  return std::max(effort(begin, limits), ends_at_rest ? 0 : effort(last, limits));
}

}  // namespace

ContentAudit::ContentAudit(const AuditedRun& run, const RobotRecords& robots, AuditFindings& findings)
    : run_(run),
      robots_(robots),
      findings_(findings),
      obstacles_(run.scenario.obstacles.begin(), run.scenario.obstacles.end()) {}

void ContentAudit::check(const AuditedRobot& robot, KnownVersion& known) {
  check_limits(robot, known);
  check_against_base(robot, known);
}

void ContentAudit::check_against_base(const AuditedRobot& robot, KnownVersion& known) {
  // A version may leave the field, or come near obstacles, as far as its base does. A lifted robot's rest
  // version on base 0 has no base, and messages that show the lifting may have been missed.
  const bool may_rest = known.version.base() == 0 && known.path.reach_m() == 0;
  const KnownVersion* base = robots_.base_of(robot, known);
  if (!run_.is_complete() && (may_rest || !base)) return;
  known.is_content_checked = true;
  check_field(robot, known, base);
  check_obstacles(robot, known, base);
  check_base(robot, known);
}

void ContentAudit::check_limits(const AuditedRobot& robot, const KnownVersion& known) {
  for (int i = 0; i <= known.path.phase_count(); ++i) {
    const AuditPath::Node& n = known.path.phase(i);
    const double speed = std::hypot(n.vx, n.vy);
    const bool lasts = i < known.path.phase_count() && known.path.phase(i + 1).elapsed_s > n.elapsed_s;
    if (speed > run_.scenario.limits.speed_mps + kSpeedTolerance_mps) {
      findings_.report(AuditRule::kLimits, robot.id, &known, known.granted_in,
                       "{:.6f} m/s in phase {}; {:.6f} m/s allowed", speed, i,
                       run_.scenario.limits.speed_mps);
    } else if (lasts) {
      const double most = largest_effort(n, known.path.phase(i + 1), run_.scenario.limits);
      if (most <= 1 + kEffortTolerance) continue;
      findings_.report(AuditRule::kLimits, robot.id, &known, known.granted_in,
                       "acceleration ({:.4f}, {:.4f}) m/s2 in phase {} is {:.4f} times the limit", n.ax, n.ay,
                       i, most);
    }
  }
  const AuditPath::Node& end = known.path.last();
  if (std::hypot(end.vx, end.vy) > kSpeedTolerance_mps) {
    findings_.report(AuditRule::kRest, robot.id, &known, known.granted_in, "ends at {:.6f} m/s",
                     std::hypot(end.vx, end.vy));
  }
}

void ContentAudit::check_field(const AuditedRobot& robot, const KnownVersion& known,
                               const KnownVersion* base) {
  const double limit_x_m = run_.scenario.field.length_m / 2 - run_.scenario.radius_m + kLengthTolerance_m;
  const double limit_y_m = run_.scenario.field.width_m / 2 - run_.scenario.radius_m + kLengthTolerance_m;
  const auto distance_outside_m = [&](const AuditPath& path) {
    double most = 0;
    // A coordinate is extreme at the end of a phase or where its velocity changes sign.
    for (int i = 0; i <= path.phase_count(); ++i) {
      const AuditPath::Node& n = path.phase(i);
      for (const double turn : {0.0, n.ax != 0 ? -n.vx / n.ax : 0.0, n.ay != 0 ? -n.vy / n.ay : 0.0}) {
        // If the sign changes outside this phase, another point of the path is sampled, which does no harm.
        const AuditPath::Node p = path.at_s(n.elapsed_s + turn);
        most = std::max({most, std::abs(p.x) - limit_x_m, std::abs(p.y) - limit_y_m});
      }
    }
    return most;
  };
  // A robot that was pushed out of the field may return in several steps.
  const double allowed = base ? std::max(0.0, distance_outside_m(base->path) + kLengthTolerance_m) : 0;
  if (const double most = distance_outside_m(known.path); most > allowed) {
    findings_.report(AuditRule::kField, robot.id, &known, known.granted_in, "{:.6f} m outside the field",
                     most);
  }
}

void ContentAudit::check_obstacles(const AuditedRobot& robot, const KnownVersion& known,
                                   const KnownVersion* base) {
  for (std::size_t i = 0; i < obstacles_.size(); ++i)
    check_obstacle(robot, known, base, obstacles_[i], run_.scenario.obstacles[i], false);
  if (!run_.scenario.map) return;
  const double reach_m = known.path.reach_m() + required_separation_m(known);
  const Vec2 start_m(known.version.x_m(), known.version.y_m()), reach(reach_m, reach_m);
  run_.scenario.map->cells().for_each_box({start_m - reach, start_m + reach}, [&](const Box& cells) {
    check_obstacle(robot, known, base, AuditShape(cells), cells, true);
    return true;
  });
}

/// The base's distance from an obstacle, or from the whole map if the obstacle is part of it, because the
/// map's cells are split into boxes differently for each path.
double ContentAudit::distance_of_base_m(const KnownVersion& base, const AuditShape& obstacle, bool is_map,
                                        double required_m) const {
  double nearest_m = closest_approach(base.path, obstacle, required_m).distance_m;
  if (!is_map) return nearest_m;
  const Vec2 start_m(base.version.x_m(), base.version.y_m());
  const Vec2 reach = Vec2::Constant(base.path.reach_m() + required_m);
  run_.scenario.map->cells().for_each_box({start_m - reach, start_m + reach}, [&](const Box& cells) {
    nearest_m = std::min(nearest_m, closest_approach(base.path, AuditShape(cells), required_m).distance_m);
    return true;
  });
  return nearest_m;
}

void ContentAudit::check_obstacle(const AuditedRobot& robot, const KnownVersion& known,
                                  const KnownVersion* base, const AuditShape& obstacle, const Shape& shape,
                                  bool is_map) {
  const double required_m = required_separation_m(known);
  if (obstacle.distance_m(known.version.x_m(), known.version.y_m()) > required_m + known.path.reach_m())
    return;
  const ClosestApproach near = closest_approach(known.path, obstacle, required_m);
  if (near.distance_m >= required_m - kLengthTolerance_m - known.version.inflation_m()) return;
  const bool was_near =
      base && distance_of_base_m(*base, obstacle, is_map, required_m) <= near.distance_m + 1e-6;
  if (was_near) return;
  findings_.report(AuditRule::kObstacle, robot.id, &known, known.granted_in,
                   "{:.6f} m from the edge of the obstacle {}, {:.6f} m required", near.distance_m,
                   obstacle_text(shape), required_m);
}

void ContentAudit::check_base(const AuditedRobot& robot, const KnownVersion& known) {
  const KnownVersion* base = robot.find(known.version.base());
  if (known.number <= known.version.base()) {
    findings_.report(AuditRule::kVersionOrder, robot.id, &known, known.granted_in,
                     "its base, version {}, is not numbered below it", known.version.base());
  }
  const bool is_rest_version = known.version.base() == 0 && known.path.reach_m() == 0;
  const bool is_absent = (robot.last_report && robot.last_report->is_lifted) ||
                         (robot.registered && robot.registered->is_absent);
  if (is_rest_version && is_absent) return;
  const bool is_evicted = robot.was_evicted(known.version.base());
  if (run_.is_complete() && !is_evicted &&
      !(base && (base->may_be_in(known.granted_in) || base->is_own_stop))) {
    findings_.report(AuditRule::kBase, robot.id, &known, known.granted_in,
                     "its base, version {}, was neither registered nor granted in the epoch",
                     known.version.base());
  }
  if (!base || !base->has_content) return;
  const AuditPath::Node& from = known.path.first();
  const AuditPath::Node expected = base->path.at_ns(known.path.start_ns());
  const double jump_m = std::hypot(from.x - expected.x, from.y - expected.y);
  const double jump_mps = std::hypot(from.vx - expected.vx, from.vy - expected.vy);
  const bool is_continuous = jump_m <= kContinuityTolerance && jump_mps <= kContinuityTolerance;
  if (known.path.start_ns() <= base->path.start_ns() || !is_continuous) {
    findings_.report(
        AuditRule::kContinuity, robot.id, &known, known.granted_in,

        "starts {:.9f} m and {:.9f} m/s off its base, version {}, {:.6f} s after its base's start", jump_m,
        jump_mps, base->number, static_cast<double>(known.path.start_ns() - base->path.start_ns()) * 1e-9);
  }
  const bool begins_at_rest = from.vx == 0 && from.vy == 0 && known.version.inflation_m() == 0;
  if (known.version.inflation_m() != base->version.inflation_m() && !begins_at_rest) {
    findings_.report(AuditRule::kInflation, robot.id, &known, known.granted_in,
                     "has an inflation of {:.6f} m; its base has {:.6f} m", known.version.inflation_m(),
                     base->version.inflation_m());
  }
}

}  // namespace sidestep
