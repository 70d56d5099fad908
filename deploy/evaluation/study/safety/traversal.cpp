// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/study/safety/traversal.hpp"

#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "common/messaging/topics.hpp"
#include "deploy/simulate/system/sim_system.hpp"

namespace sidestep {
namespace {

constexpr int kRows = 8;
// Between places at a side: robots pass between others that stand there.
constexpr double kSpacing_m = 0.45;
constexpr double kToFirstColumn_m = 1.4;
constexpr double kToWall_m = 0.4;
// More than anybody gets to.
constexpr int kGoals = 100;
constexpr double kPoor = 10;
constexpr double kBodyRadius_m = 0.05;
constexpr double kNoBound_m = 1;
constexpr Duration kStartDeadline = std::chrono::seconds(20);

std::vector<int> shuffled(int count, Rng& rng) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  rng.shuffle(numbers);
  return numbers;
}

/// Place `slot` at a side: -1 left, 1 right.
Vec2 place(int slot, int side) {
  const double x = kToFirstColumn_m + kSpacing_m * (slot / kRows);
  return {side * x, kSpacing_m * (slot % kRows - 0.5 * (kRows - 1))};
}

/// Where robots are between two ground truths: cubic polynomials with the positions and velocities at both.
class Tracks {
 public:
  explicit Tracks(std::size_t robots) : meter_(robots, kStudyRadius_m), last_(robots), positions_m_(robots) {}

  void add(const msg::GroundTruth& truth) {
    const Time at = time_from_ns(truth.at_ns());
    std::vector<State> states;
    for (const msg::TruthRobot& robot : truth.robots())
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
  scenario.field = {2 * (kToFirstColumn_m + kSpacing_m * (columns - 1) + kToWall_m),
                    kSpacing_m * (kRows - 1) + 2 * kToWall_m};
  scenario.radius_m = kBodyRadius_m;
  scenario.margin_m = settings.margin_m + 2 * (kStudyRadius_m - kBodyRadius_m);
  if (!settings.breaks_off) scenario.tracking_bound_m = kNoBound_m;
  scenario.vision.position_noise_m = settings.position_noise_m;
  if (settings.has_poor_odometry) {
    scenario.odometry.velocity_noise_mps *= kPoor;
    scenario.odometry.scale_error *= kPoor;
  }
  const std::vector<int> left = shuffled(columns * kRows, rng), right = shuffled(columns * kRows, rng);
  for (int i = 0; i < settings.robots; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const bool begins_left = i % 2 == 0;
    const Vec2 ends[2] = {place(left[index], -1), place(right[index], 1)};
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
  SimBus ear(system.network());
  ear.listen_aside();
  std::map<RobotId, std::uint64_t> traversals;
  ear.subscribe<msg::AgentStatus>(topics::kStatus, [&](const msg::AgentStatus& status) {
    traversals[status.robot()] = status.goal_index();
  });
  Tracks tracks(scenario.robots.size());
  system.on_truth([&](const msg::GroundTruth& truth) { tracks.add(truth); });
  while (!system.judge().granting_since()) {
    if (system.now() > system.begin() + kStartDeadline)
      throw std::runtime_error("the coordinator does not grant");
    system.run_for(scenario.cycle);
  }
  system.run_until(*system.judge().granting_since() + from_seconds(seconds));
  TraversalResult result = result_of(tracks.meter());
  for (const auto& [robot, count] : traversals) result.traversals += count;
  result.reference_error_m = system.judge().report().max_reference_error_m;
  return result;
}

}  // namespace sidestep
