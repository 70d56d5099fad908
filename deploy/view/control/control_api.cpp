// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/control/control_api.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/json/json_text.hpp"
#include "common/messaging/blockage_text.hpp"
#include "common/messaging/disturbance_answer.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/messaging/refusal_text.hpp"
#include "common/messaging/version_codec.hpp"
#include "common/protocol/client_text.hpp"
#include "common/protocol/disturbance_text.hpp"
#include "common/protocol/robot_disturbance.hpp"
#include "common/yaml/heading.hpp"
#include "deploy/view/server/viewer_json.hpp"

namespace sidestep {
namespace {

constexpr auto kOperator = static_cast<ClientId>(Sender::kOperator);

using Json = nlohmann::json;
using Kind = msg::DisturbanceKind;

/// Thrown if the request's body is wrong; the message names the error.
class BodyError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

WebResponse json_response(unsigned status, const Json& json) {
  return {status, "application/json", json_text(json) + "\n"};
}
WebResponse error_response(unsigned status, const std::string& error) {
  return json_response(status, {{"error", error}});
}

/// Splits at slashes: "robots/3/order" becomes ["robots", "3", "order"].
std::vector<std::string> split(std::string_view rest) {
  std::vector<std::string> parts;
  while (true) {
    const std::size_t slash = rest.find('/');
    parts.emplace_back(rest.substr(0, slash));
    if (slash == std::string_view::npos) return parts;
    rest.remove_prefix(slash + 1);
  }
}

/// The parts of a path below "/api/"; none if it is elsewhere.
std::vector<std::string> parts_of(std::string_view path) {
  constexpr std::string_view kPrefix = "/api/";
  return path.starts_with(kPrefix) ? split(path.substr(kPrefix.size())) : std::vector<std::string>{};
}

/// A number in the paths of routes.
struct PathNumber {
  std::string_view placeholder;  ///< the name of what it numbers, in braces
  std::uint64_t max;
  std::string_view name() const { return placeholder.substr(1, placeholder.size() - 2); }
};
constexpr std::array kPathNumbers{PathNumber{"{robot}", kMaxRobots - 1},
                                  PathNumber{"{zone}", std::numeric_limits<std::uint32_t>::max()},
                                  PathNumber{"{order}", std::numeric_limits<OrderHandle>::max()}};

/// The number for which a part of a route's path stands; nullptr if it stands for itself.
const PathNumber* path_number(const std::string& part) {
  const auto found = std::ranges::find(kPathNumbers, part, &PathNumber::placeholder);
  return found == kPathNumbers.end() ? nullptr : &*found;
}

/// Whether a path may be that of a route, whatever stands in place of its numbers.
bool matches(std::string_view route, std::span<const std::string> parts) {
  return std::ranges::equal(split(route), parts, [](const std::string& expected, const std::string& part) {
    return path_number(expected) || expected == part;
  });
}

template <typename Number>
std::optional<Number> parse_number(const std::string& text) {
  Number number = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), number);
  if (end.ec != std::errc() || end.ptr != text.data() + text.size()) return std::nullopt;
  return number;
}

Json parse_body(const std::string& body) {
  Json json = parse_viewer_json(body);
  if (!json.is_object())
    throw BodyError(
        fmt::format("the body: expected a JSON object, nested no deeper than {} times", kMaxViewerJsonDepth));
  return json;
}

double number_from(const Json& json, const std::string& name, double min, double max) {
  const double value = json.is_number() ? json.get<double>() : std::nan("");
  if (!(value >= min && value <= max))
    throw BodyError(
        fmt::format("{}: expected a number from {:g} to {:g}, got {}", name, min, max, json_text(json)));
  return value;
}

double heading_from(const Json& json, const std::string& name) {
  if (!json.is_number()) throw BodyError(fmt::format("{}: expected radians, got {}", name, json_text(json)));
  const auto heading_rad = json.get<double>();
  if (const std::string problem = heading_problem(heading_rad); !problem.empty())
    throw BodyError(fmt::format("{}: {}", name, problem));
  return heading_rad;
}

double number_in(const Json& body, const char* key, double min, double max, std::optional<double> otherwise) {
  if (body.contains(key)) return number_from(body[key], key, min, max);
  if (!otherwise) throw BodyError(fmt::format("{}: is missing", key));
  return *otherwise;
}

