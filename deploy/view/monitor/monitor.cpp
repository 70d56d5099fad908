// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/monitor.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <concepts>
#include <nlohmann/json.hpp>

#include "common/config/shared_rules.hpp"
#include "common/json/json_text.hpp"
#include "deploy/inspect/topic/describe.hpp"
#include "deploy/view/monitor/exact_numbers.hpp"
#include "deploy/view/monitor/floor_frame.hpp"
#include "deploy/view/monitor/inspected_message.hpp"
#include "deploy/view/monitor/panels.hpp"
#include "deploy/view/monitor/scene.hpp"
#include "deploy/view/monitor/trails.hpp"
#include "deploy/view/monitor/unix_time.hpp"
#include "deploy/view/server/viewer_json.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

enum Slot : unsigned { kFrameSlot, kPanelSlot, kWholeSlot, kTimeSlot, kInspectionSlot };
constexpr std::size_t kMaxInspected = 500;  // number of messages that are kept for slow viewers
constexpr double kMaxPlaySpeed = 100;
constexpr std::size_t kHistoryBytes = 512 << 20;
/// The panels of larger fleets are too long to be sent every half second.
constexpr std::size_t kLargeFleet = 200;

std::string text_of(const Json& json) { return json_text(json); }
std::shared_ptr<const std::string> shared_text(const Json& json) {
  return std::make_shared<const std::string>(text_of(json));
}

bool shows_grant(const FloorState& floor) {
  return std::ranges::any_of(floor.robots(),
                             [](const auto& robot) { return robot.second.granted.has_value(); });
}

/// `is_new`: the messages do not continue those that were sent before.
template <typename Messages>
std::shared_ptr<const std::string> messages_text(const std::string& channel, bool is_new,
                                                 const Messages& messages) {
  std::string text = R"({"type":"messages","channel":)" + text_of(channel);
  text += std::string(R"(,"is_new":)") + (is_new ? "true" : "false") + R"(,"messages":[)";
  std::string separator;
  for (const std::string& message : messages) text += std::exchange(separator, ",") + message;
  return std::make_shared<const std::string>(text + "]}");
}

std::optional<double> number_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number()) return std::nullopt;
  const double value = found->get<double>();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// The member `at_s` as a time; nullopt if it is missing or out of range.
std::optional<Time> time_in(const Json& json) {
  const std::optional<double> at_s = number_in(json, "at_s");
  return at_s ? time_at(*at_s) : std::nullopt;
}

/// nullopt if the text is no number.
template <typename Number>
std::optional<Number> parsed(const std::string& text) {
  Number number{};
  const auto end = std::from_chars(text.data(), text.data() + text.size(), number);
  return end.ec == std::errc() && end.ptr == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

/// The query's `at_s` as a time; nullopt if it is missing, no number, or out of range.
std::optional<Time> time_in(const std::map<std::string, std::string>& query) {
  const auto given = query.find("at_s");
  const auto at_s = given == query.end() ? std::nullopt : parsed<double>(given->second);
  return at_s ? time_at(*at_s) : std::nullopt;
}

}  // namespace

Monitor::Monitor(Bus& bus, const MonitorSettings& settings)
    : bus_(bus),
      settings_(settings),
      rules_(floor_rules(settings.scenario ? *settings.scenario : Scenario())),
      history_(kHistoryBytes,
               settings.is_recording ? History::WhenFull::kThinOut : History::WhenFull::kForgetOldest),
      progress_(settings.is_recording ? 0 : 1) {
  events_.on_event([this](const MonitorEvent& event) {
    Json json = to_json(event);
    json["type"] = "event";
    const auto text = shared_text(json);
    for (auto& [socket, viewer] : viewers_) socket->send_event({text, false});
  });
  if (settings_.scenario) {
    assessment_ = std::make_unique<RunAssessment>(*settings_.scenario, settings_.audit);
    assessment_->auditor.on_violation([this](const Violation& v) { event_watch_.on_violation(v); });
    bus_.use_rules(SharedRules(*settings_.scenario).fingerprint(),
                   [this](const TopicInfo&, const msg::Header& header) {
                     assessment_->auditor.on_refused();
                     event_watch_.on_refused(header.sender(), bus_.now());
                   });
  }
  for_each_topic([&]<typename Message>(const Topic<Message>& topic) {
    if (topic.qos != Qos::kImage && !topic.per_robot) subscribe(topic, 0);
  });
  if (settings_.scenario)
    for (const RobotSpec& robot : settings_.scenario->robots) follow_robot(robot.id);
  update_panels();
}

