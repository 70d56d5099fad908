// SPDX-License-Identifier: Apache-2.0
#include "common/file/write_file.hpp"

#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sys/stat.h>
#include <unistd.h>

#include "common/file/temporary_folder.hpp"
#include "tests/catch.hpp"

namespace sidestep {
namespace {

namespace fs = std::filesystem;

std::size_t count_files(const TemporaryFolder& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
}

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("writing a file creates its folder and replaces the file as a whole") {
  const TemporaryFolder folder;
  const std::string path = folder.file("a/b/report.json");
  write_file(path, "a long text\n");
  CHECK(content(path) == "a long text\n");
  write_file(path, "short");
  CHECK(content(path) == "short");
  CHECK(count_files(folder) == 1);
  CHECK(std::distance(fs::directory_iterator(folder.file("a/b")), fs::directory_iterator()) == 1);
}

TEST_CASE("a file that cannot be written is reported with the reason, and no partial file remains") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(write_file("/dev/null/x", "text"), "cannot write /dev/null/x: Not a directory");
  fs::create_directories(folder.file("folder"));
  CHECK_THROWS_WITH(write_file(folder.file("folder"), "text"),
                    ContainsSubstring("cannot write ") && ContainsSubstring("directory"));
  CHECK_THROWS_WITH(write_file("", "text"), ContainsSubstring("cannot write"));
  CHECK(count_files(folder) == 1);
}

TEST_CASE("a pipe without a reader is reported and does not block") {
  const TemporaryFolder folder;
  const std::string pipe = folder.file("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(write_file(pipe, "text"), "cannot write " + pipe + ": no process reads this pipe");
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  REQUIRE(reader >= 0);
  write_file(pipe, "text");
  char read_back[5] = {};
  CHECK(read(reader, read_back, sizeof read_back) == 4);
  CHECK(std::string(read_back) == "text");
  close(reader);
}

TEST_CASE("a full disk is reported") {
  if (!fs::exists("/dev/full")) return;
  CHECK_THROWS_WITH(write_file("/dev/full", "text"), "cannot write /dev/full: No space left on device");
}

TEST_CASE("writing to a link or a device does not replace it by a file") {
  const TemporaryFolder folder;
  write_file(folder.file("target"), "old");
  fs::create_symlink(folder.file("target"), folder.file("link"));
  write_file(folder.file("link"), "new");
  CHECK(fs::is_symlink(folder.file("link")));
  CHECK(content(folder.file("target")) == "new");
  CHECK_NOTHROW(write_file("/dev/null", "text"));
}

}  // namespace sidestep
