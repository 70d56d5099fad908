// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>

#include "common/messaging/bus.hpp"
#include "deploy/inspect/floor/floor_state.hpp"
#include "deploy/view/monitor/closest_pair.hpp"
#include "deploy/view/monitor/event_log.hpp"
#include "deploy/view/monitor/event_watch.hpp"
#include "deploy/view/monitor/history.hpp"
#include "deploy/view/monitor/run_assessment.hpp"
#include "deploy/view/monitor/topic_traffic.hpp"
#include "deploy/view/monitor/viewer_time.hpp"
#include "deploy/view/monitor/waits.hpp"
#include "deploy/view/server/web_server.hpp"

namespace sidestep {

struct MonitorSettings {
  const Scenario* scenario = nullptr;  ///< nullptr: unknown, so that the run cannot be judged
  AuditInput audit;
  bool is_recording = false;  ///< the messages come from a recording
  bool can_command = false;   ///< the page shows elements that give commands
  /// For a recording: the messages of a channel in an interval (see RecordedMessages). Empty: viewers get
  /// messages as they are received.
  std::function<std::vector<std::string>(const std::string& channel, Time from, Time to)> recorded_messages;
};

/// Shows a run to viewers: collects its messages, remembers the states of the floor, and sends each viewer
/// the state at its chosen moment. For the messages of viewers see README.md in this folder.
class Monitor {
 public:
  /// Subscribes to all topics except images. The bus must be used for nothing else. The bus and the scenario
  /// must outlive this object.
  Monitor(Bus& bus, const MonitorSettings& settings);
  ~Monitor();
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;

  static constexpr Duration kFramePeriod = std::chrono::milliseconds(25);
  static constexpr Duration kPanelPeriod = std::chrono::milliseconds(500);

  /// Takes a snapshot of the floor. Call it every kFramePeriod of the run.
  void take_snapshot();
  /// Takes the snapshot of the end of a run or of a recording; its panels show the final verdict.
  void take_last_snapshot();
  /// Ends the run: from now on it is shown as a recording, and the bus is no longer used. Viewers stay at the
  /// moment that they see.
  void end();
  /// Sends each viewer the state at its chosen moment. Call it often. `clock` is the real time.
  void update_viewers(Time clock);
  /// For a recording: how much of it has been read, 0 to 1. At first it is 0.
  void set_progress(double progress) { progress_ = progress; }

  /// Answers GET requests whose path starts with /api/. nullopt if there is no such path.
  std::optional<WebResponse> respond(const WebRequest& request);
  void add_viewer(WebSocket& socket);
  void remove_viewer(WebSocket& socket);
  /// Processes a message from a viewer. False: the message is invalid.
  [[nodiscard]] bool on_message(WebSocket& socket, const std::string& message, Time clock);

  /// Calls back with every message that is received.
  void on_any_message(std::function<void(const AnyMessage&)> callback) {
    on_any_message_ = std::move(callback);
  }
  double radius_m() const { return rules_.radius_m; }
  /// The time of the run.
  Time now() const { return ended_at_ ? *ended_at_ : bus_.now(); }

  EventLog& events() { return events_; }
  const FloorState& floor() const { return floor_; }

 private:
  struct Viewer {
    ViewerTime time;
    Time shown{};
    bool has_chosen = false;  ///< has chosen a moment; until then a recording shows its first granted one
    std::shared_ptr<const std::string> frame, panels, whole, time_text;
    std::optional<std::string> inspected;  ///< the inspected channel
    std::optional<Time> inspected_until;   ///< for a recording: messages up to this time have been sent
    Time next_inspection{};                ///< by the real-time clock
  };

  struct Channel {
    TopicInfo topic;
    std::string name;
    std::uint32_t number;
  };
  template <typename Message>
  void subscribe(const Topic<Message>& topic, RobotId robot);
  template <typename Message>
  void receive(const Channel& channel, const Message& message);
  /// Subscribes to the channels of a robot, unless already subscribed.
  void follow_robot(RobotId robot);
  void follow(const msg::WorldState& world);
  void follow(const msg::AgentStatus& status) { follow_robot(status.robot()); }
  template <typename Message>
  void follow(const Message&) {}
  /// Makes the texts of the panels and of the verdict on the whole run.
  void update_panels();
  /// Shows a viewer of a recording the first granted moment, or the start if nothing was granted.
  void open_recording(Viewer& viewer) const;
  nlohmann::ordered_json panels();
  nlohmann::ordered_json scene() const;
  Waits waits() const { return waits_on(floor_, rules_, bus_.now()); }
  Snapshot snapshot_at(Time at) const;
  void send_time(WebSocket& socket, Viewer& viewer);
  void send_inspections();
  /// Forgets inspections that nobody is watching.
  void forget_inspections();
  void send_recorded_messages(WebSocket& socket, Viewer& viewer, Time clock);

  Bus& bus_;
  MonitorSettings settings_;
  const FloorRules rules_;  ///< those of the scenario, or defaults
  FloorState floor_;
  EventLog events_;
  EventWatch event_watch_{events_};
  TopicTraffic traffic_;
  std::unique_ptr<RunAssessment> assessment_;  ///< null if the scenario is unknown
  History history_;
  std::set<RobotId> followed_;
  std::set<std::string> channels_;
  std::map<WebSocket*, Viewer> viewers_;
  /// Messages in JSON that were received since the last sending, by channel.
  std::map<std::string, std::deque<std::string>> inspections_;
  std::shared_ptr<const std::string> latest_panels_, whole_;
  Time panels_at_{}, heard_at_{};
  std::optional<Time> first_grant_;  ///< time of the first snapshot that shows a granted motion
  std::optional<Time> ended_at_;     ///< when the run ended; see end()
  std::optional<ClosestPair> closest_pair_, smallest_;
  double progress_;
  std::function<void(const AnyMessage&)> on_any_message_;
};

}  // namespace sidestep
