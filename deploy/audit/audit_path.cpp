// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/audit_path.hpp"

#include <algorithm>
#include <cmath>

#include "deploy/inspect/time_range.hpp"

namespace sidestep {
namespace {

constexpr double kMinStep_s = 0.00025;
constexpr int kMaxCheapSteps = 12;
constexpr double kMaxCoordinate_m = 1e4;
constexpr double kMaxSpeed_mps = 100;
constexpr double kMaxAcceleration_mps2 = 1000;
constexpr std::int64_t kMaxPhaseDuration_ns = 60'000'000'000;

bool within(double value, double bound) { return std::abs(value) <= bound; }

// All lengths here are far from overflow and underflow, so std::hypot is not needed.
double length(double x, double y) { return std::sqrt(x * x + y * y); }

/// Two paths on a common time axis.
struct Pair {
  const AuditPath& a;
  const AuditPath& b;
  double a_from_s, b_from_s;  ///< position of the common origin on each path's own time axis

  AuditPath::Node separation(double s) const {
    const AuditPath::Node p = a.at_s(a_from_s + s), q = b.at_s(b_from_s + s);
    return {s, p.x - q.x, p.y - q.y, p.vx - q.vx, p.vy - q.vy};
  }
  double distance(double s) const {
    const AuditPath::Node gap = separation(s);
    return length(gap.x, gap.y);
  }
  double end_s() const { return std::max({0.0, a.duration_s() - a_from_s, b.duration_s() - b_from_s}); }
  /// The relative velocity is linear between phase boundaries, so its maximum lies at a boundary. Both sides
  /// of each boundary are sampled, because a path that ends with residual speed rests immediately afterwards.
  double max_relative_speed() const {
    double largest = 0;
    const auto sample = [&](const AuditPath& path, double from_s) {
      for (int i = 0; i <= path.phase_count(); ++i) {
        const double s = path.phase(i).elapsed_s - from_s;
        for (const double t : {s - 1e-9, s + 1e-9}) {
          const AuditPath::Node gap = separation(std::max(t, 0.0));
          largest = std::max(largest, length(gap.vx, gap.vy));
        }
      }
    };
    sample(a, a_from_s);
    sample(b, b_from_s);
    return largest;
  }
};

ClosestApproach closest_approach_of(const Pair& pair, double cutoff_m, std::int64_t from_ns) {
  const double end = pair.end_s();
  double best = pair.distance(0), best_s = 0;
  if (best - cutoff_m > end * (pair.a.max_speed_mps() + pair.b.max_speed_mps())) return {best, from_ns};
  // The sum of the maximum speeds is a cheap bound, with which a few steps suffice for most pairs.
  double speed = pair.a.max_speed_mps() + pair.b.max_speed_mps() + 1e-9;
  const auto sample = [&](double s) {
    const double d = pair.distance(s);
    if (d < best) best = d, best_s = s;
    return d;
  };
  int steps = 0;
  for (double s = 0, d = best; s < end; d = sample(s)) {
    if (++steps == kMaxCheapSteps) speed = pair.max_relative_speed() * (1 + 1e-9) + 1e-9;
    s = std::min(end, s + std::max(kMinStep_s, (d - cutoff_m) / speed));
  }
  if (best < cutoff_m + speed * kMinStep_s) {
    for (double step = kMinStep_s / 16; step > 1e-8; step /= 16) {
      const double centre = best_s;
      for (int i = -16; i <= 16; ++i) sample(std::clamp(centre + i * step, 0.0, end));
    }
  }
  return {best, from_ns + static_cast<std::int64_t>(best_s * 1e9)};
}

}  // namespace

bool is_sane(const msg::Version& version) {
  bool sane = version.phase_count() <= msg::MAX_PHASES && is_valid_time(version.start_ns()) &&
              within(version.x_m(), kMaxCoordinate_m) && within(version.y_m(), kMaxCoordinate_m) &&
              within(version.vx_mps(), kMaxSpeed_mps) && within(version.vy_mps(), kMaxSpeed_mps) &&
              version.inflation_m() >= 0 && version.inflation_m() <= 10;
  for (int i = 0; sane && i < version.phase_count(); ++i) {
    const msg::MotionPhase& phase = version.phases()[static_cast<std::size_t>(i)];
    sane = phase.duration_ns() >= 0 && phase.duration_ns() <= kMaxPhaseDuration_ns &&
           within(phase.ax_mps2(), kMaxAcceleration_mps2) && within(phase.ay_mps2(), kMaxAcceleration_mps2);
  }
  return sane;
}

AuditPath::AuditPath(const msg::Version& version)
    : start_ns_(version.start_ns()), count_(version.phase_count()) {
  nodes_[0] = {0, version.x_m(), version.y_m(), version.vx_mps(), version.vy_mps()};
  for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) {
    const msg::MotionPhase& phase = version.phases()[i];
    nodes_[i].ax = phase.ax_mps2();
    nodes_[i].ay = phase.ay_mps2();
    const double t = static_cast<double>(phase.duration_ns()) * 1e-9;
    const Node& n = nodes_[i];
    nodes_[i + 1] = {n.elapsed_s + t, n.x + n.vx * t + n.ax * t * t / 2, n.y + n.vy * t + n.ay * t * t / 2,
                     n.vx + n.ax * t, n.vy + n.ay * t};
    const double max_phase_speed = std::max(length(n.vx, n.vy), length(nodes_[i + 1].vx, nodes_[i + 1].vy));
    reach_m_ += t * max_phase_speed;
    max_speed_mps_ = std::max(max_speed_mps_, max_phase_speed);
  }
}

AuditPath::Node AuditPath::at_s(double elapsed_s) const {
  if (elapsed_s <= 0) return nodes_[0];
  int i = 0;
  while (i < count_ && nodes_[static_cast<std::size_t>(i) + 1].elapsed_s <= elapsed_s) ++i;
  const Node& n = nodes_[static_cast<std::size_t>(i)];
  if (i == count_) return {elapsed_s, n.x, n.y};
  const double t = elapsed_s - n.elapsed_s;
  return {elapsed_s,
          n.x + n.vx * t + n.ax * t * t / 2,
          n.y + n.vy * t + n.ay * t * t / 2,
          n.vx + n.ax * t,
          n.vy + n.ay * t,
          n.ax,
          n.ay};
}

ClosestApproach closest_approach(const AuditPath& a, const AuditPath& b, double cutoff_m,
                                 std::int64_t from_ns) {
  from_ns = std::max({from_ns, a.start_ns(), b.start_ns()});
  return closest_approach_of({a, b, static_cast<double>(from_ns - a.start_ns()) * 1e-9,
                              static_cast<double>(from_ns - b.start_ns()) * 1e-9},
                             cutoff_m, from_ns);
}

ClosestApproach closest_approach(const AuditPath& path, double x_m, double y_m, double cutoff_m) {
  msg::Version point;
  point.start_ns(path.start_ns());
  point.x_m(x_m);
  point.y_m(y_m);
  return closest_approach(path, AuditPath(point), cutoff_m);
}

}  // namespace sidestep