Monitor::~Monitor() = default;

void Monitor::follow_robot(RobotId robot) {
  if (robot >= kMaxRobots || !followed_.insert(robot).second) return;
  for_each_topic([&]<typename Message>(const Topic<Message>& topic) {
    if (topic.per_robot) subscribe(topic, robot);
  });
}

template <typename Message>
void Monitor::subscribe(const Topic<Message>& topic, RobotId robot) {
  const Channel channel{topic, channel_name(topic, robot), static_cast<std::uint32_t>(channels_.size())};
  channels_.insert(channel.name);
  bus_.subscribe<Message>(topic, robot,
                          [this, channel](const Message& message) { receive(channel, message); });
}

void Monitor::follow(const msg::WorldState& world) {
  for (const msg::TrackedRobot& robot : world.robots()) follow_robot(robot.robot());
}

template <typename Message>
void Monitor::receive(const Channel& channel, const Message& message) {
  const Time now = bus_.now();
  heard_at_ = now;
  traffic_.add(channel.topic, channel.number, message.header(), channel.topic.type.cdr_size(&message), now);
  if constexpr (requires { floor_.on(message, now); }) floor_.on(message, now);
  if constexpr (requires { event_watch_.on(message, now); }) event_watch_.on(message, now);
  if constexpr (requires { assessment_->on(message, now); })
    if (assessment_) assessment_->on(message, now);
  if (on_any_message_)
    on_any_message_({channel.topic, channel.number, channel.name, message.header(), &message});
  if (!settings_.scenario) follow(message);
  if (inspections_.empty() || settings_.recorded_messages) return;
  const auto inspection = inspections_.find(channel.name);
  if (inspection == inspections_.end()) return;
  std::deque<std::string>& messages = inspection->second;
  messages.push_back(inspected_message(now, describe(channel.topic, &message)));
  if (messages.size() > kMaxInspected) messages.pop_front();
}

Json Monitor::panels() {
  const Time now = bus_.now();
  const bool is_heard = now - heard_at_ <= std::chrono::seconds(1);
  Json json{{"type", "panels"}, {"at_s", unix_seconds(now)}};
  json["promise"] = promise_json(assessment_.get(), is_heard, closest_pair_, smallest_);
  json["robots"] = robots_json(floor_, waits(), now);
  json["coordinators"] = coordinators_json(floor_, now);
  json["epochs"] = epochs_json(assessment_.get());
  json["zones"] = zones_json(floor_);
  json["topics"] = traffic_.take(now);
  json["history_bytes"] = history_.bytes();
  make_numbers_exact(json);
  return json;
}

void Monitor::update_panels() {
  const Json json = panels();
  latest_panels_ = shared_text(json);
  whole_ = shared_text({{"type", "whole"},
                        {"at_s", json["at_s"]},
                        {"is_over", settings_.is_recording && progress_ >= 1},
                        {"promise", json["promise"]}});
}

Snapshot Monitor::snapshot_at(Time at) const {
  return {at, std::make_shared<const std::string>(encode_frame(floor_, waits(), at)), latest_panels_};
}

void Monitor::take_snapshot() {
  const Time now = bus_.now();
  if (assessment_) assessment_->auditor.advance(now);
  closest_pair_ = closest_pair(places_of(floor_, now), radius_m(), now);
  if (closest_pair_ && (!smallest_ || closest_pair_->clearance_m < smallest_->clearance_m))
    smallest_ = closest_pair_;
  const Duration period = floor_.robots().size() > kLargeFleet ? 4 * kPanelPeriod : kPanelPeriod;
  const bool is_first_grant = !first_grant_ && shows_grant(floor_);
  if (is_first_grant) first_grant_ = now;
  const bool is_due = now - panels_at_ >= period;
  if (is_due) {
    panels_at_ = now;
    event_watch_.tick(floor_, now);
  }
  // A recording opens at the first grant, so its panels must not be those of an earlier moment.
  if (is_due || is_first_grant) update_panels();
  history_.add(snapshot_at(now));
}

