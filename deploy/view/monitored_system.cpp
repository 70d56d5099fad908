// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitored_system.hpp"

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <unistd.h>

#include "common/config/scenario_loader.hpp"
#include "common/file/new_file.hpp"
#include "common/file/write_file.hpp"
#include "common/log/log.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/audit/metrics/report.hpp"
#include "deploy/view/launcher_input.hpp"
#include "deploy/view/monitor_server.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

constexpr Duration kPollPeriod = 5ms, kFlushPeriod = 1s;

/// Creates the file of a recording that a viewer starts, e.g. recordings/crossing-20261125T180509.mcap.
std::string new_recording_file(const Scenario& scenario) {
  const std::string report = default_report_path(scenario.name, std::nullopt);
  const std::filesystem::path name = std::filesystem::path(report).filename().replace_extension(".mcap");
  return create_new_file((std::filesystem::path("recordings") / name).string());
}

/// A monitor of a running system, and everything that it needs.
class MonitoredSystem {
 public:
  MonitoredSystem(const MonitorOptions& options, std::optional<LauncherInput>& launcher);

  /// Shows the system until stop(), or until the launcher says that the run is over or closes the input.
  void run();
  /// Shows what was, until stop(), or until the launcher closes the input.
  void show_ended_run();
  /// Ends the recording in progress, if any. Throws std::runtime_error if a write has failed.
  void close() {
    if (recorder_) recorder_->stop();
  }
  /// Async-signal-safe.
  void stop() {
    is_stopped_ = true;
    if (DdsBus* bus = active_bus_) bus->stop();
  }
  bool is_stopped() const { return is_stopped_; }

 private:
  std::optional<std::string> record(bool begins);
  ControlHooks hooks();
  void add_bookmark(const std::string& text);

  std::optional<LauncherInput>& launcher_;
  std::optional<Scenario> scenario_;
  std::optional<MonitorRecorder> recorder_;
  std::unique_ptr<DdsBus> bus_;
  Monitor monitor_;
  std::optional<ControlApi> control_;
  std::optional<NetworkView> network_;
  std::optional<CameraImages> cameras_;
  std::optional<RobotFields> fields_;
  std::optional<MonitorServer> server_;
  std::atomic<DdsBus*> active_bus_;
  std::atomic<bool> is_stopped_ = false;
};

MonitorSettings settings_of(const MonitorOptions& options, const std::optional<Scenario>& scenario) {
  MonitorSettings settings;
  settings.scenario = scenario ? &*scenario : nullptr;
  settings.can_command = options.has_control;
  return settings;
}

MonitoredSystem::MonitoredSystem(const MonitorOptions& options, std::optional<LauncherInput>& launcher)
    : launcher_(launcher),
      scenario_(options.file.empty() ? std::nullopt : std::optional(load_scenario(options.file))),
      bus_(std::make_unique<DdsBus>(options.dds)),
      monitor_(*bus_, settings_of(options, scenario_)),
      network_(std::in_place, options.dds),
      active_bus_(bus_.get()) {
  if (scenario_) {
    recorder_.emplace(*scenario_, options.file);
    cameras_.emplace(*scenario_, options.dds);
    fields_.emplace(*scenario_);
  }
  if (options.has_control) control_.emplace(*bus_, hooks());
  server_.emplace(options.access, monitor_,
                  MonitorParts{control_ ? &*control_ : nullptr, &*network_, recorder_ ? &*recorder_ : nullptr,
                               cameras_ ? &*cameras_ : nullptr, fields_ ? &*fields_ : nullptr});
  if (recorder_)
    recorder_->on_failure([this](const std::string& failure) {
      log(LogLevel::kError, "recording: " + failure);
      monitor_.events().add({0, bus_->now(), Severity::kError, "recording", failure});
    });
  // Only now, so that a taken port leaves an older recording as it is.
  if (!options.recording_file.empty()) recorder_->start(options.recording_file);
  server_->announce(options.is_of_run);
}

ControlHooks MonitoredSystem::hooks() {
  ControlHooks hooks;
  hooks.bookmark = [this](const std::string& text) { add_bookmark(text); };
  if (recorder_) hooks.record = [this](bool begins) { return record(begins); };
  return hooks;
}

void MonitoredSystem::add_bookmark(const std::string& text) {
  monitor_.events().add({0, bus_->now(), Severity::kInfo, "bookmark", text});
  if (recorder_) recorder_->add_event(bus_->now(), "bookmark", text);
}

std::optional<std::string> MonitoredSystem::record(bool begins) {
  if (!begins && !recorder_->is_recording()) return std::nullopt;
  if (!begins) recorder_->stop();
  if (begins && !recorder_->is_recording()) recorder_->start(new_recording_file(*scenario_));
  return recorder_->file();
}

void MonitoredSystem::run() {
  DdsBus& bus = *bus_;
  call_periodically(bus, Monitor::kFramePeriod, [this] {
    monitor_.take_snapshot();
    server_->update(bus_->now());
    if (recorder_) recorder_->add_scene(monitor_.floor(), bus_->now());
  });
  call_periodically(bus, kPollPeriod, [this] {
    server_->server().poll();
    if (cameras_) cameras_->poll(bus_->now());
    if (!launcher_) return;
    launcher_->poll();
    if (launcher_->is_run_over() || launcher_->has_ended()) bus_->stop();
  });
  call_periodically(bus, kFlushPeriod, [this] {
    if (recorder_) recorder_->flush();
  });
  bus.run();
}

void MonitoredSystem::show_ended_run() {
  try {
    close();
  } catch (const std::runtime_error&) {
    // The page has shown the failure, and is worth more than the exit code.
  }
  server_->end_run();
  // Another run may use the domain now.
  active_bus_ = nullptr;
  control_.reset();
  cameras_.reset();
  network_.reset();
  bus_.reset();
  while (!is_stopped_ && !launcher_->has_ended()) {
    server_->update(DdsBus::clock());
    server_->server().run_for(Monitor::kFramePeriod);
    launcher_->poll();
  }
}

}  // namespace

int monitor_system(const MonitorOptions& given) {
  if (!given.recording_file.empty()) require_openable(given.recording_file);
  MonitorOptions options = given;
  std::optional<LauncherInput> launcher;
  if (options.is_of_run) {
    launcher.emplace(STDIN_FILENO);
    options.access.token = launcher->read_token();
  }
  MonitoredSystem system(options, launcher);
  const StopSignals stop_signals([&system] { system.stop(); });
  system.run();
  const bool is_over = launcher && launcher->is_run_over() && !system.is_stopped();
  is_over ? system.show_ended_run() : system.close();
  return 0;
}

}  // namespace sidestep
