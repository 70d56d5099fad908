// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "deploy/view/camera_images.hpp"
#include "deploy/view/control/control_api.hpp"
#include "deploy/view/fields/robot_fields.hpp"
#include "deploy/view/foxglove/foxglove_server.hpp"
#include "deploy/view/monitor/monitor.hpp"
#include "deploy/view/monitor_recorder.hpp"
#include "deploy/view/network_view.hpp"
#include "deploy/view/planning_scene/planning_scene.hpp"
#include "deploy/view/server/web_server.hpp"

namespace sidestep {

/// Optional capabilities of a monitor; nullptr if it lacks one.
struct MonitorParts {
  ControlApi* control = nullptr;
  NetworkView* network = nullptr;
  MonitorRecorder* recorder = nullptr;
  CameraImages* cameras = nullptr;
  RobotFields* fields = nullptr;
};

/// A monitor and its server.
class MonitorServer {
 public:
  /// The monitor and its parts must outlive this object; after end_run(), only monitor and fields. Throws
  /// std::runtime_error if the port cannot be used.
  MonitorServer(const AccessSettings& access, Monitor& monitor, const MonitorParts& parts);

  WebServer& server() { return server_; }
  /// Prints the address of the page; with the token, if viewers may command, unless `hides_token`.
  void announce(bool hides_token = false) const;
  /// Sends the viewers the data to be shown now. `clock`: the real time.
  void update(Time clock);
  /// From now on shows the run as a recording; see Monitor::end().
  void end_run();

 private:
  static std::vector<std::string> protocols();
  void add(WebSocket& socket, const std::string& protocol);
  bool on_message(WebSocket& socket, const std::string& message, bool is_binary);
  void remove(WebSocket& socket);
  void record(const AnyMessage& message);
  /// Applies a message to the viewer's planning scene. Returns false if the message is invalid.
  bool plan(WebSocket& socket, const std::string& message);
  void send_plan(WebSocket& socket);
  WebResponse respond(const WebRequest& request);
  /// Answers GET /api/fields/3.
  std::optional<WebResponse> fields(const WebRequest& request) const;
  /// Answers GET /api/cameras/0.jpg.
  std::optional<WebResponse> camera_image(const WebRequest& request) const;

  Monitor& monitor_;
  MonitorParts parts_;
  bool is_over_ = false;
  FoxgloveServer foxglove_;
  std::set<WebSocket*> foxglove_viewers_;
  std::map<WebSocket*, PlanningScene> planning_;
  WebServer server_;
};

}  // namespace sidestep
