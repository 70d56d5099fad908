// SPDX-License-Identifier: Apache-2.0
#include "common/process/help/completion.hpp"

#include "common/process/command_line.hpp"
#include "common/process/help/man_page.hpp"
#include "tests/catch.hpp"

namespace sidestep::completion_test {

/// A program with every kind of option.
struct Sample {
  CommandLine line{"A program's sample.", "sidestep-sample"};
  bool is_once = false;
  std::string file, mode = "fast";
  int count = 3;
  std::vector<double> place_m;
  std::vector<std::string> peers, files;
  std::optional<std::string> port;

  Sample() {
    line.root().require_subcommand();
    const CliCommand topic = line.root().add_subcommand("topic", "Inspects topics");
    topic.require_subcommand();
    const CliCommand echo = topic.add_subcommand("echo", "Prints messages: as JSON");
    echo.add_flag("--once", is_once, "print one");
    echo.add_option("--count", count, "how many").check(in_range(1, 9)).show_default();
    echo.add_option("--mode", mode, "speed [its own]").check(one_of({"fast", "slow"}));
    echo.add_option("--place", place_m, "X,Y in metres").comma_separated(2).required();
    echo.add_option("--peers", peers, "addresses").comma_separated();
    echo.add_optional_value("--port", port, "80", "where to listen");
    echo.add_option("FILES", files, "what to read");
    line.add_help_command();
  }
};

TEST_CASE("the options and commands of a command line are described") {
  const CommandInfo program = Sample().line.info();
  CHECK(program.path == "sidestep-sample");
  CHECK(program.needs_command);
  REQUIRE(program.commands.size() == 2);
  CHECK(program.commands[1].name() == "help");
  CHECK(program.commands[1].positionals[0].choices == std::vector<std::string>{"topic", "help"});
  const CommandInfo& echo = program.commands[0].commands.at(0);
  CHECK(echo.path == "sidestep-sample topic echo");
  CHECK(usage(echo) == "sidestep-sample topic echo [OPTIONS] [FILES...]");
  REQUIRE(echo.options.size() == 7);
  const auto row = [&](std::size_t i) {
    return echo.options[i].names.back() + " " + echo.options[i].value + ": " +
           full_description(echo.options[i]);
  };
  CHECK(row(0) == "--help : print this help");
  CHECK(row(1) == "--once : print one");
  CHECK(row(2) == "--count NUMBER: how many, 1 to 9 [3]");
  CHECK(row(3) == "--mode TEXT: speed: fast, slow [its own]");
  CHECK(row(4) == "--place NUMBER,NUMBER: X,Y in metres; required");
  CHECK(row(5) == "--peers TEXT,...: addresses");
  CHECK(row(6) == "--port TEXT: where to listen [80]");
  CHECK(echo.options[6].is_value_optional);
}

TEST_CASE("each completion script names every command and option and choice") {
  Sample f;
  const std::string form = GENERATE("bash", "zsh", "fish");
  const std::string script = f.line.help_as(form);
  for (const char* word :
       {"topic", "echo", "help", "once", "count", "mode", "place", "peers", "port", "fast slow"}) {
    CAPTURE(form, word);
    CHECK_THAT(script, ContainsSubstring(word));
  }
}

TEST_CASE("quotes and colons in descriptions do not end a word of a completion script") {
  Sample f;
  CHECK_THAT(f.line.help_as("zsh"), ContainsSubstring("'echo:Prints messages: as JSON'"));
  CHECK_THAT(f.line.help_as("zsh"), ContainsSubstring("[speed \\[its own\\]]"));
  CHECK(in_single_quotes("a program's") == "'a program'\\''s'");
}

TEST_CASE("a man page has every command with its options and no unescaped hyphen") {
  Sample f;
  const std::string page = f.line.help_as("man");
  CHECK_THAT(page, ContainsSubstring(".TH SIDESTEP-SAMPLE 1") &&
                       ContainsSubstring("sidestep\\-sample \\- A program\\(aqs sample\n") &&
                       ContainsSubstring(".SS sidestep\\-sample topic echo\n") &&
                       ContainsSubstring(".TP\n.B \\-\\-count NUMBER\nhow many, 1 to 9 [3]\n"));
}

}  // namespace sidestep::completion_test