void require_known_keys(const Json& body, std::initializer_list<std::string_view> known) {
  for (const auto& [key, value] : body.items())
    if (std::ranges::find(known, key) == known.end())
      throw BodyError(fmt::format("{}: is unknown, expected {}", key, fmt::join(known, ", ")));
}

/// A list of points: two coordinates each, and a heading if `max_numbers` is 3.
std::vector<std::vector<double>> points_in(const Json& body, const char* key, std::size_t max_points,
                                           std::size_t max_numbers) {
  const Json list = body.value(key, Json());
  if (!list.is_array() || list.empty() || list.size() > max_points)
    throw BodyError(fmt::format("{}: expected a list of 1 to {} points", key, max_points));
  std::vector<std::vector<double>> points;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string name = fmt::format("{}[{}]", key, i);
    if (!list[i].is_array() || list[i].size() < 2 || list[i].size() > max_numbers)
      throw BodyError(
          fmt::format("{}: expected a list of 2{} numbers", name, max_numbers > 2 ? " or 3" : ""));
    std::vector<double>& point = points.emplace_back();
    for (std::size_t k = 0; k < list[i].size(); ++k) {
      const std::string of_number = fmt::format("{}[{}]", name, k);
      point.push_back(k == 2 ? heading_from(list[i][k], of_number)
                             : number_from(list[i][k], of_number, -kMaxCoordinate_m, kMaxCoordinate_m));
    }
  }
  return points;
}

msg::Disturbance disturbance_from(RobotId robot, const Json& body) {
  require_known_keys(body, {"kind", "vx_mps", "vy_mps", "grip", "x_m", "y_m", "heading_rad", "seconds"});
  constexpr std::array kKinds{Kind::DISTURBANCE_PUSH,       Kind::DISTURBANCE_SLIP,
                              Kind::DISTURBANCE_BLOCK,      Kind::DISTURBANCE_LIFT,
                              Kind::DISTURBANCE_PLACE,      Kind::DISTURBANCE_REBOOT,
                              Kind::DISTURBANCE_SWITCH_OFF, Kind::DISTURBANCE_SWITCH_ON};
  const Json name = body.value("kind", Json());
  const auto kind = std::ranges::find_if(
      kKinds, [&](Kind known) { return name.is_string() && name.get<std::string>() == to_text(known); });
  if (kind == kKinds.end()) {
    std::string known;
    for (const Kind k : kKinds) known += std::string(known.empty() ? "" : ", ") + to_text(k);
    throw BodyError("kind: expected one of: " + known);
  }
  const bool is_push = *kind == Kind::DISTURBANCE_PUSH, is_place = *kind == Kind::DISTURBANCE_PLACE;
  const auto required = [](bool is_required) { return is_required ? std::nullopt : std::optional(0.0); };
  msg::Disturbance disturbance;
  disturbance.robot(robot);
  disturbance.disturbance_kind(*kind);
  disturbance.vx_mps(number_in(body, "vx_mps", -kMaxPush_mps, kMaxPush_mps, required(is_push)));
  disturbance.vy_mps(number_in(body, "vy_mps", -kMaxPush_mps, kMaxPush_mps, required(is_push)));
  disturbance.grip(number_in(body, "grip", 0, 1, required(*kind == Kind::DISTURBANCE_SLIP)));
  disturbance.x_m(number_in(body, "x_m", -1000, 1000, required(is_place)));
  disturbance.y_m(number_in(body, "y_m", -1000, 1000, required(is_place)));
  if (body.contains("heading_rad")) disturbance.heading_rad(heading_from(body["heading_rad"], "heading_rad"));
  disturbance.duration_ns(std::llround(number_in(body, "seconds", 0.001, 3600, 1.0) * 1e9));
  return disturbance;
}

const char* to_text(OrderPhase phase) {
  constexpr std::array kTexts{"sent", "accepted", "driving", "blocked", "arrived", "replaced", "refused"};
  return kTexts[static_cast<std::size_t>(phase)];
}

