// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/floor_frame.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "deploy/view/monitor/unix_time.hpp"

namespace sidestep {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

constexpr std::array kRobotColumns{
    "id",           "flags",  "state",  "true_x",  "true_y", "true_heading", "seen_x",         "seen_y",
    "seen_heading", "x",      "y",      "heading", "vx",     "vy",           "tracking_error", "denied",
    "blocker",      "goal_x", "goal_y", "via_x",   "via_y",  "nearest_x",    "nearest_y",      "waits_for"};
constexpr std::array kVersionColumns{
    "start",     "x",   "y",   "vx",        "vy",  "inflation", "phases",    "duration0", "ax0", "ay0",
    "duration1", "ax1", "ay1", "duration2", "ax2", "ay2",       "duration3", "ax3",       "ay3"};
constexpr std::array kVersions{"executing", "granted", "proposed"};
constexpr std::array kLedgerColumns{"id"};  // followed by the columns of a version
constexpr std::array kObstacleColumns{"id", "x", "y", "vx", "vy", "radius", "age"};
constexpr std::array kBallColumns{"x", "y", "vx", "vy"};
constexpr std::array kDetectionColumns{"camera", "kind", "x", "y", "heading", "radius"};
constexpr std::array kBeamColumns{"robot", "x", "y"};
/// The states of a course, from now on. A cubic through two successive states differs from the course by at
/// most about a centimetre.
constexpr std::array kCourseColumns{"robot", "ahead", "x", "y", "vx", "vy"};
constexpr Duration kCourseStep = std::chrono::milliseconds(500);
constexpr std::array kFlags{"off_reference", "lifted", "held", "blocked"};
constexpr std::array kSections{"robots", "ledger", "obstacles", "balls", "detections", "beams", "courses"};
static_assert(kVersionColumns.size() == 7 + 3 * msg::MAX_PHASES);

/// One section of a frame.
class Rows {
 public:
  explicit Rows(std::size_t columns) : columns_(columns) {}

  Rows& add(double value) {
    values_.push_back(static_cast<float>(value));
    return *this;
  }
  Rows& unknown(std::size_t count) {
    values_.insert(values_.end(), count, kUnknown);
    return *this;
  }
  std::uint32_t rows() const { return static_cast<std::uint32_t>(values_.size() / columns_); }
  const std::vector<float>& values() const { return values_; }

