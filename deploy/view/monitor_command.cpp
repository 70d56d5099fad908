// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor_command.hpp"

#include <atomic>
#include <charconv>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "common/config/scenario_loader.hpp"
#include "common/file/console.hpp"
#include "common/file/folder.hpp"
#include "common/file/write_file.hpp"
#include "common/json/json_text.hpp"
#include "common/log/log.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/audit/metrics/report.hpp"
#include "deploy/inspect/record/playback_bus.hpp"
#include "deploy/view/camera_view.hpp"
#include "deploy/view/control/control_api.hpp"
#include "deploy/view/fields/robot_fields.hpp"
#include "deploy/view/foxglove/foxglove_server.hpp"
#include "deploy/view/monitor/monitor.hpp"
#include "deploy/view/monitor/recorded_messages.hpp"
#include "deploy/view/monitor_recorder.hpp"
#include "deploy/view/network_view.hpp"
#include "deploy/view/page/page_files.hpp"
#include "deploy/view/planning_scene/planning_scene.hpp"
#include "deploy/view/server/viewer_json.hpp"
#include "deploy/view/server/web_server.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

constexpr Duration kPollPeriod = 5ms, kFlushPeriod = 1s;
constexpr const char *kPageProtocol = "sidestep.monitor.v1", *kPlanningProtocol = "sidestep.planning.v1";

struct MonitorOptions {
  std::string file;            ///< a scenario or a recording; empty: the scenario is unknown
  std::string recording_file;  ///< file to write; empty: none
  AccessSettings access;
  std::uint32_t port = 8080;
  bool has_control = false;
  DdsSettings dds;

  bool shows_recording() const { return file.ends_with(".mcap"); }
};

WebResponse not_found(const std::string& path) {
  return {404, "text/plain", fmt::format("there is no {}\n", path)};
}

WebResponse page_file(const WebRequest& request) {
  if (request.method != "GET" && request.method != "HEAD") return {405, "text/plain", "expected GET\n"};
  const PageFile* file = find_page_file(request.path);
  if (file == nullptr) return not_found(request.path);
  return {200, file->content_type, request.method == "GET" ? std::string(file->content) : std::string()};
}

/// Optional capabilities of a monitor; nullptr if it lacks one.
struct MonitorParts {
  ControlApi* control = nullptr;
  NetworkView* network = nullptr;
  MonitorRecorder* recorder = nullptr;
  CameraView* cameras = nullptr;
  RobotFields* fields = nullptr;
};

/// A monitor and its server.
class MonitorServer {
 public:
  MonitorServer(const MonitorOptions& options, Monitor& monitor, const MonitorParts& parts)
      : monitor_(monitor),
        parts_(parts),
        server_(options.access, protocols(),
                {[this](const WebRequest& request) { return respond(request); },
                 [this](WebSocket& socket, const std::string& protocol) { add(socket, protocol); },
                 [this](WebSocket& socket, const std::string& message, bool is_binary) {
                   if (is_binary) return false;
                   if (planning_.contains(&socket)) return plan(socket, message);
                   return foxglove_viewers_.contains(&socket)
                              ? foxglove_.on_message(socket, message)
                              : monitor_.on_message(socket, message, DdsBus::clock());
                 },
                 [this](WebSocket& socket) { remove(socket); }}) {
    monitor_.on_any_message([this](const AnyMessage& message) {
      foxglove_.publish(message, monitor_.now());
      if (parts_.recorder) parts_.recorder->add(message, monitor_.now());
      if (parts_.fields && std::string_view(message.topic.name) == topics::kScan.name)
        parts_.fields->on(*static_cast<const msg::LaserScan*>(message.message), monitor_.floor(),
                          monitor_.now());
    });
    const AccessSettings& access = server_.access();
    print_to(stdout, "monitor: http://{}:{}/{}\n", access.address, access.port,
             access.token.empty() ? "" : "#token=" + access.token);
  }

  WebServer& server() { return server_; }
  /// Sends the viewers the data to be shown now. `clock`: the real time.
  void update(Time clock) {
    monitor_.update_viewers(clock);
    foxglove_.publish_scene(monitor_.floor(), monitor_.radius_m(), monitor_.now());
  }

 private:
  static std::vector<std::string> protocols() {
    std::vector<std::string> names{kPageProtocol, kPlanningProtocol};
    for (const std::string& name : FoxgloveServer::protocols()) names.push_back(name);
    return names;
  }

  void add(WebSocket& socket, const std::string& protocol) {
    if (protocol == kPageProtocol) return monitor_.add_viewer(socket);
    if (protocol == kPlanningProtocol) {
      planning_[&socket];
      return send_plan(socket);
    }
    foxglove_viewers_.insert(&socket);
    foxglove_.add(socket);
  }

