// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_bench_command.hpp"

#include "common/process/process.hpp"
#include "tests/catch.hpp"

namespace sidestep::crowd_bench_command_test {

/// Parses `crowds ARGUMENTS`; returns the exit code if the arguments are wrong, otherwise 0.
int parse(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"test", "crowds"});
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  CommandLine command_line("test", "test");
  std::function<int()> action;
  add_crowd_bench_command(command_line.root(), action);
  return command_line.parse(static_cast<int>(argv.size()), argv.data()).value_or(0);
}

TEST_CASE("the benchmark of crowds accepts families, methods, seeds and jobs") {
  CHECK(parse({}) == 0);
  CHECK(parse({"--family", "doorway", "junction", "--method", "sidestep", "--seeds", "2..20", "--parity",
               "even", "--jobs", "4", "--out", "somewhere"}) == 0);
}

TEST_CASE("the benchmark of crowds rejects invalid arguments") {
  CHECK(parse({"--family", "quiet-afternoon"}) == kExitUsage);
  CHECK(parse({"--method", "telepathy"}) == kExitUsage);
  CHECK(parse({"--seeds", "5"}) == kExitUsage);
  CHECK(parse({"--seeds", "9..1"}) == kExitUsage);
  CHECK(parse({"--seeds", "2..2"}) == kExitUsage);
  CHECK(parse({"--parity", "both"}) == kExitUsage);
  CHECK(parse({"--jobs", "0"}) == kExitUsage);
}

TEST_CASE("a range of seeds contains the seeds of one parity, or all") {
  using Seeds = std::vector<std::uint64_t>;
  CHECK(seeds_in("1..6", "odd") == Seeds{1, 3, 5});
  CHECK(seeds_in("1..6", "even") == Seeds{2, 4, 6});
  CHECK(seeds_in("3..5", "all") == Seeds{3, 4, 5});
  CHECK(seeds_in("18446744073709551614..18446744073709551615", "all").size() == 2);
  CHECK_THROWS_AS(seeds_in("4..4", "odd"), UsageError);
}

}  // namespace sidestep::crowd_bench_command_test
