// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/scenario/text_picture.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

namespace sidestep {
namespace {

constexpr int kMaxRows = 40;
/// A character of a terminal is about twice as high as wide.
constexpr double kRowsPerColumn = 2;
/// Points per cell and direction at which obstacles are looked for.
constexpr int kSamples = 3;
constexpr char kFree = ' ', kObstacle = '#', kPath = '.', kOpponent = '!', kWaypoint = '+', kBall = '*';

/// The floor as characters. Names do not overlap each other: what has no room becomes one character.
class Canvas {
 public:
  Canvas(const Scenario& scenario, int columns) : field_(scenario.field) {
    const double columns_of_field = columns - 2;  // two for the frame
    column_m_ = std::max(field_.length_m / columns_of_field, field_.width_m / (kMaxRows * kRowsPerColumn));
    row_m_ = kRowsPerColumn * column_m_;
    columns_ = std::max(1, static_cast<int>(std::ceil(field_.length_m / column_m_ - 1e-9)));
    rows_ = std::max(1, static_cast<int>(std::ceil(field_.width_m / row_m_ - 1e-9)));
    text_.assign(static_cast<std::size_t>(rows_), std::string(static_cast<std::size_t>(columns_), kFree));
    is_name_.assign(text_.size(), std::vector<bool>(static_cast<std::size_t>(columns_)));
    draw_obstacles(scenario);
  }

  double column_m() const { return column_m_; }
  double row_m() const { return row_m_; }

  /// Draws a character that names cover.
  void mark(const Vec2& p, char character) {
    const auto [column, row] = cell_of(p);
    if (!is_name_[row][column]) text_[row][column] = character;
  }

  void mark_line(const Vec2& from, const Vec2& to, char character) {
    const int steps = std::max(1, static_cast<int>((to - from).norm() / column_m_));
    for (int i = 0; i <= steps; ++i) mark(from + static_cast<double>(i) / steps * (to - from), character);
  }

  /// Writes a name centred at a position, or `short_name` if the name would overlap another. Returns whether
  /// there was room for the name.
  bool write(const Vec2& p, const std::string& name, char short_name) {
    const auto [column, row] = cell_of(p);
    const std::size_t width = name.size();
    const std::size_t begin = std::min(column - std::min(column, width / 2),
                                       text_[row].size() - std::min(text_[row].size(), width));
    const auto first = is_name_[row].begin() + static_cast<std::ptrdiff_t>(begin);
    const bool has_room =
        width <= text_[row].size() &&
        std::none_of(first, first + static_cast<std::ptrdiff_t>(width), [](bool is) { return is; });
    if (has_room) {
      text_[row].replace(begin, width, name);
      std::fill_n(first, width, true);
    } else if (!is_name_[row][column]) {
      text_[row][column] = short_name;
      is_name_[row][column] = true;
    }
    return has_room;
  }

  bool has(char character) const {
    return std::ranges::any_of(text_,
                               [=](const std::string& row) { return row.find(character) != row.npos; });
  }

  std::string framed() const {
    const std::string edge = "+" + std::string(static_cast<std::size_t>(columns_), '-') + "+\n";
    std::string picture = edge;
    for (const std::string& row : text_) picture += "|" + row + "|\n";
    return picture + edge;
  }

 private:
  struct CellIndex {
    std::size_t column, row;
  };

  CellIndex cell_of(const Vec2& p) const {
    const auto index = [](double cells, int count) {
      return static_cast<std::size_t>(std::clamp(cells, 0.0, count - 1.0));
    };
    return {index((p.x() + field_.length_m / 2) / column_m_, columns_),
            index((field_.width_m / 2 - p.y()) / row_m_, rows_)};
  }

  void draw_obstacles(const Scenario& scenario) {
    const double step_m = column_m_ / kSamples;
    const auto is_blocked = [&](const Vec2& p) {
      return (scenario.map && scenario.map->cells().touches(p, p, step_m / 2)) ||
             std::ranges::any_of(scenario.obstacles,
                                 [&](const Shape& shape) { return signed_distance(p, shape) <= step_m / 2; });
    };
    const Vec2 corner_m(-field_.length_m / 2, field_.width_m / 2);
    const int samples_y = kSamples * static_cast<int>(kRowsPerColumn);
    for (int row = 0; row < rows_ * samples_y; ++row) {
      for (int column = 0; column < columns_ * kSamples; ++column) {
        const Vec2 p = corner_m + step_m * Vec2(column + 0.5, -row - 0.5);
        char& cell =
            text_[static_cast<std::size_t>(row / samples_y)][static_cast<std::size_t>(column / kSamples)];
        if (cell == kFree && is_blocked(p)) cell = kObstacle;
      }
    }
  }

  Field field_;
  double column_m_ = 1, row_m_ = 1;
  int columns_ = 1, rows_ = 1;
  std::vector<std::string> text_;
  std::vector<std::vector<bool>> is_name_;
};

void draw_opponents(const Scenario& scenario, Canvas& canvas) {
  for (const OpponentSpec& opponent : scenario.opponents) {
    for (std::size_t i = 1; i < opponent.path_m.size(); ++i)
      canvas.mark_line(opponent.path_m[i - 1], opponent.path_m[i], kPath);
  }
  for (const OpponentSpec& opponent : scenario.opponents) canvas.mark(opponent.path_m.front(), kOpponent);
}

}  // namespace

std::string text_picture(const Scenario& scenario, int columns) {
  Canvas canvas(scenario, std::max(columns, kMinPictureColumns));
  draw_opponents(scenario, canvas);
  bool has_short_start = false, has_short_goal = false, has_goal = false;
  for (const RobotSpec& robot : scenario.robots)
    has_short_start |= !canvas.write(robot.start_m, fmt::format("{}", robot.id), 'o');
  for (const RobotSpec& robot : scenario.robots) {
    if (robot.goals.empty()) continue;
    has_goal = true;
    has_short_goal |= !canvas.write(robot.goals.back().position_m, fmt::format("({})", robot.id), 'x');
    for (std::size_t i = 0; i + 1 < robot.goals.size(); ++i)
      canvas.mark(robot.goals[i].position_m, kWaypoint);
  }
  if (scenario.ball) canvas.mark(scenario.ball->position_m, kBall);

  const RobotId first = scenario.robots.empty() ? 0 : scenario.robots.front().id;
  std::string legend = fmt::format("{} start of robot {}", first, first);
  if (has_short_start) legend += ", o of another";
  if (has_goal) legend += fmt::format("   ({}) its last goal", first);
  if (has_short_goal) legend += ", x of another";
  const auto explain = [&](char character, const char* meaning) {
    if (canvas.has(character)) legend += fmt::format("\n{} {}", character, meaning);
  };
  explain(kWaypoint, "a goal before the last");
  explain(kObstacle, "an obstacle");
  explain(kOpponent, "a moving obstacle at its start");
  explain(kPath, "the path of a moving obstacle");
  explain(kBall, "the ball");
  return canvas.framed() + legend +
         fmt::format(
             "\nx is {:g} to {:g} m, y is {:g} to {:g} m; a character is {:.2g} m wide and {:.2g} m high\n",
             -scenario.field.length_m / 2, scenario.field.length_m / 2, -scenario.field.width_m / 2,
             scenario.field.width_m / 2, canvas.column_m(), canvas.row_m());
}

}  // namespace sidestep
