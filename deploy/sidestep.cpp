// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <string>
#include <string_view>
#include <unistd.h>

#include "common/file/console.hpp"
#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "common/version/version.hpp"
#include "deploy/audit/audit_command.hpp"
#include "deploy/audit/page/report_command.hpp"
#include "deploy/inspect/record/bag_command.hpp"
#include "deploy/inspect/record/record_command.hpp"
#include "deploy/inspect/record/replay_command.hpp"
#include "deploy/inspect/topic/graph_command.hpp"
#include "deploy/inspect/topic/topic_command.hpp"
#include "deploy/run/clock/clock_command.hpp"
#include "deploy/run/keys/keys_command.hpp"
#include "deploy/run/launch/process_group.hpp"
#include "deploy/run/launch/run_command.hpp"
#include "deploy/run/order/order_command.hpp"
#include "deploy/run/order/referee_command.hpp"
#include "deploy/run/place/league_command.hpp"
#include "deploy/trial/camera/frame_command.hpp"
#include "deploy/trial/camera/pattern_command.hpp"
#include "deploy/trial/conformance/conformance_command.hpp"
#include "deploy/trial/fault/attest_command.hpp"
#include "deploy/trial/fault/fault_command.hpp"
#include "deploy/trial/planning/plan_command.hpp"
#include "deploy/trial/scenario/check_command.hpp"
#include "deploy/trial/scenario/new_command.hpp"
#include "deploy/trial/simulate/building/building_command.hpp"
#include "deploy/trial/simulate/simulate_command.hpp"
#include "deploy/trial/test/test_command.hpp"
#include "deploy/view/monitor_command.hpp"

namespace {

/// The commands of the program for studies and benchmarks, which needs more libraries.
struct EvaluationCommand {
  const char* name;
  const char* description;
};
constexpr std::array kEvaluationCommands{
    EvaluationCommand{"study", "Experiments on the system, see tests/study"},
    EvaluationCommand{"bench", "Benchmarks parts of the system against other libraries"}};

bool is_evaluation(std::string_view word) {
  return std::ranges::any_of(kEvaluationCommands,
                             [word](const auto& command) { return command.name == word; });
}

std::string evaluation_program() { return sidestep::sibling_program_path("sidestep-evaluation"); }

/// Replaces this process with the program for studies and benchmarks.
int exec_evaluation(const char* const* argv) {
  const std::string program = evaluation_program();
  if (!std::filesystem::exists(program)) {
    sidestep::print_to(stderr, "sidestep: {} does not exist; `deploy/build --development` builds it\n",
                       program);
    return sidestep::kExitFailure;
  }
  execv(program.c_str(), const_cast<char* const*>(argv));
  sidestep::print_to(stderr, "sidestep: cannot start {}\n", program);
  return sidestep::kExitFailure;
}

/// Adds the commands of that program if it was built, for help and for mistyped words. Says at the end of
/// --help how to get them otherwise.
void add_evaluation_commands(const sidestep::CliCommand& app, std::function<int()>& action,
                             const char* const* argv) {
  const std::string help = "`sidestep help COMMAND` shows the options of a command.";
  if (!std::filesystem::exists(evaluation_program())) {
    app.add_footer(help + " Also `sidestep study` and `sidestep bench`, after `deploy/build --development`.");
    return;
  }
  app.add_footer(help);
  for (const EvaluationCommand& command : kEvaluationCommands) {
    app.add_subcommand(command.name, command.description).on_parsed([&action, argv] {
      action = [argv] { return exec_evaluation(argv); };
    });
  }
}

}  // namespace

int main(int argc, char** argv) {
  using namespace sidestep;
  const int command = argc > 2 && std::string_view(argv[1]) == "help" ? 2 : 1;
  if (argc > command && is_evaluation(argv[command])) return exec_evaluation(argv);
  CommandLine command_line("Distributed multi-robot navigation without collisions.", "sidestep");
  const CliCommand app = command_line.root();
  app.require_subcommand();
  app.add_version(version_text(fast_dds_version()));
  std::function<int()> action;
  add_run_command(app, action);
  add_simulate_command(app, action);
  add_new_command(app, action);
  add_check_command(app, action);
  add_building_command(app, action);
  add_topic_command(app, action);
  add_graph_command(app, action);
  add_fault_command(app, action);
  add_test_command(app, action);
  add_attest_command(app, action);
  add_order_commands(app, action);
  add_clock_command(app, action);
  add_keys_command(app, action);
  add_conformance_command(app, action);
  add_referee_command(app, action);
  add_league_command(app, action);
  add_audit_command(app, action);
  add_report_command(app, action);
  add_monitor_command(app, action);
  add_record_command(app, action);
  add_bag_command(app, action);
  add_replay_command(app, action);
  add_plan_command(app, action);
  add_frame_command(app, action);
  add_pattern_command(app, action);
  add_evaluation_commands(app, action, argv);
  command_line.add_help_command();
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;
  return run_and_report_errors("sidestep", action);
}
