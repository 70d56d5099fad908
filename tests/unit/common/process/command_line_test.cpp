// SPDX-License-Identifier: Apache-2.0
#include "common/process/command_line.hpp"

#include <cstdint>

#include "common/process/exit_code.hpp"
#include "tests/catch.hpp"

namespace sidestep::command_line_test {

/// A command line with one option of each kind.
struct Fixture {
  CommandLine line{"A program under test.", "sidestep-test"};
  double speed_mps = 1;
  int count = 3;
  bool is_verbose = false;
  std::string mode = "fast";
  std::vector<std::uint32_t> robots;
  std::vector<double> position_m;
  std::optional<std::string> report;
  Option speed, mode_option;

  Fixture()
      : speed(line.root().add_option("--speed", speed_mps).check(in_range(0, 5))),
        mode_option(line.root().add_option("--mode", mode).check(one_of({"fast", "slow"}))) {
    line.root().add_option("--count", count).check(positive());
    line.root().add_flag("--verbose", is_verbose).needs(mode_option);
    line.root().add_option("--robots", robots).comma_separated();
    line.root().add_option("--position", position_m).comma_separated(2).excludes(speed);
    line.root().add_optional_value("--report", report, "report.json", "Writes a report");
  }
  std::string error_of(std::vector<std::string> arguments) {
    try {
      line.parse(std::move(arguments));
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_CASE("options set their variables, and omitted options keep their defaults") {
  Fixture f;
  REQUIRE(f.error_of({"--speed", "2.5", "--robots", "1,2,7", "--mode=slow", "--verbose"}).empty());
  CHECK(f.speed_mps == 2.5);
  CHECK(f.speed.is_given());
  CHECK(f.robots == std::vector<std::uint32_t>{1, 2, 7});
  CHECK(f.mode == "slow");
  CHECK(f.is_verbose);
  CHECK(f.count == 3);
  CHECK_FALSE(f.report);
}

TEST_CASE("negative numbers are not options, even without a zero before the point") {
  Fixture f;
  std::string place;
  f.line.root().add_option("PLACE", place);
  CHECK(f.error_of({"-.5,0"}).empty());
  CHECK(place == "-0.5,0");
  CHECK(f.error_of({"--position", "-.25,-1"}).empty());
  CHECK(f.position_m == std::vector<double>{-0.25, -1});
  CHECK_FALSE(f.error_of({"-.x"}).empty());
}

TEST_CASE("an option with an optional value takes its default if the value is omitted") {
  const auto [arguments, expected] = GENERATE(table<std::vector<std::string>, std::string>(
      {{{"--report"}, "report.json"}, {{"--report=other.json"}, "other.json"}}));
  Fixture f;
  REQUIRE(f.error_of(arguments).empty());
  CHECK(f.report == expected);
}

TEST_CASE("a rejected value is reported with its option") {
  const auto [arguments, option] = GENERATE(table<std::vector<std::string>, std::string>({
      {{"--speed", "5.1"}, "--speed"},
      {{"--speed", "fast"}, "--speed"},
      {{"--speed", "nan"}, "--speed"},
      {{"--count", "0"}, "--count"},
      {{"--count", "1.5"}, "--count"},
      {{"--count", "99999999999"}, "--count"},
      {{"--mode", "medium"}, "--mode"},
      {{"--robots", "1,-2"}, "--robots"},
      {{"--position", "1"}, "--position"},
      {{"--position", "1,2,3"}, "--position"},
      {{"--position", "1,inf"}, "--position"},
      {{"--speed"}, "--speed"},
      {{"--nonsense"}, "--nonsense"},
      {{"stray"}, "stray"},
  }));
  CAPTURE(arguments);
  Fixture f;
  CHECK_THAT(f.error_of(arguments), ContainsSubstring(option));
}

TEST_CASE("a rejected value is reported with the permitted values") {
  const auto [arguments, expected] = GENERATE(table<std::vector<std::string>, std::string>({
      {{"--speed", "5.1"}, "--speed: expected a number from 0 to 5, got \"5.1\""},
      {{"--speed", "fast"}, "--speed: expected a number from 0 to 5, got \"fast\""},
      {{"--speed", "0x1"}, "--speed: expected a number from 0 to 5, got \"0x1\""},
      {{"--speed", ""}, "--speed: expected a number from 0 to 5, got \"\""},
      {{"--count", "0"}, "--count: expected a number greater than 0, got \"0\""},
      {{"--count", "1.5"}, "--count: expected a whole number, got \"1.5\""},
      {{"--count", "2e9"}, "--count: expected at most 1000000000, got \"2e9\""},
      {{"--port", "1.5"}, "--port: expected a whole number from 0 to 65535, got \"1.5\""},
      {{"--port", "65536"}, "--port: expected a whole number from 0 to 65535, got \"65536\""},
      {{"--robots", "1,-2"}, "--robots: expected at least 0, got \"-2\""},
      {{"--position", "1,inf"}, "--position: expected a finite number, got \"inf\""},
      {{"--mode", "medium"}, "--mode: expected one of fast, slow, got \"medium\""},
      {{"--mode", "fsat"}, "--mode: expected one of fast, slow, got \"fsat\"; did you mean fast?"},
      {{"--folder", ""}, "--folder: expected some text, got \"\""},
      {{"--seed", "99999999999999999999"},
       "--seed: expected at most 18446744073709551615, got \"99999999999999999999\""},
  }));
  CAPTURE(arguments);
  Fixture f;
  std::uint32_t port = 0;
  std::uint64_t seed = 0;
  std::string folder;
  f.line.root().add_option("--port", port).check(in_range(0, 65535));
  f.line.root().add_option("--seed", seed);
  f.line.root().add_option("--folder", folder);
  CHECK(f.error_of(arguments) == expected);
}

TEST_CASE("a number is decimal, even with a leading zero or plus") {
  Fixture f;
  std::uint64_t seed = 0;
  f.line.root().add_option("--seed", seed);
  REQUIRE(f.error_of({"--seed", "010", "--count", "+7", "--position", "+.5,1e-1"}).empty());
  CHECK(seed == 10);
  CHECK(f.count == 7);
  CHECK(f.position_m == std::vector<double>{0.5, 0.1});
  CHECK_FALSE(Fixture().error_of({"--count", "0x10"}).empty());
}

/// A program with commands.
struct Commands {
  CommandLine line{"A program under test.", "sidestep-test"};
  double speed_mps = 2;
  std::string file;

  Commands() {
    line.root().require_subcommand();
    const CliCommand outer = line.root().add_subcommand("outer", "Has commands");
    line.root().add_subcommand("other", "Has none").add_option("--speed", speed_mps, "how fast");
    outer.require_subcommand();
    outer.add_subcommand("inner", "Works").add_option("FILE", file, "what to read").required();
    line.add_help_command();
  }
  int exit_code(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "sidestep-test");
    return line.parse(static_cast<int>(arguments.size()), arguments.data()).value_or(-1);
  }
};

TEST_CASE("an unknown command is named with the commands that are meant, or with all") {
  const auto [words, message] = GENERATE(table<std::vector<std::string>, std::string>({
      {{"othr"}, "\"othr\" is not a command; did you mean other?"},
      {{"OUTER"}, "\"OUTER\" is not a command; did you mean outer?"},
      {{"out"}, "\"out\" is not a command; did you mean outer?"},
      {{"oter"}, "\"oter\" is not a command; did you mean outer or other?"},
      {{"outer", "iner"}, "\"iner\" is not a command; did you mean inner?"},
      {{"inner"}, "\"inner\" is not a command; did you mean `sidestep-test outer inner`?"},
      {{"explode"}, "\"explode\" is not a command, expected one of: outer, other, help"},
      {{"outer", "explode"}, "\"explode\" is not a command, expected one of: inner"},
  }));
  CHECK_THROWS_WITH(Commands().line.parse(words), message);
}

TEST_CASE("a command is required where there are commands") {
  CHECK_THROWS_WITH(Commands().line.parse({"outer"}), ContainsSubstring("subcommand is required"));
}

/// A program that does something without a command, too.
struct OptionalCommand {
  CommandLine line{"A program under test.", "sidestep-test"};
  std::string scenario, out, file;

  OptionalCommand() {
    line.root().add_option("--scenario", scenario, "what to run");
    const CliCommand view = line.root().add_subcommand("view", "Shows pictures");
    view.add_option("--out", out, "where to write").required();
    line.root().add_subcommand("replay", "Sends a log").add_option("FILE", file, "what to send").required();
    line.add_help_command();
  }
};

TEST_CASE("a program whose command may be left out names an unknown command") {
  const auto [words, message] = GENERATE(table<std::vector<std::string>, std::string>({
      {{"viw"}, "\"viw\" is not a command; did you mean view?"},
      {{"viw", "--out", "there"}, "\"viw\" is not a command; did you mean view?"},
      {{"--scenario", "a", "viw"}, "\"viw\" is not a command; did you mean view?"},
      {{"explode"}, "\"explode\" is not a command, expected one of: view, replay, help"},
  }));
  CHECK_THROWS_WITH(OptionalCommand().line.parse(words), message);
  OptionalCommand f;
  f.line.parse({"--scenario", "a"});
  CHECK(f.scenario == "a");
  CHECK_THAT(f.line.help({}), ContainsSubstring("Usage: sidestep-test [OPTIONS] [COMMAND]\n"));
}

TEST_CASE("an argument with the name of a command is an argument") {
  OptionalCommand f;
  f.line.parse({"replay", "view"});
  CHECK(f.file == "view");
  CHECK_THROWS_WITH(OptionalCommand().line.parse({"replay", "a", "view"}), ContainsSubstring("view"));
}

TEST_CASE("a program's option in front of a command is refused, because the command would ignore it") {
  const auto words = GENERATE(std::vector<std::string>{"--scenario", "a", "view"},
                              std::vector<std::string>{"--scenario", "a", "view", "--out", "there"});
  CHECK_THROWS_WITH(OptionalCommand().line.parse(words), "--scenario: expected after the command view");
}

TEST_CASE("an unknown option is named with the option that is meant") {
  CHECK_THROWS_WITH(Commands().line.parse({"other", "--sped=3"}),
                    ContainsSubstring("--sped=3") && EndsWith("; did you mean --speed?"));
  CHECK_THROWS_WITH(Commands().line.parse({"other", "--nonsense"}), EndsWith("--nonsense"));
  CHECK_THROWS_WITH(Commands().line.parse({"outer", "inner", "--fil"}), EndsWith("not expected: --fil"));
  CHECK_THROWS_WITH(Commands().line.parse({"--hlp"}), EndsWith("--hlp; did you mean --help?"));
}

TEST_CASE("the help command prints the help of the program or of a command") {
  CHECK(Commands().line.help({}).starts_with(
      "A program under test.\nUsage: sidestep-test [OPTIONS] COMMAND\n"));
  CHECK(Commands().line.help({"outer"}).starts_with(
      "Has commands\nUsage: sidestep-test outer [OPTIONS] COMMAND\n"));
  CHECK_THAT(Commands().line.help({"outer", "inner"}),
             StartsWith("Works\nUsage: sidestep-test outer inner [OPTIONS] FILE\n"));
  CHECK_THROWS_WITH(Commands().line.help({"outer", "iner"}),
                    "\"iner\" is not a command; did you mean inner?");
  CHECK(Commands().exit_code({"help"}) == 0);
  CHECK(Commands().exit_code({"help", "outer", "inner"}) == 0);
  CHECK(Commands().exit_code({"help", "othr"}) == kExitUsage);
}

TEST_CASE("help in other forms needs no required option") {
  const std::string form = GENERATE("man", "bash", "zsh", "fish");
  CHECK(Commands().exit_code({"--help-as", form.c_str()}) == 0);
  CHECK_THAT(Commands().line.help_as(form), ContainsSubstring("sidestep") && ContainsSubstring("inner"));
}

TEST_CASE("help and messages about options have no numbers longer than a clock's") {
  Commands f;
  std::uint64_t seed = 0;
  double seconds = 0;
  f.line.root().add_option("--seed", seed).check(non_negative());
  f.line.root().add_option("--seconds", seconds).check(positive());
  const std::string text = f.line.help({});
  CHECK_THAT(text, ContainsSubstring("at least 0") && ContainsSubstring("greater than 0"));
  CHECK(text.find("00000") == std::string::npos);
  CHECK_THROWS_WITH(f.line.parse({"--seconds", "-3", "other"}),
                    "--seconds: expected a number greater than 0, got \"-3\"");
}

TEST_CASE("a positive number is rejected if it is too large or too small for a duration") {
  const auto [text, is_valid] = GENERATE(table<std::string, bool>({{"1e-9", true},
                                                                   {"0.5", true},
                                                                   {"1e9", true},
                                                                   {"1.1e9", false},
                                                                   {"1e308", false},
                                                                   {"1e999", false},
                                                                   {"1e-10", false},
                                                                   {"1e-320", false},
                                                                   {"0", false},
                                                                   {"-1", false},
                                                                   {"nan", false}}));
  CAPTURE(text);
  CommandLine line("A program under test.", "sidestep-test");
  double seconds = 1;
  line.root().add_option("--seconds", seconds).check(positive());
  if (is_valid) {
    CHECK_NOTHROW(line.parse({"--seconds", text}));
  } else {
    CHECK_THROWS_WITH(line.parse({"--seconds", text}), ContainsSubstring("--seconds"));
  }
}

TEST_CASE("options that require or exclude each other are checked") {
  CHECK_THAT(Fixture().error_of({"--verbose"}), ContainsSubstring("--mode"));
  CHECK_THAT(Fixture().error_of({"--speed", "1", "--position", "0,0"}), ContainsSubstring("--speed"));
}

TEST_CASE("a callback's usage error is reported, and only the chosen subcommand's callback runs") {
  CommandLine line("A program under test.", "sidestep-test");
  line.root().require_subcommand();
  bool is_called = false;
  line.root().add_subcommand("good", "Works").on_parsed([&] { is_called = true; });
  line.root().add_subcommand("bad", "Fails").on_parsed([] { throw UsageError("the file is missing"); });
  CHECK_THROWS_AS(line.parse({}), UsageError);
  CHECK_THROWS_WITH(line.parse({"bad"}), ContainsSubstring("the file is missing"));
  CHECK_FALSE(is_called);
  line.parse({"good"});
  CHECK(is_called);
}

TEST_CASE("invalid usage exits with code 2 and --help exits with 0") {
  const auto exit_code = [](const char* argument) {
    Fixture f;
    const char* const arguments[] = {"sidestep-test", argument};
    return f.line.parse(2, arguments);
  };
  CHECK(exit_code("--nonsense") == kExitUsage);
  CHECK(exit_code("--help") == 0);
  CHECK_FALSE(exit_code("--report"));
}

}  // namespace sidestep::command_line_test
