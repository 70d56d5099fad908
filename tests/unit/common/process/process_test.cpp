// SPDX-License-Identifier: Apache-2.0
#include "common/process/process.hpp"

#include <algorithm>
#include <signal.h>
#include <stdexcept>

#include "common/messaging/dds/missing_interface.hpp"
#include "common/process/command_line.hpp"
#include "tests/catch.hpp"
#include "tests/test_keys.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"

namespace sidestep::process_test {

struct Outcome {
  int exit_code;
  std::string err;
};

Outcome run(const Program& program, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "sidestep-test");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  const CaptureStderr captured;
  const int exit_code = run_process(static_cast<int>(argv.size()), argv.data(), program);
  return {exit_code, captured.text()};
}

std::vector<std::string> good_arguments() {
  return {"--scenario", SIDESTEP_SCENARIO, "--domain", std::to_string(test_settings().domain)};
}

Program test_program() {
  Program program;
  program.name = "sidestep-test";
  program.description = "A program under test.";
  program.process = [] { return std::uint32_t{1}; };
  program.start = [](DdsBus&, const Scenario&, Incarnation) { return RunningNodes{}; };
  return program;
}

TEST_CASE("an interface that this machine lacks is wrong usage of a command") {
  CHECK(run_and_report_errors("test", []() -> int { throw MissingInterface("no such address"); }) ==
        kExitUsage);
  CHECK(run_and_report_errors("test", []() -> int { throw std::runtime_error("no"); }) == kExitFailure);
}

TEST_CASE("invalid usage and an invalid scenario exit with 2, --help exits with 0, and no node starts") {
  Program program = test_program();
  bool started = false;
  program.start = [&](DdsBus&, const Scenario&, Incarnation) {
    started = true;
    return RunningNodes{};
  };
  CHECK(run(program, {}).exit_code == kExitUsage);
  CHECK(run(program, {"--scenario"}).exit_code == kExitUsage);
  CHECK(run(program, {"--scenario", SIDESTEP_SCENARIO, "--domain", "233"}).exit_code == kExitUsage);
  CHECK(run(program, {"--scenario", SIDESTEP_SCENARIO, "--nonsense"}).exit_code == kExitUsage);
  CHECK(run(program, {"--help"}).exit_code == 0);
  const Outcome missing = run(program, {"--scenario", "/nowhere.yaml"});
  CHECK(missing.exit_code == kExitUsage);
  CHECK_THAT(missing.err, ContainsSubstring("sidestep-test: /nowhere.yaml:"));
  CHECK_FALSE(started);
}

TEST_CASE("a program with commands carries out the one that is given, and without one starts its nodes") {
  Program program = test_program();
  std::string done;
  program.add_commands = [&](const CliCommand& app, std::function<int()>& action) {
    app.add_subcommand("work", "Works").on_parsed([&] {
      action = [&] {
        done += " work";
        return kExitFailure;
      };
    });
    app.add_subcommand("fail", "Fails").on_parsed([&] {
      action = []() -> int { throw std::invalid_argument("the file is missing"); };
    });
  };
  program.start = [&](DdsBus& bus, const Scenario&, Incarnation) {
    done += " start";
    bus.stop();
    return RunningNodes{};
  };
  CHECK(run(program, {"work"}).exit_code == kExitFailure);
  CHECK(done == " work");
  const Outcome failed = run(program, {"fail"});
  CHECK(failed.exit_code == kExitUsage);
  CHECK(failed.err == "sidestep-test: the file is missing\n");
  const Outcome unknown = run(program, {"wrok"});
  CHECK(unknown.exit_code == kExitUsage);
  CHECK_THAT(unknown.err, ContainsSubstring("\"wrok\" is not a command; did you mean work?"));
  const Outcome incomplete = run(program, {});
  CHECK(incomplete.exit_code == kExitUsage);
  CHECK_THAT(incomplete.err, StartsWith("--scenario is required\n"));
  CHECK(run(program, {"help", "work"}).exit_code == 0);
  CHECK(done == " work");
  CHECK(run(program, good_arguments()).exit_code == 0);
  CHECK(done == " work start");
}

