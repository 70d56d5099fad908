// SPDX-License-Identifier: Apache-2.0
#include "common/file/write_file.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <unistd.h>

#include "tests/catch.hpp"

namespace sidestep {
namespace {

namespace fs = std::filesystem;

class TemporaryFolder {
 public:
  TemporaryFolder() { fs::create_directories(path_); }
  ~TemporaryFolder() { fs::remove_all(path_); }
  fs::path operator/(const std::string& name) const { return path_ / name; }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(path_), fs::directory_iterator()));
  }

 private:
  fs::path path_ = fs::temp_directory_path() / ("sidestep-write-file-test-" + std::to_string(getpid()));
};

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("a file is written with its folder, and replaced as a whole") {
  const TemporaryFolder folder;
  const std::string path = folder / "a/b/report.json";
  write_file(path, "a long text\n");
  CHECK(content(path) == "a long text\n");
  write_file(path, "short");
  CHECK(content(path) == "short");
  CHECK(folder.files() == 1);
  CHECK(std::distance(fs::directory_iterator(folder / "a/b"), fs::directory_iterator()) == 1);
}

TEST_CASE("a file that cannot be written is reported with the reason, and nothing is left behind") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(write_file("/dev/null/x", "text"), "cannot write /dev/null/x: Not a directory");
  fs::create_directories(folder / "folder");
  CHECK_THROWS_WITH(write_file(folder / "folder", "text"),
                    ContainsSubstring("cannot write ") && ContainsSubstring("directory"));
  CHECK_THROWS_WITH(write_file("", "text"), ContainsSubstring("cannot write"));
  CHECK(folder.files() == 1);
}

TEST_CASE("a full disk is reported") {
  if (!fs::exists("/dev/full")) return;
  CHECK_THROWS_WITH(write_file("/dev/full", "text"), "cannot write /dev/full: No space left on device");
}

TEST_CASE("links and devices are written in place") {
  const TemporaryFolder folder;
  write_file(folder / "target", "old");
  fs::create_symlink(folder / "target", folder / "link");
  write_file(folder / "link", "new");
  CHECK(fs::is_symlink(folder / "link"));
  CHECK(content(folder / "target") == "new");
  CHECK_NOTHROW(write_file("/dev/null", "text"));
}

}  // namespace sidestep
