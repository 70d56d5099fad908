// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/audit/audit_command.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>
#include <optional>

#include "common/config/scenario_loader.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/monitor/audit/auditor.hpp"
#include "deploy/monitor/record/recording.hpp"

namespace sidestep {
namespace {

struct AuditOptions {
  std::string scenario_file;
  std::string recording_file;  ///< to read, or to write; empty: none
  std::optional<double> seconds;
  bool is_json = false;
  DdsSettings dds;
};

/// Ends the bus's run at a signal or after so many seconds.
void run_for(DdsBus& bus, const std::optional<double>& seconds) {
  const StopSignals stop_signals([&bus] { bus.stop(); });
  if (seconds)
    bus.run_until(bus.now() + from_seconds(*seconds));
  else
    bus.run();
}

void show(Auditor& auditor, bool is_json) {
  auditor.on_violation([is_json](const Violation& violation) {
    fmt::print("{}\n", is_json ? to_json_line(violation) : to_line(violation));
    std::fflush(stdout);
  });
}

int conclude(const Auditor& auditor) {
  const AuditTotals totals = auditor.totals();
  fmt::print(stderr, "{}", audit_summary(totals));
  return totals.violations == 0 && totals.heard > 0 ? 0 : kExitFailure;
}

int audit_recording(const AuditOptions& options) {
  PlaybackBus bus(options.recording_file);
  const Scenario scenario = options.scenario_file.empty()
                                ? parse_scenario(bus.head().text, bus.head().scenario + ".yaml")
                                : load_scenario(options.scenario_file);
  AuditTrace hearing;
  hearing.is_complete = bus.head().is_complete;
  Auditor auditor(scenario, hearing);
  show(auditor, options.is_json);
  listen(bus, scenario, auditor);
  const RecordingEnd end = bus.play();
  fmt::print(stderr, "{}: {} messages of scenario {}{}\n", options.recording_file, end.messages,
             bus.head().scenario,
             end.unreadable > 0 ? fmt::format(", {} of them unreadable", end.unreadable) : "");
  if (!end.damage.empty())
    fmt::print(stderr, "{}: {}; everything before was used\n", options.recording_file, end.damage);
  return conclude(auditor);
}

int audit_live(const AuditOptions& options) {
  const Scenario scenario = load_scenario(options.scenario_file);
  Auditor auditor(scenario, AuditTrace());
  show(auditor, options.is_json);
  DdsBus bus(options.dds);
  listen(bus, scenario, auditor);
  fmt::print(stderr, "audits domain {}{}\n", options.dds.domain, options.seconds ? "" : " until Ctrl-C");
  run_for(bus, options.seconds);
  return conclude(auditor);
}

int record_live(const AuditOptions& options) {
  const Scenario scenario = load_scenario(options.scenario_file);
  RecordingWriter writer(options.recording_file, recording_head(scenario.name, options.scenario_file));
  DdsBus bus(options.dds);
  record(bus, scenario, writer);
  fmt::print(stderr, "records domain {}{}\n", options.dds.domain, options.seconds ? "" : " until Ctrl-C");
  run_for(bus, options.seconds);
  writer.close();
  fmt::print("{}: {} messages\n", options.recording_file, writer.messages());
  return writer.messages() > 0 ? 0 : kExitFailure;
}

}  // namespace

std::string audit_summary(const AuditTotals& totals) {
  std::string text = fmt::format(
      "audit: {} violations; {} messages heard, {} missed, {} made no sense; {} pairs of versions compared, "
      "{} "
      "not judged for want of what was missed\n",
      totals.violations, totals.heard, totals.missed, totals.invalid, totals.pairs, totals.unjudged);
  for (std::size_t i = 0; i < kAuditRules; ++i) {
    const AuditRuleInfo& rule = audit_rule(static_cast<AuditRule>(i));
    if (totals.by_rule[i] > 0)
      text += fmt::format("  {} x {} ({}): {}\n", totals.by_rule[i], rule.name, rule.reference, rule.demand);
  }
  if (totals.heard == 0) text += "audit: nothing was heard, so nothing was judged\n";
  return text;
}

void add_audit_commands(CLI::App& root, std::function<int()>& action) {
  const auto options = std::make_shared<AuditOptions>();
  options->dds.participant = "sidestep-audit";
  CLI::App* audit = root.add_subcommand(
      "audit", "Listens to a run, or reads a recording, and tells which safety rules were broken");
  CLI::Option* scenario =
      audit->add_option("SCENARIO", options->scenario_file, "scenario file [the recording's own]");
  audit->add_option("--recording", options->recording_file, "read this recording instead of listening");
  audit->add_option("--seconds", options->seconds, "how long to listen; without it until Ctrl-C")
      ->check(CLI::PositiveNumber);
  audit->add_flag("--json", options->is_json, "a line of JSON for each violation");
  add_dds_options(*audit, options->dds);
  audit->callback([options, scenario, &action] {
    if (options->recording_file.empty() && scenario->count() == 0)
      throw CLI::ValidationError("SCENARIO or --recording is required");
    action = [options] {
      return options->recording_file.empty() ? audit_live(*options) : audit_recording(*options);
    };
  });

  const auto to_record = std::make_shared<AuditOptions>();
  to_record->dds.participant = "sidestep-record";
  CLI::App* recorder = root.add_subcommand("record", "Writes all messages of a run into a file");
  recorder->add_option("SCENARIO", to_record->scenario_file, "scenario file")->required();
  recorder->add_option("--out", to_record->recording_file, "the file")->required();
  recorder->add_option("--seconds", to_record->seconds, "how long to listen; without it until Ctrl-C")
      ->check(CLI::PositiveNumber);
  add_dds_options(*recorder, to_record->dds);
  recorder->callback([to_record, &action] { action = [to_record] { return record_live(*to_record); }; });
}

}  // namespace sidestep