TEST_CASE("a program prints its safety budget at start") {
  Program program = test_program();
  program.start = [](DdsBus& bus, const Scenario&, Incarnation) {
    bus.stop();
    return RunningNodes{};
  };
  const Outcome outcome = run(program, good_arguments());
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.err,
             ContainsSubstring(
                 "sidestep-test: safety budget: margin 14.0 mm = 2 x 5.0 mm tracking + 4.0 mm for clocks "
                 "within 0.5 ms at 2 m/s\n"));
}

TEST_CASE("an exception at start is printed on stderr, and the exit code is 1") {
  Program program = test_program();
  program.start = [](DdsBus&, const Scenario&, Incarnation) -> RunningNodes {
    throw std::runtime_error("no such robot");
  };
  const Outcome outcome = run(program, good_arguments());
  CHECK(outcome.exit_code == kExitFailure);
  CHECK_THAT(outcome.err, ContainsSubstring("sidestep-test: no such robot"));
  std::vector<std::string> arguments = good_arguments();
  arguments.insert(arguments.end(), {"--interface", "192.0.2.1"});
  const Outcome no_interface = run(test_program(), arguments);
  CHECK(no_interface.exit_code == kExitFailure);
  CHECK_THAT(no_interface.err, ContainsSubstring("192.0.2.1"));
  arguments.back() = "eth0";  // not an address of this machine
  const Outcome no_address = run(test_program(), arguments);
  CHECK(no_address.exit_code == kExitUsage);
  CHECK_THAT(no_address.err, ContainsSubstring("got 'eth0'"));
}

TEST_CASE("a process whose keys are not valid yet exits with 1, so that a service manager restarts it") {
  const auto run_with = [](const TestKeys& keys) {
    std::vector<std::string> arguments = good_arguments();
    arguments.insert(arguments.end(), {"--keys", keys.folder()});
    return run(test_program(), arguments);
  };
  const Time now = DdsBus::clock();
  const Outcome early = run_with(TestKeys({"agent", "1"}, now + std::chrono::hours(1)));
  CHECK(early.exit_code == kExitFailure);
  CHECK_THAT(early.err, ContainsSubstring("the key of agent 1 is not valid before") &&
                            ContainsSubstring("is the clock right?"));
  const Outcome late = run_with(TestKeys({"agent", "1"}, now - std::chrono::hours(2)));
  CHECK(late.exit_code == kExitUsage);
  CHECK_THAT(late.err, ContainsSubstring("the key of agent 1 expired on"));
}

TEST_CASE("an option without a value has its default, and an absent option has no value") {
  const auto parsed = [](std::vector<std::string> arguments) {
    CommandLine command_line("test", "test");
    const CliCommand app = command_line.root();
    std::optional<std::string> value;
    bool flag = false;
    app.add_optional_value("--to", value, "nowhere", "sends it");
    app.add_flag("--flag", flag);
    command_line.parse(arguments);
    return value;
  };
  CHECK_FALSE(parsed({}));
  CHECK_FALSE(parsed({"--flag"}));
  CHECK(parsed({"--to"}) == "nowhere");
  CHECK(parsed({"--to", "--flag"}) == "nowhere");
  CHECK(parsed({"--flag", "--to", "there"}) == "there");
  CHECK_THROWS_AS(parsed({"--to", "there", "elsewhere"}), UsageError);
}

