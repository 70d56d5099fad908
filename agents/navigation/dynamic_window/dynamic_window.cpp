// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/dynamic_window.hpp"

#include <stdexcept>

#include "agents/navigation/dynamic_window/hull_cell_times.hpp"

namespace sidestep {
namespace {

constexpr GridWindow kWholeGrid{{0, kGridSide - 1}, {0, kGridSide - 1}};

void check_query(const WindowQuery& query) {
  const double window_s = query.window_s.value_or(query.cycle_s);
  if (!std::isfinite(query.wheels.left_mps) || !std::isfinite(query.wheels.right_mps))
    throw std::invalid_argument("wheel speeds have to be finite");
  if (!query.goal.position_m.allFinite() || !std::isfinite(query.goal.heading_rad.value_or(0)) ||
      !(query.goal.radius_m > 0))
    throw std::invalid_argument("a goal has to be finite, and its radius positive");
  if (!(query.cycle_s > 0) || !std::isfinite(query.cycle_s) || !(window_s >= 0))
    throw std::invalid_argument("a cycle has to be positive, and a window not negative");
}

std::vector<ArcMotion> motions_of(const DifferentialDrive& drive) {
  check(drive);
  std::vector<ArcMotion> motions(kSlots);
  for_each_velocity(kWholeGrid, [&](int row, int column, std::size_t slot) {
    motions[slot] = drive.motion(drive.wheels(row, column));
  });
  return motions;
}

/// Half the number of grid steps by which the robot's speed differs from 0.
int steps_from_rest(int row, int column) { return std::abs(row + column - (kGridSide - 1)); }

/// Whether the robot should change only its heading.
bool turns_on_spot(DriveState state) { return state == DriveState::kTurn || state == DriveState::kAlign; }

}  // namespace

DynamicWindow::DynamicWindow(const DifferentialDrive& drive, const ConvexPolygon& hull,
                             const DynamicWindowSettings& settings)
    : drive_(drive),
      settings_(settings),
      times_({Hull(padded(hull, settings.padding_m)), motions_of(drive)}, settings.method,
             static_cast<float>(settings.horizon_s),
             [&] {
               return hull_cell_times(drive, padded(hull, settings.padding_m), settings.cell_m,
                                      settings.horizon_s);
             }),
      standstills_(kSlots) {
  if (!(settings.horizon_s > 0) || !std::isfinite(settings.horizon_s))
    throw std::invalid_argument("the horizon of a dynamic window has to be positive and finite");
  check(settings.weights);
  choice_.admissible.reserve(kSlots);
}

void DynamicWindow::prepare(double cycle_s) {
  if (cycle_s == cycle_s_) return;
  cycle_s_ = cycle_s;
  needed_s_.fill(kForbidden_s);
  for_each_velocity(kWholeGrid, [&](int row, int column, std::size_t slot) {
    const ArcMotion& motion = times_.outline().motions[slot];
    const double brake_s = drive_.time_to_brake_s(drive_.wheels(row, column));
    if (drive_.is_allowed(motion)) {
      // Rounded up, which makes comparisons in single precision conservative.
      needed_s_[slot] = std::nextafter(static_cast<float>(brake_s + cycle_s), kForbidden_s);
    }
    // While braking at a constant rate, the robot moves half as far as at full speed.
    const double effective_s = cycle_s + brake_s / 2, turn_rad = motion.turn_rate_radps * effective_s;
    const Vec2 rest = displacement_m(motion, effective_s);
    standstills_[slot] = {static_cast<float>(rest.x()), static_cast<float>(rest.y()),
                          static_cast<float>(std::cos(turn_rad)), static_cast<float>(std::sin(turn_rad))};
  });
}

GridWindow DynamicWindow::window_around(const WindowQuery& query) const {
  const double change = drive_.wheel_acceleration_mps2 * query.window_s.value_or(query.cycle_s);
  return {reachable_indices(query.wheels.left_mps, change, drive_.wheel_speed_mps),
          reachable_indices(query.wheels.right_mps, change, drive_.wheel_speed_mps)};
}

Objectives DynamicWindow::rate(std::size_t slot, const DriveGoal& goal) const {
  const Standstill& rest = standstills_[slot];
  float x = static_cast<float>(goal.position_m.x()) - rest.x_m;
  float y = static_cast<float>(goal.position_m.y()) - rest.y_m;
  if (choice_.state == DriveState::kAlign) {
    x = static_cast<float>(std::cos(*goal.heading_rad));
    y = static_cast<float>(std::sin(*goal.heading_rad));
  }
  const auto relative = static_cast<float>(times_.outline().motions[slot].speed_mps / drive_.speed_mps);
  return {distance_objective(times_.time_s(slot), needed_s_[slot], static_cast<float>(settings_.horizon_s)),
          heading_objective(rest.cosine * x + rest.sine * y, rest.cosine * y - rest.sine * x),
          choice_.state == DriveState::kGo ? (relative + 1) / 2 : 1 - std::abs(relative)};
}

void DynamicWindow::add_admissible(const WindowQuery& query, const GridWindow& window) {
  int steps = kGridSide;  // steps of the slowest speeds in the window
  if (turns_on_spot(choice_.state)) {
    for_each_velocity(window, [&](int row, int column, std::size_t) {
      steps = std::min(steps, steps_from_rest(row, column));
    });
  }
  for_each_velocity(window, [&](int row, int column, std::size_t slot) {
    if (times_.time_s(slot) <= needed_s_[slot] || steps_from_rest(row, column) > steps) return;
    const Objectives objectives = rate(slot, query.goal);
    const float value = objectives.weighted(settings_.weights);
    if (!choice_.best || value > choice_.admissible[*choice_.best].value)
      choice_.best = choice_.admissible.size();
    choice_.admissible.push_back({drive_.wheels(row, column), times_.time_s(slot), objectives, value});
  });
}

const WindowChoice& DynamicWindow::choose(const WindowQuery& query) {
  check_query(query);
  prepare(query.cycle_s);
  choice_.state = next_state(choice_.state, query.goal, drive_.motion(query.wheels).speed_mps);
  choice_.admissible.clear();
  choice_.best.reset();
  choice_.command = drive_.braked(query.wheels, query.cycle_s);
  const GridWindow window = window_around(query);
  choice_.is_touching = !times_.compute(query.points_m, window, needed_s_);
  if (choice_.is_touching || choice_.state == DriveState::kStop) return choice_;
  add_admissible(query, window);
  if (choice_.best) choice_.command = choice_.admissible[*choice_.best].wheels;
  return choice_;
}

}  // namespace sidestep
