// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/log/log_level.hpp"
#include "common/process/command_line.hpp"
#include "deploy/trial/simulate/seed_range.hpp"

namespace sidestep {

struct TestOptions {
  std::vector<std::string> files;
  SeedRange seeds;
  std::string junit_file;     ///< empty: no file
  bool is_over_dds = false;   ///< instead of SimBus
  std::string hosts_file;     ///< see RunOptions
  std::optional<int> domain;  ///< nullopt: a free domain
  std::string interface = "127.0.0.1";
  std::string keys;                   ///< folder with the keys of all identities; empty: none
  bool insecure = false;              ///< see DdsSettings::insecure
  std::optional<LogLevel> log_level;  ///< nullopt: info over DDS, off on SimBus
};

/// Runs all tests in sequence. Prints each result with the failures and their times. Returns 0 if all passed
/// and kExitFailure if not. Throws ConfigError before the first run if a file is invalid.
int run_tests(const TestOptions& options);

/// Adds `sidestep test`. Parsing it sets `action`, which returns and throws what run_tests() does.
void add_test_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
