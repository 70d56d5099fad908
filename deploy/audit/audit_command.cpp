// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/audit_command.hpp"

#include <csignal>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <utility>

#include "common/config/scenario_loader.hpp"
#include "common/file/console.hpp"
#include "common/process/command_line.hpp"
#include "common/process/output_reader.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "common/yaml/yaml_document.hpp"
#include "deploy/audit/auditor.hpp"
#include "deploy/inspect/record/mcap/mcap_reader.hpp"
#include "deploy/inspect/record/playback_bus.hpp"

namespace sidestep {
namespace {

struct AuditOptions {
  std::string scenario_file;
  std::string recording_file;  ///< empty: audits a running system
  std::optional<double> seconds;
  bool is_json = false;
  DdsSettings dds;
};

/// Runs the bus until a stop signal, for this many seconds, or until nobody reads the violations any more.
void run_for(DdsBus& bus, const std::optional<double>& seconds) {
  const StopSignals stop_signals([&bus] { bus.stop(); });
  stop_without_reader(bus);
  if (seconds)
    bus.run_until(bus.now() + from_seconds(*seconds));
  else
    bus.run();
}

void print_violations(Auditor& auditor, bool is_json) {
  auditor.on_violation([is_json](const Violation& violation) {
    print_to(stdout, "{}\n", is_json ? to_json_line(violation) : to_line(violation));
  });
}

std::string audit_summary(const AuditTotals& totals) {
  std::string text = fmt::format(
      "{} violations; {} messages received, {} missed, {} invalid, {} refused because rules differ\n"
      "{} pairs of versions compared, {} undecided because of missed messages; positions and contacts from: "
      "{}\n",
      totals.violations, totals.received, totals.missed, totals.invalid, totals.refused,
      totals.compared_pairs, totals.undecided_pairs, name_of(totals.reference));
  for (std::size_t i = 0; i < kAuditRules; ++i) {
    const AuditRuleInfo& rule = rule_info_of(static_cast<AuditRule>(i));
    if (totals.by_rule[i] > 0)
      text +=
          fmt::format("  {} x {} ({}): {}\n", totals.by_rule[i], rule.name, rule.reference, rule.requirement);
  }
  return text;
}

/// Prints the summary and the verdict, and returns the exit code.
int finish(const AuditTotals& totals) {
  print_to(stderr, "{}audit: {}\n", audit_summary(totals), verdict_line(totals));
  return exit_code(totals.verdict());
}

int audit_recording(const AuditOptions& options) {
  PlaybackBus bus(options.recording_file);
  bus.trust_first_senders();  // as the run's own audit did
  const Scenario scenario =
      options.scenario_file.empty() ? bus.scenario() : load_scenario(options.scenario_file);
  AuditInput input;
  input.is_complete = bus.header().is_complete;
  Auditor auditor(scenario, input);
  print_violations(auditor, options.is_json);
  refuse_other_rules(bus, scenario, auditor);
  listen(bus, scenario, auditor);
  const PlaybackResult result = bus.play();
  print_to(stderr, "{}: {} messages of scenario {}{}\n", options.recording_file, result.messages,
           bus.header().scenario_name,
           result.unreadable > 0 ? fmt::format(", {} of them unreadable", result.unreadable) : "");
  if (!result.damage.empty())
    print_to(stderr, "{}: {}; earlier messages were used\n", options.recording_file, result.damage);
  auditor.advance(bus.now());
  AuditTotals totals = auditor.totals();
  totals.is_cut_off = !result.damage.empty();
  return finish(totals);
}

int audit_live(const AuditOptions& options) {
  const std::string& file = options.scenario_file;
  const Scenario scenario = parse_scenario(read_yaml_file(file, "a recording, or a scenario"), file);
  Auditor auditor(scenario, AuditInput());
  print_violations(auditor, options.is_json);
  DdsBus bus(options.dds);
  refuse_other_rules(bus, scenario, auditor);
  listen(bus, scenario, auditor);
  print_to(stderr, "auditing domain {}{}\n", options.dds.domain, options.seconds ? "" : " until Ctrl-C");
  run_for(bus, options.seconds);
  auditor.advance(bus.now());
  return finish(auditor.totals());
}

}  // namespace

void add_audit_command(const CliCommand& root, std::function<int()>& action) {
  const auto options = std::make_shared<AuditOptions>();
  options->dds.participant = "sidestep-audit";
  options->dds.keeps_all = true;
  options->dds.identity = {Role::kJudge};
  const CliCommand audit = root.add_subcommand(
      "audit", "Checks a running system, or a recording, for violations of the safety rules");
  const Option scenario = audit.add_option("FILE", options->scenario_file,
                                           "scenario of the running system, or a recording (MCAP) to check "
                                           "instead [with --recording: the scenario "
                                           "in the recording]");
  audit.add_option("--recording", options->recording_file,
                   "check this recording; FILE, if given, is a scenario to use instead of the recorded one");
  audit.add_option("--seconds", options->seconds, "duration [until Ctrl-C]").check(positive());
  audit.add_flag("--json", options->is_json, "print violations as JSON, one per line");
  add_dds_options(audit, options->dds);
  audit.on_parsed([options, scenario, &action] {
    if (options->recording_file.empty() && !scenario.is_given())
      throw UsageError("FILE is required: a scenario, or a recording");
    // A file with this ending that is missing or damaged is not taken for a scenario.
    if (is_mcap_file(options->scenario_file) || options->scenario_file.ends_with(".mcap")) {
      if (!options->recording_file.empty())
        throw UsageError(fmt::format("FILE: expected a scenario beside --recording, but {} is a recording",
                                     options->scenario_file));
      std::swap(options->recording_file, options->scenario_file);
    }
    action = [options] {
      // The verdict is printed even if the reader of the violations disappears.
      std::signal(SIGPIPE, SIG_IGN);
      return options->recording_file.empty() ? audit_live(*options) : audit_recording(*options);
    };
  });
}

}  // namespace sidestep
