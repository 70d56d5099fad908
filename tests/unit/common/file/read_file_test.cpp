// SPDX-License-Identifier: Apache-2.0
#include "common/file/read_file.hpp"

#include <sys/stat.h>

#include "common/file/home_folder.hpp"
#include "common/file/temporary_folder.hpp"
#include "common/file/write_file.hpp"
#include "tests/catch.hpp"

namespace sidestep::read_file_test {

TEST_CASE("a regular file is read completely, up to a maximum size") {
  const TemporaryFolder folder;
  const std::string text = std::string("a\0b\r\n", 5) + std::string(300'000, 'x');
  write_file(folder.file("text"), text);
  CHECK(read_file(folder.file("text"), text.size()) == text);
  CHECK_THROWS_WITH(read_file(folder.file("text"), text.size() - 1), Equals("it is larger than 0 MB"));
  write_file(folder.file("empty"), "");
  CHECK(read_file(folder.file("empty"), 0).empty());
  CHECK_FALSE(read_file("/proc/self/status", 1'000'000).empty());
}

TEST_CASE("a path that is not a regular file is rejected without reading") {
  const TemporaryFolder folder;
  REQUIRE(mkfifo(folder.file("pipe").c_str(), 0600) == 0);
  CHECK_THROWS_WITH(read_file(folder.file("pipe"), 100), Equals("it is not a regular file"));
  CHECK_THROWS_WITH(read_file("/dev/zero", 100), Equals("it is not a regular file"));
  CHECK_THROWS_WITH(read_file(folder.path(), 100), Equals("it is a directory"));
  CHECK_THROWS_WITH(read_file(folder.file("none"), 100), Equals("No such file or directory"));
}

TEST_CASE("a leading ~ in a path is replaced by the user's home folder") {
  CHECK(expand_home("~").starts_with("/"));
  CHECK(expand_home("~/maps/a.yaml") == expand_home("~") + "/maps/a.yaml");
  for (const char* path : {"", "a~", "~other/a", "/~/a", "./~"}) CHECK(expand_home(path) == path);
}

}  // namespace sidestep::read_file_test
