// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/test_command.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fmt/format.h>
#include <iterator>
#include <memory>

#include "common/file/console.hpp"
#include "common/file/write_file.hpp"
#include "common/messaging/dds/free_domain.hpp"
#include "common/process/exit_code.hpp"
#include "common/process/help/page_path.hpp"
#include "common/process/log_option.hpp"
#include "common/yaml/config_error.hpp"
#include "deploy/run/launch/run.hpp"
#include "deploy/trial/test/judgement/junit.hpp"
#include "deploy/trial/test/plan/fault_test.hpp"
#include "deploy/trial/test/runs/launched_test_run.hpp"
#include "deploy/trial/test/runs/sim_test_run.hpp"

namespace sidestep {
namespace {

using std::chrono::steady_clock;

TestResult run_test(const FaultTest& test, std::uint64_t seed, const TestOptions& options,
                    const DdsSettings& dds) {
  const auto begin = steady_clock::now();
  TestResult result;
  try {
    result = judged(test, options.is_over_dds
                              ? run_over_dds(test, {options.hosts_file, dds, seed,
                                                    options.log_level.value_or(LogLevel::kInfo)})
                              : run_on_sim_bus(test, seed, options.log_level.value_or(LogLevel::kOff)));
  } catch (const ConfigError&) {
    throw;  // the hosts file is invalid
  } catch (const std::exception& error) {
    result.file = test.file;
    result.error = error.what();
  }
  result.bus = options.is_over_dds ? "DDS" : "SimBus";
  result.seed = seed;
  result.wall_s = std::chrono::duration<double>(steady_clock::now() - begin).count();
  return result;
}

/// Runs each test with each seed, until the user interrupts.
std::vector<TestResult> run_all(const std::vector<FaultTest>& tests, const TestOptions& options,
                                const DdsSettings& dds) {
  std::vector<TestResult> results;
  for (const FaultTest& test : tests) {
    for (std::uint64_t seed = options.seeds.first;; ++seed) {
      print_to(stdout, "{}, seed {}: ", test.file, seed);
      results.push_back(run_test(test, seed, options, dds));
      print_to(stdout, "{}", summary(results.back()));
      if (results.back().abort_reason == kInterrupted) return results;
      if (seed == options.seeds.last) break;
    }
  }
  return results;
}

}  // namespace

int run_tests(const TestOptions& options) {
  // The results are written even if the reader of the output disappears.
  std::signal(SIGPIPE, SIG_IGN);
  std::vector<FaultTest> tests;
  for (const std::string& file : options.files) tests.push_back(load_fault_test(file));
  if (!options.junit_file.empty()) require_replaceable(options.junit_file);
  DdsSettings dds;
  dds.interface = options.interface;
  dds.keys = options.keys;
  dds.insecure = options.insecure;
  std::optional<FreeDomain> free_domain;
  if (options.is_over_dds) dds.domain = options.domain ? *options.domain : free_domain.emplace().number();
  const std::vector<TestResult> results = run_all(tests, options, dds);
  const auto passed = std::ranges::count_if(results, &TestResult::passed);
  print_to(stdout, "{} of {} runs passed\n", passed, results.size());
  if (!options.junit_file.empty()) write_file(options.junit_file, junit_xml(results));
  return passed == std::ssize(results) ? 0 : kExitFailure;
}

void add_test_command(const CliCommand& root, std::function<int()>& action) {
  const auto options = std::make_shared<TestOptions>();
  const CliCommand command = root.add_subcommand(
      "test", "Runs scenarios with their faults, and checks their expectations; in virtual time or over DDS");
  command
      .add_option("FILE", options->files,
                  "scenario files with the key expect, see " + page_path("deploy/scenarios/README.md"))
      .required();
  command.add_option("--junit", options->junit_file,
                     "write the results to this file, as JUnit XML; an earlier file is replaced");
  const Option seed =
      command.add_option("--seed", options->seeds.first, "random seed").check(non_negative()).show_default();
  const Option seeds = command.add_option(
      "--seeds", [options](const std::string& text) { options->seeds = parse_seed_range(text); },
      "FIRST..LAST: run each file with each of these seeds");
  seeds.excludes(seed);
  const Option dds = command.add_flag("--dds", options->is_over_dds,
                                      "run over DDS, with one process for each part of the system");
  command.add_option("--domain", options->domain, "DDS domain [one that is free]")
      .check(in_range(0, kMaxDomain))
      .needs(dds);
  const Option interface =
      command
          .add_option("--interface", options->interface, "address of the network interface to use, or 'all'")
          .show_default()
          .needs(dds);
  command.add_option("--keys", options->keys, "folder with the keys of all identities").needs(dds);
  command
      .add_flag("--insecure", options->insecure,
                "run without keys on a network that other machines can reach")
      .needs(dds);
  command
      .add_option("--hosts", options->hosts_file,
                  "hosts file, see " + page_path("deploy/run/launch/README.md"))
      .needs(dds)
      .excludes(interface);
  command
      .add_option(
          "--log-level", [options](const std::string& name) { options->log_level = log_level_from(name); },
          "least severe messages of processes in the log; on SimBus the log is on stderr")
      .check(log_level_names())
      .show_default("info over DDS, else off");
  command.on_parsed([options, has_seeds = seeds, &action] {
    if (!has_seeds.is_given()) options->seeds.last = options->seeds.first;
    action = [options] { return run_tests(*options); };
  });
}

}  // namespace sidestep