 private:
  std::size_t columns_;
  std::vector<float> values_;
};

void add_version(Rows& rows, const msg::Version* version, Time now) {
  if (version == nullptr) {
    rows.unknown(kVersionColumns.size());
    return;
  }
  // Each of these times fits into 64 bits as nanoseconds; their difference might not.
  rows.add((static_cast<double>(version->start_ns()) - static_cast<double>(to_ns(now))) * 1e-9);
  rows.add(version->x_m()).add(version->y_m()).add(version->vx_mps()).add(version->vy_mps());
  const std::size_t phases = std::min<std::size_t>(version->phase_count(), msg::MAX_PHASES);
  rows.add(version->inflation_m()).add(static_cast<double>(phases));
  for (std::size_t i = 0; i < msg::MAX_PHASES; ++i) {
    const msg::MotionPhase& phase = version->phases()[i];
    if (i >= phases)
      rows.add(0).add(0).add(0);
    else
      rows.add(static_cast<double>(phase.duration_ns()) * 1e-9).add(phase.ax_mps2()).add(phase.ay_mps2());
  }
}

void add_robot(Rows& rows, RobotId id, const RobotView& robot, const Waits& waits, Time now) {
  const msg::TrueRobotState* truth = fresh(robot.truth, now);
  const msg::TrackedRobot* seen = fresh(robot.seen, now);
  const msg::Feedback* feedback = fresh(robot.feedback, now);
  const msg::AgentStatus* status = fresh(robot.status, now);
  const msg::OrderStatus* order = fresh(robot.order, now);
  const msg::Proposal* proposal = fresh(robot.proposal, now);
  const msg::Version* granted = fresh(robot.granted, now);
  const Denial* denial = fresh(robot.denial, now);
  const msg::Version* proposed =
      proposal != nullptr && proposal->candidate_count() > 0 ? &proposal->candidates()[0] : nullptr;
  const bool is_blocked = order != nullptr && order->block_reason() != msg::BlockReason::BLOCK_NONE;
  const unsigned flags = (feedback != nullptr && feedback->is_off_reference() ? 1u : 0u) |
                         (feedback != nullptr && feedback->is_lifted() ? 2u : 0u) |
                         (order != nullptr && order->is_held() ? 4u : 0u) | (is_blocked ? 8u : 0u);
  rows.add(id).add(flags).add(status ? static_cast<double>(status->agent_state()) : kUnknown);
  truth ? rows.add(truth->x_m()).add(truth->y_m()).add(truth->heading_rad()) : rows.unknown(3);
  seen ? rows.add(seen->x_m()).add(seen->y_m()).add(seen->heading_rad()) : rows.unknown(3);
  if (feedback) {
    rows.add(feedback->x_m()).add(feedback->y_m()).add(feedback->heading_rad());
    rows.add(feedback->vx_mps()).add(feedback->vy_mps()).add(feedback->tracking_error_m());
  } else {
    rows.unknown(6);
  }
  rows.add(denial ? static_cast<double>(denial->reason) : kUnknown);
  rows.add(denial && denial->reason == msg::Reason::REASON_CONFLICT ? static_cast<double>(denial->blocker)
                                                                    : kUnknown);
  const msg::Version* intending = granted ? granted : proposed;
  if (intending && intending->has_intent()) {
    const msg::Intent& intent = intending->intent();
    rows.add(intent.target_x_m()).add(intent.target_y_m()).add(intent.via_x_m()).add(intent.via_y_m());
  } else {
    rows.unknown(4);
  }
  is_blocked ? rows.add(order->nearest_x_m()).add(order->nearest_y_m()) : rows.unknown(2);
  const auto wait = waits.find(id);
  rows.add(wait == waits.end() ? kUnknown : static_cast<double>(wait->second));
  add_version(rows, feedback ? &feedback->executing() : nullptr, now);
  add_version(rows, granted, now);
  add_version(rows, proposed, now);
}

void add_course(Rows& rows, const DrivingCourse& course, Time now) {
  for (Time t = now;; t = std::min(t + kCourseStep, course.end())) {
    const State state = course.state_at(std::max(t, course.start));
    rows.add(course.robot).add(to_seconds(t - now)).add(state.position_m.x()).add(state.position_m.y());
    rows.add(state.velocity_mps.x()).add(state.velocity_mps.y());
    if (t >= course.end()) return;
  }
}

void add_beams(Rows& rows, const msg::LaserScan& scan) {
  const std::size_t count = scan.ranges_m().size();
  if (count < 2) return;
  const bool is_full_turn = scan.field_of_view_rad() > 6.28;
  const double step_rad = scan.field_of_view_rad() / static_cast<double>(is_full_turn ? count : count - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const double range_m = scan.ranges_m()[i];
    if (!std::isfinite(range_m)) continue;
    const double angle_rad =
        scan.heading_rad() - scan.field_of_view_rad() / 2 + step_rad * static_cast<double>(i);
    rows.add(scan.robot());
    rows.add(scan.x_m() + range_m * std::cos(angle_rad)).add(scan.y_m() + range_m * std::sin(angle_rad));
  }
}

void add_detections(Rows& rows, const msg::DetectionFrame& frame) {
  for (const msg::RobotDetection& robot : frame.robots())
    rows.add(frame.camera()).add(0).add(robot.x_m()).add(robot.y_m()).add(robot.heading_rad()).unknown(1);
  const std::size_t balls = std::min<std::size_t>(frame.ball_count(), msg::MAX_DETECTED_BALLS);
  for (std::size_t i = 0; i < balls; ++i)
    rows.add(frame.camera()).add(1).add(frame.balls()[i].x_m()).add(frame.balls()[i].y_m()).unknown(2);
  const std::size_t obstacles = std::min<std::size_t>(frame.obstacle_count(), msg::MAX_OBSTACLES);
  for (std::size_t i = 0; i < obstacles; ++i) {
    const msg::ObstacleDetection& obstacle = frame.obstacles()[i];
    rows.add(frame.camera()).add(2).add(obstacle.x_m()).add(obstacle.y_m()).unknown(1);
    rows.add(obstacle.radius_m());
  }
}

constexpr std::size_t kRobotRow = kRobotColumns.size() + kVersions.size() * kVersionColumns.size();

/// The index of a column in a robot's row.
consteval std::size_t robot_column(std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(kRobotColumns, name) - kRobotColumns.begin());
}

