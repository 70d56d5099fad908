// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/results_file.hpp"

#include <filesystem>
#include <fstream>
#include <unistd.h>

#include "tests/catch.hpp"

namespace sidestep::results_file_test {

struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("sidestep-results-" + std::to_string(getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string file() const { return (path / "results").string(); }
};

TrialResult result_of(std::uint64_t seed) {
  TrialResult result;
  result.seed = seed;
  result.robot_s = 0.1 * static_cast<double>(seed);
  if (seed == 3) result.failures = {"stuck: robots 1, 2"};
  return result;
}

void append(const std::string& file, const std::string& text) { std::ofstream(file, std::ios::app) << text; }

TEST_CASE("all written results of a campaign are read back, except for an incomplete last line") {
  const Folder folder;
  {
    ResultsFile results(folder.file(), "campaign A");
    CHECK(results.found().empty());
    for (std::uint64_t seed = 2; seed < 5; ++seed) results.add(result_of(seed));
  }
  append(folder.file(), "{\"seed\": 5, \"failu");
  {
    ResultsFile results(folder.file(), "campaign A");
    REQUIRE(results.found().size() == 3);
    CHECK(results.found()[1].seed == 3);
    CHECK(results.found()[1].failures == std::vector<std::string>{"stuck: robots 1, 2"});
    CHECK(results.found()[2].robot_s == result_of(4).robot_s);
    results.add(result_of(6));
  }
  CHECK(ResultsFile(folder.file(), "campaign A").found().back().seed == 6);
}

TEST_CASE("a file without results or from another campaign is rejected with the reason and kept") {
  const Folder folder;
  { ResultsFile(folder.file(), "campaign A").add(result_of(1)); }
  CHECK_THROWS_WITH(ResultsFile(folder.file(), "campaign B"),
                    ContainsSubstring("results of another campaign: campaign A"));
  append(folder.file(), "something else\n");
  CHECK_THROWS_WITH(ResultsFile(folder.file(), "campaign A"), ContainsSubstring("results:3: not a result"));
  CHECK(std::filesystem::file_size(folder.file()) > 100);
  const std::string picture = (folder.path / "picture").string();
  append(picture, "no line ends here");
  CHECK_THROWS_WITH(ResultsFile(picture, "campaign A"), ContainsSubstring("not a results file"));
  CHECK(std::filesystem::file_size(picture) == 17);
  CHECK_THROWS_WITH(ResultsFile((folder.path / "none" / "results").string(), "campaign A"),
                    ContainsSubstring("cannot write "));
}

TEST_CASE("two campaigns cannot write one file at the same time") {
  const Folder folder;
  {
    ResultsFile results(folder.file(), "campaign A");
    CHECK_THROWS_WITH(ResultsFile(folder.file(), "campaign A"),
                      ContainsSubstring("another campaign is writing to this file"));
    results.add(result_of(1));
  }
  CHECK(ResultsFile(folder.file(), "campaign A").found().size() == 1);
}

}  // namespace sidestep::results_file_test
