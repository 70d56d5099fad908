// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/audit/audit_path.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kFinestStep_s = 0.00025;
constexpr int kManySteps = 12;
constexpr double kFarthest_m = 1e4;
constexpr double kFastest_mps = 100;
constexpr double kHardest_mps2 = 1000;
constexpr std::int64_t kLongestPhase_ns = 60'000'000'000;
constexpr std::int64_t kLatest_ns = std::int64_t{1} << 62;

bool within(double value, double bound) { return std::abs(value) <= bound; }

// Nothing here is so large or small that std::hypot would be needed.
double length(double x, double y) { return std::sqrt(x * x + y * y); }

/// Two paths on one time axis.
struct Pair {
  const AuditPath& a;
  const AuditPath& b;
  double a_from_s, b_from_s;  ///< how long after its own start each is where the axis begins

  AuditPath::Node apart(double s) const {
    const AuditPath::Node p = a.at_s(a_from_s + s), q = b.at_s(b_from_s + s);
    return {s, p.x - q.x, p.y - q.y, p.vx - q.vx, p.vy - q.vy, 0, 0};
  }
  double distance(double s) const {
    const AuditPath::Node gap = apart(s);
    return length(gap.x, gap.y);
  }
  double end_s() const { return std::max({0.0, a.duration_s() - a_from_s, b.duration_s() - b_from_s}); }
  /// The relative velocity is a straight line between the ends of phases, so its largest is at one of them;
  /// just before and after, because what rests at its end may have moved until then.
  double largest_speed() const {
    double largest = 0;
    const auto look = [&](const AuditPath& path, double from_s) {
      for (int i = 0; i <= path.phase_count(); ++i) {
        const double s = path.phase(i).after_s - from_s;
        for (const double t : {s - 1e-9, s + 1e-9}) {
          const AuditPath::Node gap = apart(std::max(t, 0.0));
          largest = std::max(largest, length(gap.vx, gap.vy));
        }
      }
    };
    look(a, a_from_s);
    look(b, b_from_s);
    return largest;
  }
};

Approach nearest_of(const Pair& pair, double enough_m, std::int64_t from_ns) {
  const double end = pair.end_s();
  double best = pair.distance(0), best_s = 0;
  if (best - enough_m > end * (pair.a.fastest_mps() + pair.b.fastest_mps())) return {best, from_ns};
  // Most pairs are told apart in a few steps by a bound that costs nothing.
  double speed = pair.a.fastest_mps() + pair.b.fastest_mps() + 1e-9;
  const auto look = [&](double s) {
    const double d = pair.distance(s);
    if (d < best) best = d, best_s = s;
    return d;
  };
  int steps = 0;
  for (double s = 0, d = best; s < end; d = look(s)) {
    if (++steps == kManySteps) speed = pair.largest_speed() * (1 + 1e-9) + 1e-9;
    s = std::min(end, s + std::max(kFinestStep_s, (d - enough_m) / speed));
  }
  if (best < enough_m + speed * kFinestStep_s) {
    for (double step = kFinestStep_s / 16; step > 1e-8; step /= 16) {
      const double centre = best_s;
      for (int i = -16; i <= 16; ++i) look(std::clamp(centre + i * step, 0.0, end));
    }
  }
  return {best, from_ns + static_cast<std::int64_t>(best_s * 1e9)};
}

}  // namespace

bool is_sane(const msg::Version& version) {
  bool sane = version.phase_count() <= msg::MAX_PHASES && version.start_ns() >= 0 &&
              version.start_ns() <= kLatest_ns && within(version.x_m(), kFarthest_m) &&
              within(version.y_m(), kFarthest_m) && within(version.vx_mps(), kFastest_mps) &&
              within(version.vy_mps(), kFastest_mps) && version.inflation_m() >= 0 && version.inflation_m() <= 10;
  for (int i = 0; sane && i < version.phase_count(); ++i) {
    const msg::MotionPhase& phase = version.phases()[static_cast<std::size_t>(i)];
    sane = phase.duration_ns() >= 0 && phase.duration_ns() <= kLongestPhase_ns &&
           within(phase.ax_mps2(), kHardest_mps2) && within(phase.ay_mps2(), kHardest_mps2);
  }
  return sane;
}

AuditPath::AuditPath(const msg::Version& version)
    : start_ns_(version.start_ns()), count_(version.phase_count()) {
  nodes_[0] = {0, version.x_m(), version.y_m(), version.vx_mps(), version.vy_mps(), 0, 0};
  for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) {
    const msg::MotionPhase& phase = version.phases()[i];
    nodes_[i].ax = phase.ax_mps2();
    nodes_[i].ay = phase.ay_mps2();
    const double t = static_cast<double>(phase.duration_ns()) * 1e-9;
    const Node& n = nodes_[i];
    nodes_[i + 1] = {n.after_s + t,
                     n.x + n.vx * t + n.ax * t * t / 2,
                     n.y + n.vy * t + n.ay * t * t / 2,
                     n.vx + n.ax * t,
                     n.vy + n.ay * t,
                     0,
                     0};
    const double faster = std::max(length(n.vx, n.vy), length(nodes_[i + 1].vx, nodes_[i + 1].vy));
    reach_m_ += t * faster;
    fastest_mps_ = std::max(fastest_mps_, faster);
  }
}

AuditPath::Node AuditPath::at_s(double after_s) const {
  if (after_s <= 0) return nodes_[0];
  int i = 0;
  while (i < count_ && nodes_[static_cast<std::size_t>(i + 1)].after_s <= after_s) ++i;
  const Node& n = nodes_[static_cast<std::size_t>(i)];
  if (i == count_) return {after_s, n.x, n.y, 0, 0, 0, 0};
  const double t = after_s - n.after_s;
  return {after_s,
          n.x + n.vx * t + n.ax * t * t / 2,
          n.y + n.vy * t + n.ay * t * t / 2,
          n.vx + n.ax * t,
          n.vy + n.ay * t,
          n.ax,
          n.ay};
}

Approach nearest(const AuditPath& a, const AuditPath& b, double enough_m, std::int64_t from_ns) {
  from_ns = std::max({from_ns, a.start_ns(), b.start_ns()});
  return nearest_of({a, b, static_cast<double>(from_ns - a.start_ns()) * 1e-9,
                     static_cast<double>(from_ns - b.start_ns()) * 1e-9},
                    enough_m, from_ns);
}

Approach nearest(const AuditPath& path, double x_m, double y_m, double enough_m) {
  msg::Version stand;
  stand.start_ns(path.start_ns());
  stand.x_m(x_m);
  stand.y_m(y_m);
  return nearest(path, AuditPath(stand), enough_m);
}

}  // namespace sidestep