  /// Applies a message to the viewer's planning scene. Returns false if the message is invalid.
  bool plan(WebSocket& socket, const std::string& message) {
    if (!planning_[&socket].apply(parse_viewer_json(message))) return false;
    send_plan(socket);
    return true;
  }

  void send_plan(WebSocket& socket) {
    socket.send_state(0, {std::make_shared<const std::string>(json_text(planning_[&socket].json())), false});
  }

  void remove(WebSocket& socket) {
    if (planning_.erase(&socket) > 0) return;
    if (foxglove_viewers_.erase(&socket) > 0)
      foxglove_.remove(socket);
    else
      monitor_.remove_viewer(socket);
  }

  WebResponse respond(const WebRequest& request) {
    if (!request.path.starts_with("/api/")) return page_file(request);
    if (auto response = monitor_.respond(request)) return *response;
    if (parts_.network && request.method == "GET" && request.path == "/api/network")
      return {200, "application/json", parts_.network->json()};
    if (auto response = camera_image(request)) return *response;
    if (auto response = fields(request)) return *response;
    if (parts_.control)
      if (auto response = parts_.control->respond(request)) return *response;
    if (request.method != "GET" && !request.command_refusal.empty())
      return {401, "text/plain", request.command_refusal + "\n"};
    return not_found(request.path);
  }

  static std::optional<std::uint32_t> number_in(std::string_view text) {
    std::uint32_t number = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), number);
    return end.ec == std::errc() && end.ptr == text.data() + text.size() ? std::optional(number)
                                                                         : std::nullopt;
  }

  /// Answers GET /api/fields/3.
  std::optional<WebResponse> fields(const WebRequest& request) {
    constexpr std::string_view kBegin = "/api/fields/";
    if (!parts_.fields || request.method != "GET" || !request.path.starts_with(kBegin)) return std::nullopt;
    const auto robot = number_in(std::string_view(request.path).substr(kBegin.size()));
    if (!robot) return std::nullopt;
    return WebResponse{200, "application/json",
                       json_text(parts_.fields->json(*robot, monitor_.floor(), monitor_.now()))};
  }

  /// Answers GET /api/cameras/0.jpg.
  std::optional<WebResponse> camera_image(const WebRequest& request) {
    constexpr std::string_view kBegin = "/api/cameras/", kEnd = ".jpg";
    const std::string_view path = request.path;
    if (!parts_.cameras || request.method != "GET" || !path.starts_with(kBegin) || !path.ends_with(kEnd))
      return std::nullopt;
    const auto camera = number_in(path.substr(0, path.size() - kEnd.size()).substr(kBegin.size()));
    if (!camera) return std::nullopt;
    const auto jpeg = parts_.cameras->jpeg(*camera, monitor_.floor(), monitor_.now());
    if (!jpeg) return WebResponse{404, "text/plain", "there is no image of this camera yet\n"};
    return WebResponse{200, "image/jpeg", *jpeg};
  }

  Monitor& monitor_;
  MonitorParts parts_;
  FoxgloveServer foxglove_;
  std::set<WebSocket*> foxglove_viewers_;
  std::map<WebSocket*, PlanningScene> planning_;
  WebServer server_;
};

/// A name for a recording that a viewer starts, e.g. recordings/crossing-20261125T180509.mcap; creates its
/// folder.
std::string new_recording_file(const Scenario& scenario) {
  const std::string report = default_report_path(scenario.name, std::nullopt);
  const std::filesystem::path name = std::filesystem::path(report).filename().replace_extension(".mcap");
  const std::string path = (std::filesystem::path("recordings") / name).string();
  create_folder_of(path);
  return path;
}

int monitor_system(const MonitorOptions& options) {
  std::optional<Scenario> scenario;
  if (!options.file.empty()) scenario = load_scenario(options.file);
  std::optional<MonitorRecorder> recorder;
  if (scenario) recorder.emplace(*scenario, options.file);
  if (!options.recording_file.empty()) require_openable(options.recording_file);
  DdsBus bus(options.dds);
  MonitorSettings settings;
  settings.scenario = scenario ? &*scenario : nullptr;
  settings.can_command = options.has_control;
  Monitor monitor(bus, settings);
  std::optional<ControlApi> control;
  if (options.has_control) {
    ControlHooks hooks;
    hooks.bookmark = [&](const std::string& text) {
      monitor.events().add({0, bus.now(), Severity::kInfo, "bookmark", text});
      if (recorder) recorder->add_event(bus.now(), "bookmark", text);
    };
    if (recorder)
      hooks.record = [&](bool begins) -> std::optional<std::string> {
        if (!begins && !recorder->is_recording()) return std::nullopt;
        if (!begins) recorder->stop();
        if (begins && !recorder->is_recording()) recorder->start(new_recording_file(*scenario));
        return recorder->file();
      };
    control.emplace(bus, hooks);
  }
  NetworkView network(options.dds);
  std::optional<CameraView> cameras;
  std::optional<RobotFields> fields;
  if (scenario) {
    cameras.emplace(*scenario, options.dds);
    fields.emplace(*scenario);
  }
  MonitorServer server(options, monitor,
                       {control ? &*control : nullptr, &network, recorder ? &*recorder : nullptr,
                        cameras ? &*cameras : nullptr, fields ? &*fields : nullptr});
  if (recorder)
    recorder->on_failure([&](const std::string& failure) {
      log(LogLevel::kError, "recording: " + failure);
      monitor.events().add({0, bus.now(), Severity::kError, "recording", failure});
    });
  // Only now, because an earlier recording of this name is lost.
  if (!options.recording_file.empty()) recorder->start(options.recording_file);
  const StopSignals stop_signals([&bus] { bus.stop(); });
  call_periodically(bus, Monitor::kFramePeriod, [&] {
    monitor.take_snapshot();
    server.update(bus.now());
    if (recorder) recorder->add_scene(monitor.floor(), bus.now());
  });
  call_periodically(bus, kPollPeriod, [&] {
    server.server().poll();
    if (cameras) cameras->poll(bus.now());
  });
  call_periodically(bus, kFlushPeriod, [&] {
    if (recorder) recorder->flush();
  });
  bus.run();
  if (recorder) recorder->stop();
  return 0;
}

