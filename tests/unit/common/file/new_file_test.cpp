// SPDX-License-Identifier: Apache-2.0
#include "common/file/new_file.hpp"

#include <future>
#include <set>
#include <vector>

#include "common/file/temporary_folder.hpp"
#include "common/file/write_file.hpp"
#include "tests/catch.hpp"
#include "tests/text_of.hpp"

namespace sidestep {

TEST_CASE("a new file gets a number if its name is taken, and what is there stays") {
  const TemporaryFolder folder;
  const std::string path = folder.file("reports/a.b-20261129T055009.log");
  CHECK(create_new_file(path) == path);
  write_file(path, "first");
  CHECK(create_new_file(path) == folder.file("reports/a.b-20261129T055009-2.log"));
  CHECK(create_new_file(path) == folder.file("reports/a.b-20261129T055009-3.log"));
  CHECK(text_of(path) == "first");
  CHECK_THROWS_WITH(create_new_file("/dev/null/x"), ContainsSubstring("cannot write /dev/null/x: "));
}

TEST_CASE("new files that are created at the same time with one name are different files") {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.log");
  std::vector<std::future<std::string>> created;
  for (int i = 0; i < 8; ++i)
    created.push_back(std::async(std::launch::async, [&path] { return create_new_file(path); }));
  std::set<std::string> names;
  for (std::future<std::string>& name : created) names.insert(name.get());
  CHECK(names.size() == 8);
}

}  // namespace sidestep
