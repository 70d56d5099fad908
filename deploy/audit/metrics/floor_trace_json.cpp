// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/floor_trace_json.hpp"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

// Limits of what is read.
constexpr double kMaxPlace_m = 1e5, kMaxTime_s = 1e9;
constexpr std::size_t kMaxOpponents = 1000;  // as of a scenario

/// Rounds to millimetres, milliseconds and millimetres per second, which pictures do not show.
Json number(double value) {
  return std::isfinite(value) ? Json(std::round(value * 1e3) / 1e3) : Json(nullptr);
}
Json point(const Vec2& p) { return Json::array({number(p.x()), number(p.y())}); }
Json points(const std::vector<Vec2>& list) {
  Json json = Json::array();
  for (const Vec2& p : list) json.push_back(point(p));
  return json;
}
Json numbers(const Vec2& first, const Vec2& second) {
  return Json::array({number(first.x()), number(first.y()), number(second.x()), number(second.y())});
}

Json shape_json(const Shape& shape) {
  if (const auto* circle = std::get_if<Circle>(&shape))
    return {
        {"circle", {number(circle->centre_m.x()), number(circle->centre_m.y()), number(circle->radius_m)}}};
  if (const auto* box = std::get_if<Box>(&shape)) return {{"box", numbers(box->min_m, box->max_m)}};
  if (const auto* segment = std::get_if<Segment>(&shape))
    return {{"segment", numbers(segment->from_m, segment->to_m)}};
  return {{"polygon", points(std::get<ConvexPolygon>(shape).corners_m)}};
}

Json floor_json(const FloorTrace& trace) {
  Json json;
  json["length_m"] = number(trace.field.length_m);
  json["width_m"] = number(trace.field.width_m);
  json["robot_radius_m"] = number(trace.radius_m);
  json["speed_limit_mps"] = number(trace.speed_limit_mps);
  json["obstacles"] = Json::array();
  for (const Shape& shape : trace.obstacles) json["obstacles"].push_back(shape_json(shape));
  json["walls"] = Json::array();
  for (const Box& box : trace.walls) json["walls"].push_back(numbers(box.min_m, box.max_m));
  json["robots"] = Json::array();
  for (const FloorTrace::Robot& robot : trace.robots)
    json["robots"].push_back({{"id", robot.id},
                              {"team", robot.team == Team::kYellow ? "yellow" : "blue"},
                              {"start_m", point(robot.start_m)},
                              {"goals_m", points(robot.goals_m)}});
  json["opponents"] = Json::array();
  for (const OpponentSpec& opponent : trace.opponents)
    json["opponents"].push_back({{"radius_m", number(opponent.radius_m)},
                                 {"speed_mps", number(opponent.speed_mps)},
                                 {"path_m", points(opponent.path_m)}});
  json["opponents_since_s"] = trace.opponents_since_s ? number(*trace.opponents_since_s) : Json(nullptr);
  return json;
}

double read(const Json& json, double limit = kMaxPlace_m) {
  const double value = json.get<double>();
  if (!(std::abs(value) <= limit))
    throw std::invalid_argument(fmt::format("{} is not between -{} and {}", value, limit, limit));
  return value;
}

double read_positive(const Json& json) {
  const double value = read(json);
  if (!(value > 0)) throw std::invalid_argument(fmt::format("{} is not positive", value));
  return value;
}

RobotId read_robot(const Json& json) {
  const double id = json.get<double>();
  if (!(id >= 0 && id < kMaxRobots)) throw std::invalid_argument(fmt::format("{:g} is not a robot", id));
  return static_cast<RobotId>(id);
}

Vec2 read_point(const Json& json, std::size_t first = 0) {
  return {read(json.at(first)), read(json.at(first + 1))};
}

Box read_box(const Json& json) {
  const Vec2 first = read_point(json), second = read_point(json, 2);
  return {first.cwiseMin(second), first.cwiseMax(second)};
}

std::vector<Vec2> read_points(const Json& json) {
  std::vector<Vec2> list;
  for (const Json& item : json) list.push_back(read_point(item));
  return list;
}