int monitor_recording(const MonitorOptions& options) {
  PlaybackBus bus(options.file);
  const Scenario scenario = bus.scenario();
  MonitorSettings settings;
  settings.scenario = &scenario;
  settings.is_recording = true;
  settings.audit.is_complete = bus.header().is_complete;
  RecordedMessages recorded(options.file, bus);
  settings.recorded_messages = [&recorded](const std::string& channel, Time from, Time to) {
    return recorded.between(channel, from, to);
  };
  Monitor monitor(bus, settings);
  MonitorServer server(options, monitor, {});
  bus.on_event([&monitor](Time at, const std::string& kind, const std::string& text) {
    monitor.events().add({0, at, Severity::kInfo, kind, text});
  });
  std::atomic<bool> is_stopped = false;
  const StopSignals stop_signals([&] {
    is_stopped = true;
    bus.stop();
  });
  PlaybackResult result;
  Time next_snapshot{}, next_update{};
  bool is_over = false;
  while (!is_stopped) {
    // Keeps reading as fast as possible, and serves viewers meanwhile.
    for (int i = 0; i < 500 && !is_over; ++i) {
      is_over = !bus.play_next(result);
      if (!is_over && bus.now() < next_snapshot) continue;
      monitor.set_progress(is_over ? 1 : bus.progress());
      is_over ? monitor.take_last_snapshot() : monitor.take_snapshot();
      next_snapshot = bus.now() + Monitor::kFramePeriod;
      if (is_over && !result.damage.empty())
        fmt::print(stderr, "{}: {}; earlier messages are shown\n", options.file, result.damage);
    }
    if (const Time clock = DdsBus::clock(); clock >= next_update) {
      server.update(clock);
      next_update = clock + Monitor::kFramePeriod;
    }
    is_over ? server.server().run_for(kPollPeriod) : server.server().poll();
  }
  return 0;
}

}  // namespace

void add_monitor_command(const CliCommand& root, std::function<int()>& action) {
  const auto options = std::make_shared<MonitorOptions>();
  options->dds.participant = "sidestep-monitor";
  options->dds.keeps_all = true;
  const CliCommand command =
      root.add_subcommand("monitor", "Shows a running system or a recording in the browser");
  command.add_option("FILE", options->file,
                     "scenario of the running system, or a recording (.mcap); without it, nothing is judged");
  command.add_option("--port", options->port, "TCP port; 0: any free port")
      .check(in_range(0, 65535))
      .show_default();
  command.add_option("--address", options->access.address, "address to listen on").show_default();
  command
      .add_option("--allow-origin", options->access.allowed_origins,
                  "servers whose pages may use this server, e.g. https://example.org")
      .comma_separated();
  command.add_flag("--control", options->has_control,
                   "viewers with the printed token may give orders and cause faults");
  command.add_option("--record", options->recording_file, "also write all messages to this MCAP file");
  add_dds_options(command, options->dds);
  command.on_parsed([options, &action] {
    if (options->shows_recording() && options->has_control)
      throw UsageError("--control: a recording cannot be commanded");
    if (!options->recording_file.empty() && (options->file.empty() || options->shows_recording()))
      throw UsageError("--record: needs the scenario file of a running system");
    options->access.port = static_cast<std::uint16_t>(options->port);
    if (options->has_control) {
      options->access.token = random_token();
      options->dds.is_operator = true;
      options->dds.identity = {Role::kOperator};
    }
    action = [options] {
      return options->shows_recording() ? monitor_recording(*options) : monitor_system(*options);
    };
  });
}

}  // namespace sidestep
