// SPDX-License-Identifier: Apache-2.0
#include "common/process/output_paths.hpp"

#include <filesystem>

#include "common/file/temporary_folder.hpp"
#include "common/file/write_file.hpp"
#include "common/process/command_line.hpp"
#include "tests/catch.hpp"

namespace sidestep::output_paths_test {

namespace fs = std::filesystem;

TEST_CASE("an output file that is also an input or another output is rejected under any path to it") {
  const TemporaryFolder folder;
  const std::string scenario = folder.file("scenario.yaml"), report = folder.file("report.json");
  write_file(scenario, "robots: []");
  fs::create_symlink(scenario, folder.file("link"));
  fs::create_directory_symlink(folder.path(), folder.file("folder"));
  const auto check = [&](const std::string& first, const std::string& second) {
    require_separate_outputs({{"SCENARIO", scenario}, {"--hosts", ""}},
                             {{"--report", first}, {"--record", second}, {"--svg", ""}});
  };
  CHECK_NOTHROW(check(report, folder.file("recording.mcap")));
  CHECK_NOTHROW(check("", ""));
  CHECK_NOTHROW(check("/dev/null", "/dev/null"));
  CHECK_THROWS_WITH(check(scenario, ""), "--report: " + scenario + " is the same file as SCENARIO");
  CHECK_THROWS_AS(check(folder.file("link"), ""), UsageError);
  CHECK_THROWS_AS(check("", folder.file("./scenario.yaml")), UsageError);
  CHECK_THROWS_WITH(check(report, report), "--record: " + report + " is the same file as --report");
  CHECK_THROWS_AS(check(report, folder.file("x/../report.json")), UsageError);
  CHECK_THROWS_AS(check(report, folder.file("folder/report.json")), UsageError);
}

TEST_CASE("a file with contents is overwritten only on request") {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.mcap");
  CHECK_NOTHROW(require_new_output({"--out", file}, false));
  write_file(file, "");
  CHECK_NOTHROW(require_new_output({"--out", file}, false));
  write_file(file, "contents");
  CHECK_THROWS_WITH(require_new_output({"--out", file}, false),
                    "--out: " + file + " exists; --force overwrites it");
  CHECK_NOTHROW(require_new_output({"--out", file}, true));
  CHECK_NOTHROW(require_new_output({"--out", "/dev/null"}, false));
  CHECK_NOTHROW(require_new_output({"--out", folder.path()}, false));
}

}  // namespace sidestep::output_paths_test