TEST_CASE("a signal shuts the process down in order: nodes before the bus, exit code 0") {
  const int signal_number = GENERATE(SIGINT, SIGTERM);
  Program program = test_program();
  int robot = 0;
  program.add_options = [&](const CliCommand& app) { app.add_option("--robot", robot); };
  program.participant = [&] { return "agent-" + std::to_string(robot); };
  std::size_t robots_in_scenario = 0;
  bool is_node_destroyed = false;
  program.start = [&](DdsBus& bus, const Scenario& scenario, Incarnation) {
    robots_in_scenario = scenario.robots.size();
    bus.at(bus.now(), [=] { kill(getpid(), signal_number); });
    return RunningNodes{std::shared_ptr<void>(&bus,
                                              [&](void* address) {
                                                static_cast<DdsBus*>(address)->now();
                                                is_node_destroyed = true;
                                              }),
                        {}};
  };
  std::vector<std::string> arguments = good_arguments();
  arguments.insert(arguments.end(), {"--robot", "3"});
  const Outcome outcome = run(program, arguments);
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK(robot == 3);
  CHECK(robots_in_scenario > 0);
  CHECK(is_node_destroyed);
  CHECK_THAT(outcome.err, ContainsSubstring("agent-3: Fast DDS " + fast_dds_version() + ", domain "));
  CHECK(outcome.err.find("no keys") == std::string::npos);  // nobody else can reach the loopback interface
}

TEST_CASE(
    "a process that is asked to end first finishes, whatever the signal, and a repeated SIGTERM changes "
    "nothing") {
  const int signal_number = GENERATE(SIGINT, SIGTERM);
  Program program = test_program();
  int asked = 0;
  program.start = [&](DdsBus& bus, const Scenario&, Incarnation) {
    bus.at(bus.now(), [=] { kill(getpid(), signal_number); });
    RunningNodes running;
    running.finish = [&asked] {
      kill(getpid(), SIGTERM);
      return ++asked == 5;
    };
    running.unfinished = [] { return "robot 3 still moves"; };
    return running;
  };
  const Outcome outcome = run(program, good_arguments());
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK(asked == 5);
  CHECK_THAT(outcome.err, ContainsSubstring("asked to end: robots come to rest first"));
  CHECK(outcome.err.find("gives up") == std::string::npos);
}

TEST_CASE("a second Ctrl-C ends a process at once, and says what it has not finished") {
  const int first = GENERATE(SIGINT, SIGTERM);
  Program program = test_program();
  program.start = [&](DdsBus& bus, const Scenario&, Incarnation) {
    bus.at(bus.now(), [=] { kill(getpid(), first); });
    RunningNodes running;
    running.finish = [] {
      kill(getpid(), SIGINT);
      return false;
    };
    running.unfinished = [] { return "robot 3 still moves"; };
    return running;
  };
  const Outcome outcome = run(program, good_arguments());
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.err, ContainsSubstring("gives up: robot 3 still moves"));
}

TEST_CASE("a SIGINT that arrives twice at once is one request") {
  Program program = test_program();
  int asked = 0;
  program.start = [&](DdsBus& bus, const Scenario&, Incarnation) {
    bus.at(bus.now(), [] {
      kill(getpid(), SIGINT);
      kill(getpid(), SIGINT);
    });
    RunningNodes running;
    running.finish = [&asked] { return ++asked == 3; };
    running.unfinished = [] { return "robot 3 still moves"; };
    return running;
  };
  const Outcome outcome = run(program, good_arguments());
  CAPTURE(outcome.err);
  CHECK(asked == 3);
  CHECK(outcome.err.find("gives up") == std::string::npos);
}

TEST_CASE("a later run of a process has a higher incarnation, unless other processes would refuse it") {
  const Time now = time_from_ns(1'000'000'000'000'000);
  const auto reading = static_cast<Incarnation>(to_ns(now)), minute = Incarnation{60'000'000'000};
  CHECK(next_incarnation(0, now) == reading);
  CHECK(next_incarnation(reading - minute, now) == reading);
  CHECK(next_incarnation(reading, now) == reading + 1);
  CHECK(next_incarnation(reading + 59 * minute, now) == reading + 59 * minute + 1);
  CHECK(next_incarnation(reading + 60 * minute, now) == reading);
  CHECK(next_incarnation(reading + 24 * 60 * minute, now) == reading);
}

}  // namespace sidestep::process_test
