// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/monitor_process.hpp"

#include <algorithm>

#include "tests/catch.hpp"
#include "tests/taken_port.hpp"
#include "tests/test_keys.hpp"

namespace sidestep::monitor_process_test {
namespace {

RunOptions options_with_monitor() {
  RunOptions options;
  options.scenario_file = "hall.yaml";
  options.monitor_port = "8080";
  options.dds.domain = 7;
  return options;
}

/// Whether the arguments contain these, one after another.
bool has(const ChildSpec& child, const std::vector<std::string>& arguments) {
  return !std::ranges::search(child.argv, arguments).empty();
}

}  // namespace

TEST_CASE("the monitor of a run gets its scenario, port and domain, and outlasts the run unless told") {
  RunOptions options = options_with_monitor();
  const ChildSpec child = monitor_child(options);
  CHECK(child.name == "monitor");
  CHECK(has(child, {"monitor", "hall.yaml"}));
  CHECK(has(child, {"--port", "8080"}));
  CHECK(has(child, {"--domain", "7"}));
  CHECK_FALSE(has(child, {"--control"}));
  CHECK_FALSE(has(child, {"--keys"}));
  CHECK(child.input == "\n");
  CHECK(child.outlasts_run);
  options.closes_page = true;
  CHECK_FALSE(monitor_child(options).outlasts_run);
}

TEST_CASE("the token of a run's monitor is in its input and its link, but not in its arguments") {
  RunOptions options = options_with_monitor();
  CHECK(monitor_url(options) == "http://127.0.0.1:8080/");
  options.has_control = true;
  options.monitor_token = "0123abcd";
  const ChildSpec child = monitor_child(options);
  CHECK(has(child, {"--control"}));
  CHECK(child.input == "0123abcd\n");
  for (const std::string& argument : child.argv) CHECK(argument.find("0123abcd") == std::string::npos);
  CHECK(monitor_url(options) == "http://127.0.0.1:8080/#token=0123abcd");
}

TEST_CASE("the monitor of a run with keys gets a viewer's keys, or an operator's if it may command") {
  const TestKeys keys({"viewer"});
  RunOptions options = options_with_monitor();
  options.dds.keys = keys.folder();
  CHECK(has(monitor_child(options), {"--keys", keys.folder_of("viewer")}));
  options.has_control = true;
  CHECK_THROWS_AS(monitor_child(options), std::invalid_argument);
  const TestKeys both({"viewer", "operator"});
  options.dds.keys = both.folder();
  CHECK(has(monitor_child(options), {"--keys", both.folder_of("operator")}));
}

TEST_CASE("a taken port is refused, and a free one is not") {
  TakenPort port;
  CHECK_THROWS_WITH(require_free_port(port.number()),
                    StartsWith("--monitor: another program, perhaps the page of an earlier run, uses port " +
                               port.number() + "; end it, or choose another port, e.g. --monitor "));
  port.release();
  CHECK_NOTHROW(require_free_port(port.number()));
}

}  // namespace sidestep::monitor_process_test