/// Why an order was refused, or why its robot is blocked; empty if it is neither.
std::string reason_of(const SentOrder& sent) {
  if (sent.phase == OrderPhase::kRefused) return refusal_text(sent.refusal);
  return sent.phase == OrderPhase::kBlocked && sent.blockage ? to_text(*sent.blockage) : std::string();
}

WebResponse fault_response(RobotId robot, const std::optional<msg::DisturbanceResult>& result) {
  if (!result)
    return error_response(504,
                          "the simulator does not answer, so the fault may or may not have been applied");
  if (*result == msg::DisturbanceResult::FAULT_APPLIED) return json_response(200, Json::object());
  const unsigned status = *result == msg::DisturbanceResult::FAULT_UNKNOWN_ROBOT ? 404
                          : *result == msg::DisturbanceResult::FAULT_INVALID     ? 400
                                                                                 : 409;
  return error_response(status, refusal_text(robot, *result));
}

WebResponse accepted(OrderHandle handle) { return json_response(200, {{"order", handle}}); }

}  // namespace

ControlApi::ControlApi(Bus& bus, ControlHooks hooks)
    : hooks_(std::move(hooks)),
      client_(bus, kOperator),
      disturbance_writer_(bus.relay(topics::kDisturbance, topics::kDisturbance.name)),
      disturbances_(bus, *disturbance_writer_) {}

ControlApi::~ControlApi() { disturbances_.give_up(); }

bool ControlApi::respond(const WebRequest& request, const WebReply& reply) {
  const std::vector<std::string> path = parts_of(request.path);
  const std::vector<const Route*> routes = routes_of(path);
  const bool is_get = request.method == "GET";
  if (path.empty() || (is_get && routes.empty())) return false;
  if (!is_get && !request.command_refusal.empty()) {
    reply(error_response(401, request.command_refusal));
    return true;
  }
  try {
    if (const auto response = command(request, path, routes, reply)) reply(*response);
  } catch (const BodyError& error) {
    reply(error_response(400, error.what()));
  }
  return true;
}

std::optional<WebResponse> ControlApi::command(const WebRequest& request, std::span<const std::string> path,
                                               std::span<const Route* const> routes, const WebReply& reply) {
  if (routes.empty()) return error_response(404, "there is no " + request.path);
  const auto route = std::ranges::find(routes, request.method, &Route::method);
  if (route == routes.end()) {
    std::vector<std::string_view> methods;
    std::ranges::transform(routes, std::back_inserter(methods), &Route::method);
    return error_response(405, fmt::format("use {}", fmt::join(methods, " or ")));
  }
  std::uint64_t number = 0;
  const std::vector<std::string> parts = split((*route)->path);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PathNumber* kind = path_number(parts[i]);
    if (!kind) continue;
    const auto given = parse_number<std::uint64_t>(path[i]);
    if (!given || *given > kind->max)
      return error_response(404, fmt::format("there is no {} {}", kind->name(), path[i]));
    number = *given;
  }
  return (*route)->answer(*this, {number, request.body, reply});
}

bool ControlApi::has_path(const std::string& path) { return !routes_of(parts_of(path)).empty(); }

std::vector<const ControlApi::Route*> ControlApi::routes_of(std::span<const std::string> path) {
  std::vector<const Route*> routes;
  for (const Route& route : all_routes())
    if (matches(route.path, path)) routes.push_back(&route);
  return routes;
}

