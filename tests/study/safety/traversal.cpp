// SPDX-License-Identifier: Apache-2.0
#include "tests/study/safety/traversal.hpp"

#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "common/messaging/topics.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"

namespace sidestep {
namespace {

constexpr int kRows = 8;
// Distance between slots on one side, large enough to pass between robots that rest there.
constexpr double kSlotSpacing_m = 0.45;
constexpr double kFirstColumn_m = 1.4;
constexpr double kWallDistance_m = 0.4;
// Number of goals, more than a robot can reach in a run.
constexpr int kGoals = 100;
constexpr double kPoorOdometryFactor = 10;
constexpr double kBodyRadius_m = 0.05;
constexpr double kNoBound_m = 1;
constexpr Duration kStartDeadline = std::chrono::seconds(20);

std::vector<int> shuffled(int count, Rng& rng) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  rng.shuffle(numbers);
  return numbers;
}

/// The position of a slot on a side: -1 left, 1 right.
Vec2 slot_position_m(int slot, int side) {
  const int column = slot / kRows;
  const double x = kFirstColumn_m + kSlotSpacing_m * column;
  return {side * x, kSlotSpacing_m * (slot % kRows - 0.5 * (kRows - 1))};
}

/// Measures interpenetration between two ground truths, with motions interpolated by cubic polynomials that
/// match the positions and velocities of both.
class InterpolatedMeter {
 public:
  explicit InterpolatedMeter(std::size_t robots)
      : meter_(robots, kStudyRadius_m), last_(robots), positions_m_(robots) {}

  void add(const msg::GroundTruth& truth) {
    const Time at = time_from_ns(truth.valid_at_ns());
    std::vector<State> states;
    for (const msg::TrueRobotState& robot : truth.robots())
      states.push_back({{robot.x_m(), robot.y_m()}, {robot.vx_mps(), robot.vy_mps()}});
    if (last_at_ && at > *last_at_) measure(states, to_seconds(at - *last_at_));
    last_ = states;
    last_at_ = at;
  }
  const Interpenetration& meter() const { return meter_; }

 private:
  void measure(const std::vector<State>& states, double seconds) {
    for (int step = 1; step <= kSteps; ++step) {
      const double s = static_cast<double>(step) / kSteps, rest = 1 - s;
      for (std::size_t i = 0; i < states.size(); ++i) {
        positions_m_[i] = rest * rest * (1 + 2 * s) * last_[i].position_m +
                          s * s * (3 - 2 * s) * states[i].position_m +
                          seconds * s * rest * (rest * last_[i].velocity_mps - s * states[i].velocity_mps);
      }
      meter_.add(positions_m_, seconds / kSteps);
    }
  }

  static constexpr int kSteps = 16;
  Interpenetration meter_;
  std::vector<State> last_;
  std::optional<Time> last_at_;
  std::vector<Vec2> positions_m_;
};

}  // namespace

TraversalResult result_of(const Interpenetration& meter) {
  TraversalResult result;
  result.contacts = meter.contacts();
  result.penetration_m_s = meter.depth_time_m_s();
  result.min_clearance_m = meter.min_clearance_m();
  return result;
}

Scenario traversal_scenario(const TraversalSettings& settings, std::uint64_t seed) {
  Rng rng(seed);
  const int columns = (settings.robots + kRows - 1) / kRows;
  Scenario scenario;
  scenario.name = "traversals";
  scenario.field = {2 * (kFirstColumn_m + kSlotSpacing_m * (columns - 1) + kWallDistance_m),
                    kSlotSpacing_m * (kRows - 1) + 2 * kWallDistance_m};
  scenario.radius_m = kBodyRadius_m;
  scenario.margin_m = settings.margin_m + 2 * (kStudyRadius_m - kBodyRadius_m);
  if (!settings.stops_off_reference) scenario.tracking_bound_m = kNoBound_m;
  scenario.vision.position_noise_m = settings.position_noise_m;
  if (settings.has_poor_odometry) {
    scenario.odometry.velocity_noise_mps *= kPoorOdometryFactor;
    scenario.odometry.scale_error *= kPoorOdometryFactor;
  }
  const std::vector<int> left = shuffled(columns * kRows, rng), right = shuffled(columns * kRows, rng);
  for (int i = 0; i < settings.robots; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const bool begins_left = i % 2 == 0;
    const Vec2 ends[2] = {slot_position_m(left[index], -1), slot_position_m(right[index], 1)};
    RobotSpec robot;
    robot.id = static_cast<RobotId>(i);
    robot.team = begins_left ? Team::kBlue : Team::kYellow;
    robot.start_m = ends[begins_left ? 0 : 1];
    for (int goal = 0; goal < kGoals; ++goal)
      robot.goals.push_back({ends[(goal % 2 == 0) == begins_left ? 1 : 0], {}});
    scenario.robots.push_back(robot);
  }
  return scenario;
}

TraversalResult traverse_with_search(const Scenario& scenario, std::uint64_t seed, double seconds) {
  SimSystem system(scenario, seed);
  SimBus observer(system.network());
  observer.become_observer();
  std::map<RobotId, std::uint64_t> traversals;
  observer.subscribe<msg::AgentStatus>(topics::kStatus, [&](const msg::AgentStatus& status) {
    traversals[status.robot()] = status.goal_index();
  });
  InterpolatedMeter interpolated(scenario.robots.size());
  system.observer_bus().subscribe(topics::kTruth,
                                  [&](const msg::GroundTruth& truth) { interpolated.add(truth); });
  while (!system.metrics().granting_since()) {
    if (system.now() > system.begin() + kStartDeadline)
      throw std::runtime_error("the coordinator did not grant anything within 20 s");
    system.run_for(scenario.cycle);
  }
  system.run_until(*system.metrics().granting_since() + from_seconds(seconds));
  TraversalResult result = result_of(interpolated.meter());
  for (const auto& [robot, count] : traversals) result.traversals += count;
  result.reference_error_m = system.metrics().report().max_reference_error_m;
  return result;
}

}  // namespace sidestep