void Monitor::take_last_snapshot() {
  update_panels();
  // The history would ignore a second snapshot of the same moment.
  const Time now = history_.empty() ? bus_.now() : std::max(bus_.now(), history_.last().at + Duration{1});
  history_.add_last(snapshot_at(now));
}

void Monitor::end() {
  settings_.is_recording = true;
  settings_.can_command = false;
  take_last_snapshot();
  ended_at_ = bus_.now();
  events_.add({0, *ended_at_, Severity::kInfo, "end", "the run is over"});
  const auto text = shared_text(scene());
  for (auto& [socket, viewer] : viewers_) {
    viewer.has_chosen = true;
    socket->send_event({text, false});
  }
}

Json Monitor::scene() const {
  Json json = scene_json(settings_.scenario);
  json["type"] = "scene";
  json["is_recording"] = settings_.is_recording;
  json["can_command"] = settings_.can_command;
  json["has_messages"] = !settings_.is_recording || static_cast<bool>(settings_.recorded_messages);
  json["channels"] = channels_;
  return json;
}

void Monitor::add_viewer(WebSocket& socket) {
  viewers_[&socket];
  socket.send_event({shared_text(scene()), false});
  Json log = Json::array();
  for (const MonitorEvent& event : events_.since(0)) log.push_back(to_json(event));
  socket.send_event({shared_text({{"type", "events"}, {"events", log}}), false});
}

void Monitor::remove_viewer(WebSocket& socket) {
  viewers_.erase(&socket);
  forget_inspections();
}

void Monitor::forget_inspections() {
  std::erase_if(inspections_, [&](const auto& inspection) {
    return std::ranges::none_of(
        viewers_, [&](const auto& viewer) { return viewer.second.inspected == inspection.first; });
  });
}

void Monitor::open_recording(Viewer& viewer) const {
  if (!settings_.is_recording || viewer.has_chosen) return;
  viewer.time.pause_at(first_grant_ ? history_.from(*first_grant_).at : history_.first().at);
  viewer.has_chosen = first_grant_ || progress_ >= 1;
}

void Monitor::update_viewers(Time clock) {
  if (history_.empty()) return;
  for (auto& [socket, viewer] : viewers_) {
    open_recording(viewer);
    viewer.shown = viewer.time.update(history_, clock);
    const Snapshot& snapshot = history_.at(viewer.shown);
    if (snapshot.frame != viewer.frame) {
      viewer.frame = snapshot.frame;
      socket->send_state(kFrameSlot, {snapshot.frame, true});
    }
    if (snapshot.panels != viewer.panels) {
      viewer.panels = snapshot.panels;
      socket->send_state(kPanelSlot, {snapshot.panels, false});
    }
    if (whole_ != viewer.whole) {
      viewer.whole = whole_;
      socket->send_state(kWholeSlot, {whole_, false});
    }
    send_time(*socket, viewer);
    if (settings_.recorded_messages) send_recorded_messages(*socket, viewer, clock);
  }
  send_inspections();
}

void Monitor::send_time(WebSocket& socket, Viewer& viewer) {
  constexpr std::array kModes{"live", "paused", "playing"};
  // The ends of the history need no more than ten updates a second.
  const auto rounded = [](Time time) { return std::floor(unix_seconds(time) * 10) / 10; };
  const auto text = shared_text({{"type", "time"},
                                 {"mode", kModes[static_cast<std::size_t>(viewer.time.mode())]},
                                 {"speed", viewer.time.speed()},
                                 {"begin_s", rounded(history_.first().at)},
                                 {"end_s", rounded(history_.last().at)},
                                 {"first_grant_s", first_grant_ ? Json(unix_seconds(*first_grant_)) : Json()},
                                 {"progress", std::floor(progress_ * 100) / 100}});
  if (viewer.time_text && *viewer.time_text == *text) return;
  viewer.time_text = text;
  socket.send_state(kTimeSlot, {text, false});
}