std::span<const ControlApi::Route> ControlApi::all_routes() {
  using Answer = std::optional<WebResponse>;
  using Api = ControlApi;
  static constexpr auto kRoutes = std::to_array<Route>({
      {"GET", "orders/{order}",
       [](Api& api, const Command& c) -> Answer { return api.order_state(c.number); }},
      {"POST", "hold",
       [](Api& api, const Command&) -> Answer { return accepted(api.client_.hold(kAllRobots)); }},
      {"POST", "resume",
       [](Api& api, const Command&) -> Answer { return accepted(api.client_.resume(kAllRobots)); }},
      {"POST", "bookmark", [](Api& api, const Command& c) -> Answer { return api.bookmark(c.body); }},
      {"POST", "recording/start", [](Api& api, const Command&) -> Answer { return api.record(true); }},
      {"POST", "recording/stop", [](Api& api, const Command&) -> Answer { return api.record(false); }},
      {"POST", "zones/{zone}",
       [](Api& api, const Command& c) -> Answer { return api.set_zone(c.id(), c.body); }},
      {"DELETE", "zones/{zone}",
       [](Api& api, const Command& c) -> Answer { return api.remove_zone(c.id()); }},
      {"POST", "robots/{robot}/order",
       [](Api& api, const Command& c) -> Answer { return api.go(c.id(), c.body); }},
      {"POST", "robots/{robot}/cancel",
       [](Api& api, const Command& c) -> Answer { return accepted(api.client_.cancel(c.id())); }},
      {"POST", "robots/{robot}/hold",
       [](Api& api, const Command& c) -> Answer { return accepted(api.client_.hold(c.id())); }},
      {"POST", "robots/{robot}/resume",
       [](Api& api, const Command& c) -> Answer { return accepted(api.client_.resume(c.id())); }},
      {"POST", "robots/{robot}/fault",
       [](Api& api, const Command& c) -> Answer {
         api.disturb(c.id(), c.body, c.reply);
         return std::nullopt;
       }},
  });
  return kRoutes;
}

WebResponse ControlApi::bookmark(const std::string& body) {
  const Json text = parse_body(body).value("text", Json(""));
  if (!text.is_string()) throw BodyError("text: expected a text");
  hooks_.bookmark(text.get<std::string>());
  return json_response(200, Json::object());
}

WebResponse ControlApi::record(bool begins) {
  if (!hooks_.record) return error_response(409, "without a scenario file, nothing can be recorded");
  try {
    const std::optional<std::string> file = hooks_.record(begins);
    return file ? json_response(200, {{"file", *file}}) : error_response(409, "nothing is being recorded");
  } catch (const std::runtime_error& error) {
    return error_response(500, error.what());
  }
}

WebResponse ControlApi::go(RobotId robot, const std::string& body) {
  const Json json = parse_body(body);
  require_known_keys(json, {"goals"});
  std::vector<Goal> goals;
  for (const std::vector<double>& point : points_in(json, "goals", msg::MAX_ORDER_POSES, 3)) {
    Goal& goal = goals.emplace_back(Goal{{point[0], point[1]}});
    if (point.size() > 2) goal.heading_rad = point[2];
  }
  return accepted(client_.go(robot, std::move(goals)));
}

WebResponse ControlApi::set_zone(std::uint32_t number, const std::string& body) {
  const Json json = parse_body(body);
  require_known_keys(json, {"corners", "radius_m", "speed_limit_mps"});
  Zone zone;
  for (const std::vector<double>& point : points_in(json, "corners", kMaxZoneCorners, 2))
    zone.corners_m.emplace_back(point[0], point[1]);
  zone.radius_m = number_in(json, "radius_m", 0, 1000, 0.0);
  if (json.contains("speed_limit_mps"))
    zone.speed_limit_mps =
        number_in(json, "speed_limit_mps", kMinSpeedLimit_mps, kMaxSpeed_mps, std::nullopt);
  return accepted(client_.zone(number, std::move(zone)));
}

WebResponse ControlApi::remove_zone(std::uint32_t number) {
  if (client_.may_have_zone(number)) return accepted(client_.remove_zone(number));
  return error_response(404, unknown_zone_text(number, kOperator, {}, client_.remembered_orders()->zones()));
}

void ControlApi::disturb(RobotId robot, const std::string& body, const WebReply& reply) {
  disturbances_.send(disturbance_from(robot, parse_body(body)),
                     [robot, reply](const std::optional<msg::DisturbanceResult>& result) {
                       reply(fault_response(robot, result));
                     });
}

WebResponse ControlApi::order_state(OrderHandle handle) const {
  const SentOrder* sent = client_.find(handle);
  if (!sent) return error_response(404, fmt::format("there is no order {}", handle));
  const RobotId robot = sent->order.robot;
  Json state{{"order", handle},
             {"robot", robot == kAllRobots ? Json("all") : Json(robot)},
             {"phase", to_text(sent->phase)},
             {"goal_index", sent->goal_index}};
  if (const std::string reason = reason_of(*sent); !reason.empty()) state["reason"] = reason;
  return json_response(200, state);
}

}  // namespace sidestep
