// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor_server.hpp"

#include <charconv>
#include <cstdio>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>

#include "common/file/console.hpp"
#include "common/json/json_text.hpp"
#include "common/messaging/dds/bus.hpp"
#include "deploy/view/page/page_files.hpp"
#include "deploy/view/server/viewer_json.hpp"

namespace sidestep {
namespace {

constexpr const char *kPageProtocol = "sidestep.monitor.v1", *kPlanningProtocol = "sidestep.planning.v1";

WebResponse page_file(const WebRequest& request) {
  if (request.method != "GET" && request.method != "HEAD") return {405, "text/plain", "expected GET\n"};
  const PageFile* file = find_page_file(request.path);
  if (file == nullptr) return {404, "text/plain", fmt::format("there is no {}\n", request.path)};
  return {200, file->content_type, request.method == "GET" ? std::string(file->content) : std::string()};
}

WebResponse api_error(unsigned status, const std::string& error) {
  return {status, "application/json", json_text(nlohmann::json{{"error", error}}) + "\n"};
}

std::optional<std::uint32_t> number_in(std::string_view text) {
  std::uint32_t number = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), number);
  return end.ec == std::errc() && end.ptr == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

}  // namespace

MonitorServer::MonitorServer(const AccessSettings& access, Monitor& monitor, const MonitorParts& parts)
    : monitor_(monitor),
      parts_(parts),
      server_(access, protocols(),
              {[this](const WebRequest& request) { return respond(request); },
               [this](WebSocket& socket, const std::string& protocol) { add(socket, protocol); },
               [this](WebSocket& socket, const std::string& message, bool is_binary) {
                 return on_message(socket, message, is_binary);
               },
               [this](WebSocket& socket) { remove(socket); },
               [this](const WebRequest& request, const WebReply& reply) {
                 return parts_.control && parts_.control->respond(request, reply);
               }}) {
  monitor_.on_any_message([this](const AnyMessage& message) { record(message); });
}

void MonitorServer::announce(bool hides_token) const {
  const AccessSettings& access = server_.access();
  print_to(stdout, "monitor: http://{}:{}/{}\n", access.address, access.port,
           hides_token || access.token.empty() ? "" : "#token=" + access.token);
}

void MonitorServer::update(Time clock) {
  monitor_.update_viewers(clock);
  if (!is_over_) foxglove_.publish_scene(monitor_.floor(), monitor_.radius_m(), monitor_.now());
}

void MonitorServer::end_run() {
  monitor_.end();
  is_over_ = true;
  parts_ = {nullptr, nullptr, nullptr, nullptr, parts_.fields};
}

std::vector<std::string> MonitorServer::protocols() {
  std::vector<std::string> names{kPageProtocol, kPlanningProtocol};
  for (const std::string& name : FoxgloveServer::protocols()) names.push_back(name);
  return names;
}

void MonitorServer::record(const AnyMessage& message) {
  foxglove_.publish(message, monitor_.now());
  if (parts_.recorder) parts_.recorder->add(message, monitor_.now());
  if (parts_.fields && std::string_view(message.topic.name) == topics::kScan.name)
    parts_.fields->on(*static_cast<const msg::LaserScan*>(message.message), monitor_.floor(), monitor_.now());
}

void MonitorServer::add(WebSocket& socket, const std::string& protocol) {
  if (protocol == kPageProtocol) return monitor_.add_viewer(socket);
  if (protocol == kPlanningProtocol) {
    planning_[&socket];
    return send_plan(socket);
  }
  foxglove_viewers_.insert(&socket);
  foxglove_.add(socket);
}

bool MonitorServer::on_message(WebSocket& socket, const std::string& message, bool is_binary) {
  if (is_binary) return false;
  if (planning_.contains(&socket)) return plan(socket, message);
  return foxglove_viewers_.contains(&socket) ? foxglove_.on_message(socket, message)
                                             : monitor_.on_message(socket, message, DdsBus::clock());
}

void MonitorServer::remove(WebSocket& socket) {
  if (planning_.erase(&socket) > 0) return;
  if (foxglove_viewers_.erase(&socket) > 0)
    foxglove_.remove(socket);
  else
    monitor_.remove_viewer(socket);
}

bool MonitorServer::plan(WebSocket& socket, const std::string& message) {
  if (!planning_[&socket].apply(parse_viewer_json(message))) return false;
  send_plan(socket);
  return true;
}

void MonitorServer::send_plan(WebSocket& socket) {
  socket.send_state(0, {std::make_shared<const std::string>(json_text(planning_[&socket].json())), false});
}

WebResponse MonitorServer::respond(const WebRequest& request) {
  if (!request.path.starts_with("/api/")) return page_file(request);
  if (auto response = monitor_.respond(request)) return *response;
  if (parts_.network && request.method == "GET" && request.path == "/api/network")
    return {200, "application/json", parts_.network->json()};
  if (auto response = camera_image(request)) return *response;
  if (auto response = fields(request)) return *response;
  const bool has_control = !server_.access().token.empty(), is_get = request.method == "GET";
  const bool is_control = !is_get || ControlApi::has_path(request.path);
  // With control, whoever sees the page may get the state of an order.
  if (is_control && !(is_get && has_control) && !request.command_refusal.empty())
    return api_error(401, request.command_refusal);
  if (is_control && is_over_) return api_error(409, "the run is over");
  return api_error(404, "there is no " + request.path);
}

std::optional<WebResponse> MonitorServer::fields(const WebRequest& request) const {
  constexpr std::string_view kBegin = "/api/fields/";
  if (!parts_.fields || request.method != "GET" || !request.path.starts_with(kBegin)) return std::nullopt;
  const auto robot = number_in(std::string_view(request.path).substr(kBegin.size()));
  if (!robot) return std::nullopt;
  return WebResponse{200, "application/json",
                     json_text(parts_.fields->json(*robot, monitor_.floor(), monitor_.now()))};
}

std::optional<WebResponse> MonitorServer::camera_image(const WebRequest& request) const {
  constexpr std::string_view kBegin = "/api/cameras/", kEnd = ".jpg";
  const std::string_view path = request.path;
  if (!parts_.cameras || request.method != "GET" || !path.starts_with(kBegin) || !path.ends_with(kEnd))
    return std::nullopt;
  const auto camera = number_in(path.substr(0, path.size() - kEnd.size()).substr(kBegin.size()));
  if (!camera) return std::nullopt;
  const auto jpeg = parts_.cameras->jpeg(*camera, monitor_.floor(), monitor_.now());
  if (!jpeg) return api_error(404, "there is no image of this camera yet");
  return WebResponse{200, "image/jpeg", *jpeg};
}

}  // namespace sidestep