Shape read_shape(const Json& json) {
  if (json.contains("circle"))
    return Circle{read_point(json.at("circle")), read_positive(json.at("circle").at(2))};
  if (json.contains("box")) return read_box(json.at("box"));
  if (json.contains("segment"))
    return Segment{read_point(json.at("segment")), read_point(json.at("segment"), 2)};
  ConvexPolygon polygon{read_points(json.at("polygon"))};
  if (polygon.corners_m.empty()) throw std::invalid_argument("a polygon has no corners");
  return polygon;
}

std::vector<FloorTrace::Point> read_path(const Json& json) {
  std::vector<FloorTrace::Point> path;
  for (const Json& item : json) {
    path.push_back({read(item.at(0), kMaxTime_s), read_point(item, 1), read(item.at(3))});
    if (path.size() > 1 && path[path.size() - 2].at_s > path.back().at_s)
      throw std::invalid_argument("the times of a path do not ascend");
  }
  return path;
}

FloorTrace read_trace(const Json& report) {
  const Json& floor = report.at("floor");
  FloorTrace trace;
  trace.field = {read_positive(floor.at("length_m")), read_positive(floor.at("width_m"))};
  trace.radius_m = read_positive(floor.at("robot_radius_m"));
  trace.speed_limit_mps = read(floor.at("speed_limit_mps"));
  for (const Json& shape : floor.at("obstacles")) trace.obstacles.push_back(read_shape(shape));
  for (const Json& box : floor.at("walls")) trace.walls.push_back(read_box(box));
  const Json& paths = report.at("paths");
  if (!paths.is_object()) throw std::invalid_argument("paths: expected an object");
  std::set<RobotId> ids;
  for (const Json& json : floor.at("robots")) {
    FloorTrace::Robot& robot = trace.robots.emplace_back();
    robot.id = read_robot(json.at("id"));
    if (!ids.insert(robot.id).second)
      throw std::invalid_argument(fmt::format("there are two robots {}", robot.id));
    robot.team = json.at("team") == "yellow" ? Team::kYellow : Team::kBlue;
    robot.start_m = read_point(json.at("start_m"));
    robot.goals_m = read_points(json.at("goals_m"));
    if (const auto path = paths.find(std::to_string(robot.id)); path != paths.end())
      robot.path = read_path(*path);
  }
  if (floor.at("opponents").size() > kMaxOpponents)
    throw std::invalid_argument(fmt::format("there are more than {} opponents", kMaxOpponents));
  for (const Json& json : floor.at("opponents")) {
    OpponentSpec& opponent = trace.opponents.emplace_back();
    opponent = {read_positive(json.at("radius_m")), read(json.at("speed_mps")),
                read_points(json.at("path_m"))};
    if (opponent.path_m.empty()) throw std::invalid_argument("an opponent has no place");
  }
  if (const Json& since = floor.at("opponents_since_s"); !since.is_null())
    trace.opponents_since_s = read(since, kMaxTime_s);
  for (const Json& json : report.at("incidents")) {
    FloorTrace::Incident& incident = trace.incidents.emplace_back();
    incident.at_s = read(json.at("at_s"), kMaxTime_s);
    incident.kind = json.at("kind").get<std::string>();
    for (const Json& robot : json.at("robots")) incident.robots.push_back(read_robot(robot));
    incident.position_m = read_point(json.at("at_m"));
  }
  return trace;
}

}  // namespace

void add_floor_trace(Json& report, const FloorTrace& trace) {
  report["floor"] = floor_json(trace);
  Json& paths = report["paths"] = Json::object();
  for (const FloorTrace::Robot& robot : trace.robots) {
    Json& path = paths[std::to_string(robot.id)] = Json::array();
    for (const FloorTrace::Point& p : robot.path)
      path.push_back(Json::array(
          {number(p.at_s), number(p.position_m.x()), number(p.position_m.y()), number(p.speed_mps)}));
  }
  report["incidents"] = Json::array();
  for (const FloorTrace::Incident& incident : trace.incidents)
    report["incidents"].push_back({{"at_s", number(incident.at_s)},
                                   {"kind", incident.kind},
                                   {"robots", incident.robots},
                                   {"at_m", point(incident.position_m)}});
}

std::optional<FloorTrace> floor_trace_of(const Json& report) try {
  if (!report.contains("floor") || report.at("floor").is_null()) return std::nullopt;
  return read_trace(report);
} catch (const std::exception& error) {
  throw std::invalid_argument(fmt::format("the floor or the paths are damaged: {}", error.what()));
}

}  // namespace sidestep