void Monitor::send_recorded_messages(WebSocket& socket, Viewer& viewer, Time clock) {
  constexpr Duration kPlotted = std::chrono::seconds(30), kMaxStep = std::chrono::seconds(5);
  constexpr Duration kPeriod = std::chrono::milliseconds(100);
  if (!viewer.inspected || clock < viewer.next_inspection) return;
  const std::optional<Time> until = viewer.inspected_until;
  if (until == viewer.shown) return;
  const bool is_jump = !until || viewer.shown < *until || viewer.shown - *until > kMaxStep;
  const Time from = is_jump ? viewer.shown - kPlotted : *until;
  viewer.next_inspection = clock + kPeriod;
  viewer.inspected_until = viewer.shown;
  const auto messages = settings_.recorded_messages(*viewer.inspected, from, viewer.shown);
  if (messages.empty() && !is_jump) return;
  socket.send_event({messages_text(*viewer.inspected, is_jump, messages), false});
}

void Monitor::send_inspections() {
  for (auto& [channel, messages] : inspections_) {
    if (messages.empty()) continue;
    const auto shared = messages_text(channel, false, messages);
    messages.clear();
    for (auto& [socket, viewer] : viewers_)
      if (viewer.inspected == channel) socket->send_state(kInspectionSlot, {shared, false});
  }
}

bool Monitor::on_message(WebSocket& socket, const std::string& message, Time clock) {
  const Json json = parse_viewer_json(message);
  const auto found = viewers_.find(&socket);
  if (!json.is_object() || found == viewers_.end()) return false;
  Viewer& viewer = found->second;
  const std::string op = json.value("op", Json()).is_string() ? json["op"].get<std::string>() : "";
  if (op == "inspect") {
    const Json channel = json.value("channel", Json());
    if (!channel.is_null() && !(channel.is_string() && channels_.contains(channel.get<std::string>())))
      return false;
    viewer.inspected.reset();
    viewer.inspected_until.reset();
    if (channel.is_string()) {
      viewer.inspected = channel.get<std::string>();
      inspections_[*viewer.inspected];
    }
    forget_inspections();
    return true;
  }
  if (!history_.empty()) open_recording(viewer);
  if (op == "live") {
    viewer.time.go_live();
  } else if (history_.empty()) {
    return true;
  } else if (op == "pause") {
    viewer.time.pause_at(viewer.time.update(history_, clock));
  } else if (op == "seek") {
    const std::optional<Time> at = time_in(json);
    if (!at) return false;
    viewer.time.pause_at(*at);
  } else if (op == "step") {
    const std::optional<double> frames = number_in(json, "frames");
    if (!frames || std::abs(*frames) > 1000) return false;
    const Time shown = viewer.time.update(history_, clock);
    viewer.time.pause_at(history_.stepped(shown, static_cast<int>(*frames)).at);
  } else if (op == "play") {
    const std::optional<double> speed = number_in(json, "speed");
    if (!speed || *speed == 0 || std::abs(*speed) > kMaxPlaySpeed) return false;
    viewer.time.play(viewer.time.update(history_, clock), *speed, clock);
  } else {
    return false;
  }
  viewer.has_chosen = true;
  update_viewers(clock);
  return true;
}

std::optional<WebResponse> Monitor::respond(const WebRequest& request) {
  if (request.method != "GET") return std::nullopt;
  if (request.path == "/api/state") return WebResponse{200, "application/json", *latest_panels_};
  if (request.path == "/api/scene") return WebResponse{200, "application/json", text_of(scene())};
  if (request.path == "/api/map" && settings_.scenario && settings_.scenario->map)
    return WebResponse{200, "application/octet-stream", map_bits(settings_.scenario->map->cells())};
  if (request.path == "/api/trails") {
    const std::optional<Time> at = time_in(request.query);
    if (at) return WebResponse{200, "application/json", text_of(trails_json(history_, *at))};
    return WebResponse{400, "application/json",
                       text_of({{"error", "at_s: expected seconds since 1970, e.g. ?at_s=1795630117.8"}})};
  }
  if (request.path == "/api/events") {
    const auto given = request.query.find("since");
    const std::string text = given == request.query.end() ? "0" : given->second;
    const auto since = parsed<std::uint64_t>(text);
    if (!since)
      return WebResponse{400, "application/json",
                         text_of({{"error", "since: expected a number, got '" + text + "'"}})};
    Json log = Json::array();
    for (const MonitorEvent& event : events_.since(*since)) log.push_back(to_json(event));
    return WebResponse{200, "application/json", text_of(log)};
  }
  return std::nullopt;
}

}  // namespace sidestep
