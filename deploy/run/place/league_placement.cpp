// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/place/league_placement.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <utility>

#include "common/geometry/vec2.hpp"

namespace sidestep {
namespace {

/// Tolerances beyond vision's noise. Cameras may disagree by some centimetres about a robot that both see.
constexpr double kTolerance_m = 0.05, kTolerance_rad = 0.1;
constexpr double kNoiseDeviations = 5;
/// A ball that was placed may roll a little, and is pushed by robots.
constexpr double kBallTolerance_m = 0.1;
constexpr std::size_t kMaxDifferences = 4;

Team team_of(std::size_t index) { return index == 0 ? Team::kBlue : Team::kYellow; }
std::size_t index_of(Team team) { return team == Team::kBlue ? 0 : 1; }

std::string name_of_robot(std::size_t team, std::size_t number) {
  return fmt::format("{} robot {}", team == 0 ? "blue" : "yellow", number);
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::ranges::count(names, name) == 0) names.push_back(name);
}

league::RobotTeleport teleport_of(std::size_t team, std::size_t number, bool is_present) {
  league::RobotTeleport teleport;
  teleport.team = team_of(team);
  teleport.number = static_cast<std::uint32_t>(number);
  teleport.is_present = is_present;
  return teleport;
}

}  // namespace

LeaguePlacement::LeaguePlacement(const Scenario& scenario)
    : field_(scenario.field),
      tolerance_m_(kTolerance_m + kNoiseDeviations * scenario.vision.position_noise_m),
      tolerance_rad_(kTolerance_rad + kNoiseDeviations * scenario.vision.heading_noise_rad),
      ball_(scenario.ball) {
  require_unique_numbers(scenario);
  for (const RobotSpec& robot : scenario.robots) {
    if (robot.is_absent) continue;
    robots_[index_of(robot.team)][number_in_team(robot.id)].wanted =
        Place{robot.start_m, robot.start_heading_rad};
  }
}

void LeaguePlacement::on_frame(const league::DetectionFrame& frame, Time now) {
  if (now < look_from_) return;
  // Each frame shows what one camera sees, so after a silence, too, one frame is not enough.
  if (!std::exchange(has_seen_frame_, true)) judge_at_ = now + kLook;
  see(Team::kBlue, frame.blue);
  see(Team::kYellow, frame.yellow);
  for (const league::DetectedBall& ball : frame.balls) seen_balls_m_.push_back(ball.position_m);
}

void LeaguePlacement::see(Team team, const std::vector<league::DetectedRobot>& robots) {
  for (const league::DetectedRobot& robot : robots) {
    if (!robot.number || *robot.number >= league::kRobotNumbers) continue;
    PlacedRobot& known = robots_[index_of(team)][*robot.number];
    // Some simulators put robots that are removed beside the field.
    if (!known.wanted && !field_.contains(robot.position_m, 0)) continue;
    known.seen = Place{robot.position_m, robot.heading_rad};
  }
}

void LeaguePlacement::on_answer(const league::SimulatorResponse& answer) {
  has_answer_ = true;
  error_ = answer.errors.empty()
               ? ""
               : fmt::format("{} {}", answer.errors.front().code, answer.errors.front().message);
}

bool LeaguePlacement::is_right(const PlacedRobot& robot) const {
  if (!robot.wanted || !robot.seen) return robot.wanted.has_value() == robot.seen.has_value();
  return is_in_place(robot) && turned_rad(robot) <= tolerance_rad_;
}

// False for a distance that is not a number.
bool LeaguePlacement::is_in_place(const PlacedRobot& robot) const {
  return (robot.seen->position_m - robot.wanted->position_m).norm() <= tolerance_m_;
}

double LeaguePlacement::turned_rad(const PlacedRobot& robot) {
  if (!robot.seen->heading_rad) return 0;
  return std::abs(wrapped_rad(*robot.seen->heading_rad - *robot.wanted->heading_rad));
}

bool LeaguePlacement::is_ball_right() const {
  if (!ball_) return true;
  // A ball that is to roll has left its place before it is seen.
  if (ball_->velocity_mps.norm() > 0) return has_placed_ball_;
  return std::ranges::any_of(seen_balls_m_, [&](const Vec2& seen_m) {
    return (seen_m - ball_->position_m).norm() <= kBallTolerance_m;
  });
}

