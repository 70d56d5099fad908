// SPDX-License-Identifier: Apache-2.0
#include <functional>

#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "common/version/version.hpp"
#include "tests/bench/bench_command.hpp"
#include "tests/study/study_command.hpp"

int main(int argc, char** argv) {
  using namespace sidestep;
  CommandLine command_line("Studies and benchmarks of Sidestep.", "sidestep");
  const CliCommand app = command_line.root();
  app.require_subcommand();
  app.add_version(version_text(fast_dds_version()));
  std::function<int()> action;
  add_bench_command(app, action);
  add_study_command(app, action);
  command_line.add_help_command();
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;
  return run_and_report_errors("sidestep", action);
}
