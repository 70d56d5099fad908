// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/order/order_command.hpp"

#include <chrono>

#include "tests/catch.hpp"
#include "tests/test_domain.hpp"

namespace sidestep::order_command_test {

/// The exit code of a command that is carried out.
int exit_code(const std::vector<std::string>& arguments) {
  CommandLine command_line("test", "sidestep");
  std::function<int()> action;
  add_order_commands(command_line.root(), action);
  command_line.parse(arguments);
  return action();
}

/// The error for these arguments; empty if they are accepted.
std::string usage_error(const std::vector<std::string>& arguments) {
  CommandLine command_line("test", "sidestep");
  std::function<int()> action;
  add_order_commands(command_line.root(), action);
  try {
    command_line.parse(arguments);
  } catch (const UsageError& error) {
    return error.what();
  }
  return action ? "" : "no action";
}

TEST_CASE("an invalid order on the command line is rejected before anything is sent") {
  CHECK(usage_error({"go", "3", "1.2,-0.4"}).empty());
  CHECK(usage_error({"go", "3", "-1.2,-0.4", "0,0,1.57", "--wait", "--speed", "0.5"}).empty());
  CHECK(usage_error({"go", "--file", "goals.yaml"}).empty());
  CHECK(usage_error({"hold", "all"}).empty());
  CHECK(usage_error({"resume", "3", "--client", "dispatcher"}).empty());
  CHECK(usage_error({"cancel", "3"}).empty());
  CHECK(usage_error({"status", "--once"}).empty());
  CHECK(usage_error({"go", "3", "1,2", "--wait", "--timeout", "10"}).empty());
  CHECK_THAT(usage_error({"go", "3", "1,2", "--timeout", "10"}),
             ContainsSubstring("--timeout requires --wait"));
  CHECK_THAT(usage_error({"go", "3", "1,2", "--wait", "--timeout", "0"}),
             ContainsSubstring("--timeout: expected a number greater than 0"));
  CHECK_THAT(usage_error({"go", "3"}), ContainsSubstring("GOAL is missing"));
  CHECK_THAT(usage_error({"go"}), ContainsSubstring("--file"));
  CHECK_THAT(usage_error({"go", "3", "1,2", "--file", "x"}), ContainsSubstring("either"));
  CHECK_THAT(usage_error({"go", "all", "1,2"}), ContainsSubstring("one robot"));
  CHECK_THAT(usage_error({"go", "3", "1;2"}), ContainsSubstring("\"1;2\" is not a goal"));
  CHECK_THAT(usage_error({"go", "3", "1,2", "--speed", "0"}), ContainsSubstring("--speed"));
  CHECK_THAT(usage_error({"cancel", "all"}), ContainsSubstring("one robot"));
  CHECK_THAT(usage_error({"hold", "5000"}), ContainsSubstring("\"5000\" is not a robot"));
  CHECK_THAT(usage_error({"hold"}), ContainsSubstring("ROBOT"));
  std::vector<std::string> many{"go", "3"};
  many.resize(70, "1,2");
  CHECK_THAT(usage_error(many), ContainsSubstring("at most 64"));
}

TEST_CASE("a wait with a time limit ends then with exit code 1, even if nobody answers") {
  const TestDomain domain;
  const auto begin = std::chrono::steady_clock::now();
  CHECK(exit_code({"go", "3", "1,2", "--wait", "--timeout", "0.3", "--domain",
                   std::to_string(domain.number())}) == 1);
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(4));
}

TEST_CASE("an invalid zone on the command line is rejected before anything is sent") {
  CHECK(usage_error({"zone", "1", "0,0", "1,0", "1,1"}).empty());
  CHECK(usage_error({"zone", "1", "-1,-0.5", "--radius", "0.3", "--speed", "0.5"}).empty());
  CHECK(usage_error({"zone", "4294967295", "0,0", "1,0", "--radius", "0.3", "--client", "ball"}).empty());
  CHECK(usage_error({"zone", "1", "--remove"}).empty());
  CHECK_THAT(usage_error({"zone"}), ContainsSubstring("NUMBER"));
  CHECK_THAT(usage_error({"zone", "-1", "--remove"}), ContainsSubstring("NUMBER"));
  CHECK_THAT(usage_error({"zone", "4294967296", "--remove"}), ContainsSubstring("NUMBER"));
  CHECK_THAT(usage_error({"zone", "1"}), ContainsSubstring("CORNER is missing"));
  CHECK_THAT(usage_error({"zone", "1", "0,0"}), ContainsSubstring("--radius"));
  CHECK_THAT(usage_error({"zone", "1", "0,0", "--radius", "-1"}), ContainsSubstring("--radius"));
  CHECK_THAT(usage_error({"zone", "1", "0,0", "--radius", "nan"}), ContainsSubstring("--radius"));
  CHECK_THAT(usage_error({"zone", "1", "0,0", "--radius", "1e5"}), ContainsSubstring("--radius"));
  CHECK_THAT(usage_error({"zone", "1", "0,0", "--radius", "1", "--speed", "0"}),
             ContainsSubstring("--speed"));
  CHECK_THAT(usage_error({"zone", "1", "0,0", "--radius", "1", "--speed", "101"}),
             ContainsSubstring("--speed"));
  CHECK_THAT(usage_error({"zone", "1", "0,0", "--remove"}), ContainsSubstring("--remove"));
  CHECK_THAT(usage_error({"zone", "1", "--remove", "--speed", "1"}), ContainsSubstring("--remove"));
}

}  // namespace sidestep::order_command_test
