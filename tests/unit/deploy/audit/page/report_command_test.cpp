// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/page/report_command.hpp"

#include <filesystem>

#include "common/file/temporary_folder.hpp"
#include "common/file/write_file.hpp"
#include "common/process/process.hpp"
#include "deploy/inspect/record/recording.hpp"
#include "tests/catch.hpp"
#include "tests/text_of.hpp"
#include "tests/unit/deploy/audit/page/report_example.hpp"

namespace sidestep::report_command_test {

namespace fs = std::filesystem;

/// Runs `sidestep report ARGUMENTS`; throws what it throws.
int report(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"sidestep", "report"});
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  CommandLine command_line("test", "sidestep");
  std::function<int()> action;
  add_report_command(command_line.root(), action);
  if (const auto exit_code = command_line.parse(static_cast<int>(argv.size()), argv.data()))
    return *exit_code;
  return action();
}

TEST_CASE("`report FILE --html` writes a page beside the report, or where it is told to") {
  const TemporaryFolder folder;
  const std::string file = folder.file("hall-7.json");
  write_file(file, to_json(example_report()));
  CHECK(report({file, "--html"}) == 0);
  CHECK_THAT(text_of(folder.file("hall-7.html")), StartsWith("<!DOCTYPE html>"));
  CHECK(report({file, "--html", folder.file("deep/page.html"), "--svg", folder.file("paths.svg")}) == 0);
  CHECK(text_of(folder.file("deep/page.html")) == text_of(folder.file("hall-7.html")));
  CHECK_THAT(text_of(folder.file("paths.svg")), StartsWith("<svg"));
}

TEST_CASE("`report FILE` alone writes nothing") {
  const TemporaryFolder folder;
  const std::string file = folder.file("hall-7.json");
  write_file(file, to_json(example_report()));
  CHECK(report({file}) == 0);
  CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 1);
}

TEST_CASE("`report` finds the report in a recording") {
  const TemporaryFolder folder;
  const std::string file = folder.file("run.mcap"), unfinished = folder.file("unfinished.mcap");
  {
    RecordingWriter writer(file, RecordingHeader());
    writer.add_report(Time{}, to_json(example_report()));
    writer.close();
    RecordingWriter(unfinished, RecordingHeader()).close();
  }
  CHECK(report({file, "--html"}) == 0);
  CHECK_THAT(text_of(folder.file("run.html")), ContainsSubstring("<h1>hall, seed 7</h1>"));
  CHECK_THROWS_WITH(report({unfinished, "--html"}), StartsWith(unfinished + ": the recording has no report"));
}

TEST_CASE("files that are no reports, and outputs that would overwrite the report, are refused") {
  const TemporaryFolder folder;
  const std::string file = folder.file("hall-7.json"), other = folder.file("other.json"),
                    page = folder.file("a.html");
  write_file(file, to_json(example_report()));
  write_file(other, "{\"a\": ");
  CHECK_THROWS_WITH(report({other}), other + ": is not JSON");
  write_file(other, "{}");
  CHECK_THROWS_WITH(report({other}), other + ": is not the report of a run: it has no key \"program\"");
  CHECK_THROWS_WITH(report({folder.file("none.json")}),
                    ContainsSubstring("none.json: cannot read the report ("));
  CHECK_THROWS_WITH(report({file, "--html", file}), ContainsSubstring("is the same file as FILE"));
  CHECK_THROWS_WITH(report({file, "--svg", page, "--html", page}),
                    ContainsSubstring("is the same file as --html"));
  CHECK(text_of(file) == to_json(example_report()));
  CHECK(report({}) == kExitUsage);
}

TEST_CASE("a report that nests very deeply, or has very many keys, is refused at once") {
  const TemporaryFolder folder;
  const std::string file = folder.file("hall-7.json"), text = to_json(example_report());
  const std::string deep = std::string(1'000'000, '[') + std::string(1'000'000, ']');
  write_file(file, "{\"seed\": " + deep + "," + text.substr(1));
  CHECK_THROWS_WITH(report({file}), file + ": is not JSON");
  std::string keys = "{";
  for (int i = 0; i < 300'000; ++i) keys += "\"" + std::to_string(i) + "\": 0, ";
  write_file(file, keys + text.substr(1));
  CHECK_THROWS_WITH(report({file}), file + ": is not JSON");
  // Brackets and commas within a text do not count.
  write_file(
      file, "{\"note\": \"\\\"" + std::string(1000, '[') + std::string(20'000, ',') + "\"," + text.substr(1));
  CHECK(report({file}) == 0);
}

}  // namespace sidestep::report_command_test