template <typename Value>
Value read(const std::string& bytes, std::size_t offset) {
  Value value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

template <typename Value>
void append(std::string& bytes, const Value& value) {
  const auto* begin = reinterpret_cast<const char*>(&value);
  bytes.append(begin, sizeof value);
}

}  // namespace

std::string encode_frame(const FloorState& floor, const Waits& waits, Time now) {
  Rows robots(kRobotRow);
  Rows ledger(kLedgerColumns.size() + kVersionColumns.size());
  Rows obstacles(kObstacleColumns.size()), balls(kBallColumns.size());
  Rows detections(kDetectionColumns.size()), beams(kBeamColumns.size()), courses(kCourseColumns.size());
  for (const auto& [id, robot] : floor.robots()) {
    add_robot(robots, id, robot, waits, now);
    if (const DrivingCourse* course = present_course(robot, now)) add_course(courses, *course, now);
    if (const msg::LaserScan* scan = fresh(robot.scan, now)) add_beams(beams, *scan);
  }
  for (const auto& [index, page] : floor.ledger()) {
    if (now - page.at > kMaxShownAge) continue;
    for (const msg::Version& version : page.value.versions()) {
      ledger.add(version.robot());
      add_version(ledger, &version, now);
    }
  }
  if (const msg::ObstacleList* list = fresh(floor.obstacles(), now)) {
    for (const msg::TrackedObstacle& o : list->obstacles()) {
      obstacles.add(o.obstacle()).add(o.x_m()).add(o.y_m()).add(o.vx_mps()).add(o.vy_mps()).add(o.radius_m());
      obstacles.add((static_cast<double>(to_ns(now)) - static_cast<double>(o.observed_at_ns())) * 1e-9);
    }
  }
  const msg::WorldState* world = fresh(floor.world(), now);
  if (world && world->ball().is_visible()) {
    const msg::TrackedBall& ball = world->ball();
    balls.add(ball.x_m()).add(ball.y_m()).add(ball.vx_mps()).add(ball.vy_mps());
  }
  for (const auto& [camera, frame] : floor.detections())
    if (now - frame.at <= kMaxShownAge) add_detections(detections, frame.value);

  const std::array<const Rows*, kSections.size()> sections{&robots,     &ledger, &obstacles, &balls,
                                                           &detections, &beams,  &courses};
  std::string bytes;
  append(bytes, unix_seconds(now));
  append(bytes, static_cast<std::uint32_t>(sections.size()));
  for (const Rows* rows : sections) append(bytes, rows->rows());
  for (const Rows* rows : sections)
    bytes.append(reinterpret_cast<const char*>(rows->values().data()), rows->values().size() * sizeof(float));
  return bytes;
}

std::vector<RobotPlace> places_in(const std::string& frame) {
  static_assert(kSections[0] == std::string_view("robots"));
  constexpr std::size_t kRows = sizeof(double) + sizeof(std::uint32_t);
  std::vector<RobotPlace> places;
  const auto rows = read<std::uint32_t>(frame, kRows);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t begin =
        kRows + kSections.size() * sizeof(std::uint32_t) + row * kRobotRow * sizeof(float);
    const auto cell = [&](std::size_t column) { return read<float>(frame, begin + column * sizeof(float)); };
    for (const std::size_t x : {robot_column("true_x"), robot_column("seen_x"), robot_column("x")}) {
      if (std::isnan(cell(x))) continue;
      places.push_back({static_cast<RobotId>(cell(0)), {cell(x), cell(x + 1)}});
      break;
    }
  }
  return places;
}

nlohmann::ordered_json frame_layout() {
  using Names = std::vector<std::string>;
  const auto names = [](const auto& columns) { return Names(columns.begin(), columns.end()); };
  Names robots = names(kRobotColumns);
  for (const char* version : kVersions)
    for (const char* column : kVersionColumns) robots.push_back(std::string(version) + "_" + column);
  Names ledger = names(kLedgerColumns);
  for (const char* column : kVersionColumns) ledger.push_back(std::string("version_") + column);
  const std::array<Names, kSections.size()> columns{robots,
                                                    ledger,
                                                    names(kObstacleColumns),
                                                    names(kBallColumns),
                                                    names(kDetectionColumns),
                                                    names(kBeamColumns),
                                                    names(kCourseColumns)};
  nlohmann::ordered_json sections = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < kSections.size(); ++i)
    sections.push_back({{"name", kSections[i]}, {"columns", columns[i]}});
  return {{"sections", sections}, {"flags", names(kFlags)}};
}

}  // namespace sidestep