std::optional<league::SimulatorCommand> LeaguePlacement::update(Time now) {
  if (is_done_ || !judge_at_ || now < *judge_at_) return std::nullopt;
  if (!has_seen_frame_) {
    differences_ = {"no detections from vision since the last command"};
    return std::nullopt;
  }
  differences_ = differences();
  is_done_ = differences_.empty();
  if (is_done_) return std::nullopt;
  bool removes = !has_removed_wrong_;
  league::SimulatorCommand command = removes ? removal() : placement();
  if (command.robots.empty() && !command.ball) {
    removes = !removes;
    command = removes ? removal() : placement();
  }
  has_removed_wrong_ = removes;
  for (auto& team : robots_) {
    for (PlacedRobot& robot : team) robot.seen.reset();
  }
  seen_balls_m_.clear();
  has_seen_frame_ = false;
  has_sent_ = true;
  look_from_ = now + kReaction;
  judge_at_ = look_from_ + kLook;
  return command;
}

league::SimulatorCommand LeaguePlacement::removal() {
  league::SimulatorCommand command;
  for (std::size_t team = 0; team < kTeams; ++team) {
    for (std::size_t number = 0; number < league::kRobotNumbers; ++number) {
      const PlacedRobot& robot = robots_[team][number];
      if (!robot.seen || is_right(robot)) continue;
      command.robots.push_back(teleport_of(team, number, false));
      if (!robot.wanted) add_once(removed_, name_of_robot(team, number));
    }
  }
  return command;
}

league::SimulatorCommand LeaguePlacement::placement() {
  league::SimulatorCommand command;
  for (std::size_t team = 0; team < kTeams; ++team) {
    for (std::size_t number = 0; number < league::kRobotNumbers; ++number) {
      const PlacedRobot& robot = robots_[team][number];
      if (!robot.wanted || is_right(robot)) continue;
      league::RobotTeleport teleport = teleport_of(team, number, true);
      teleport.x_m = robot.wanted->position_m.x();
      teleport.y_m = robot.wanted->position_m.y();
      teleport.heading_rad = robot.wanted->heading_rad;
      command.robots.push_back(teleport);
      add_once(placed_, name_of_robot(team, number));
    }
  }
  if (!is_ball_right()) {
    command.ball = league::BallTeleport{ball_->position_m, ball_->velocity_mps};
    has_placed_ball_ = true;
  }
  return command;
}

std::vector<std::string> LeaguePlacement::differences() const {
  std::vector<std::string> texts;
  for (std::size_t team = 0; team < kTeams; ++team) {
    for (std::size_t number = 0; number < league::kRobotNumbers; ++number) {
      const PlacedRobot& robot = robots_[team][number];
      if (is_right(robot)) continue;
      const std::string name = name_of_robot(team, number);
      if (!robot.seen)
        texts.push_back(name + " is not seen");
      else if (!robot.wanted)
        texts.push_back(name + " is not in the scenario");
      else if (is_in_place(robot))
        texts.push_back(fmt::format("{} is turned by {:.2f} rad", name, turned_rad(robot)));
      else
        texts.push_back(fmt::format("{} is {:.2f} m from its place", name,
                                    (robot.seen->position_m - robot.wanted->position_m).norm()));
    }
  }
  if (!is_ball_right()) texts.emplace_back("the ball is not in its place");
  return texts;
}

std::string LeaguePlacement::problem() const {
  if (!judge_at_) return "no detections from vision";
  std::vector<std::string> texts = differences_;
  if (texts.size() > kMaxDifferences) {
    texts.resize(kMaxDifferences);
    texts.push_back(fmt::format("{} more differences", differences_.size() - kMaxDifferences));
  }
  if (has_sent_ && !has_answer_) texts.emplace_back("the simulator does not answer");
  if (!error_.empty()) texts.push_back("the simulator answers " + error_);
  return fmt::format("{}", fmt::join(texts, "; "));
}

}  // namespace sidestep
