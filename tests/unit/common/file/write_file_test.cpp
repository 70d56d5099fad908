// SPDX-License-Identifier: Apache-2.0
#include "common/file/write_file.hpp"

#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sys/stat.h>
#include <unistd.h>

#include "common/file/folder.hpp"
#include "common/file/output_file.hpp"
#include "common/file/temporary_folder.hpp"
#include "tests/as_nobody.hpp"
#include "tests/catch.hpp"
#include "tests/needs_root.hpp"
#include "tests/small_disk.hpp"

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

/// The message of the exception that the work throws; empty if it throws none.
template <typename Work>
std::string problem_of(const Work& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

std::vector<std::string> problems_of_all(const std::string& path) {
  return {problem_of([&] { write_file(path, "text"); }), problem_of([&] { require_replaceable(path); })};
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

TEST_CASE("all problems of files that were not written are thrown together") {
  CHECK_NOTHROW(require_written({"", ""}));
  CHECK_THROWS_WITH(require_written({"", "a picture"}), "a picture");
  CHECK_THROWS_WITH(require_written({"a report", "", "a picture"}), "a report; a picture");
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

TEST_CASE("a folder that cannot be created is reported with its name and the true cause") {
  SIDESTEP_NEEDS_ROOT();
  const SmallDisk disk;
  fs::permissions(disk.path(), fs::perms(0755));
  const std::string path = disk.file("reports/r.json");
  for (const bool is_read_only : {false, true}) {
    if (is_read_only) disk.make_read_only();
    const std::string cause = is_read_only ? "Read-only file system"
                                           : "user nobody may not write " + disk.path() + ": " + disk.path() +
                                                 " belongs to root and has mode 0755";
    const std::string expected =
        "cannot write " + path + ": cannot create the folder " + disk.file("reports") + ": " + cause;
    const auto first_problem = [&] { return problems_of_all(path).front(); };
    const auto second_problem = [&] { return problems_of_all(path).back(); };
    CHECK((is_read_only ? first_problem() : as_nobody(first_problem)) == expected);
    CHECK((is_read_only ? second_problem() : as_nobody(second_problem)) == expected);
    const auto folder_problem = [&] { return problem_of([&] { create_folder(disk.file("reports")); }); };
    CHECK((is_read_only ? folder_problem() : as_nobody(folder_problem)) ==
          "cannot create the folder " + disk.file("reports") + ": " + cause);
  }
}

TEST_CASE("the check before the work finds what would keep a file from being written, and changes nothing") {
  const TemporaryFolder folder;
  const std::string file = folder.file("new/r.json");
  require_replaceable(file);
  CHECK(fs::is_empty(folder.file("new")));
  write_file(file, "old");
  require_replaceable(file);
  require_openable(file);
  CHECK(content(file) == "old");
  CHECK(std::distance(fs::directory_iterator(folder.file("new")), fs::directory_iterator()) == 1);
  CHECK_THROWS_WITH(require_replaceable(folder.path()), ContainsSubstring("Is a directory"));
  CHECK_THROWS_WITH(require_openable(folder.path()), ContainsSubstring("Is a directory"));
  CHECK_THROWS_WITH(require_replaceable("/dev/null/x"), "cannot write /dev/null/x: Not a directory");
  CHECK_THROWS_WITH(require_openable(folder.file("none/a.mcap")),
                    ContainsSubstring("the folder " + folder.file("none") + " does not exist"));
  CHECK_FALSE(fs::exists(folder.file("none")));
  for (const char* device : {"/dev/null", "/dev/full"}) {
    CHECK_NOTHROW(require_replaceable(device));
    CHECK_NOTHROW(require_openable(device));
  }
}

TEST_CASE("the check before the work does not end a process that reads a pipe") {
  const TemporaryFolder folder;
  const std::string pipe = folder.file("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  const int writer = open(pipe.c_str(), O_WRONLY);
  REQUIRE((reader >= 0 && writer >= 0));
  require_replaceable(pipe);
  require_openable(pipe);
  CHECK(write(writer, "x", 1) == 1);
  char read_back[2] = {};
  CHECK(read(reader, read_back, sizeof read_back) == 1);
  close(writer);
  close(reader);
}

TEST_CASE("the check before the work finds a full, a read-only and a closed folder") {
  SIDESTEP_NEEDS_ROOT();
  const SmallDisk disk(64);
  const std::string path = disk.file("r.json");
  SECTION("full") {
    disk.fill();
    CHECK_THROWS_WITH(require_replaceable(path), "cannot write " + path + ": No space left on device");
    CHECK_THROWS_WITH(require_openable(path), "cannot write " + path + ": No space left on device");
    const std::string empty = disk.file("empty");
    REQUIRE(std::ofstream(empty));
    CHECK_THROWS_WITH(require_openable(empty), "cannot write " + empty + ": No space left on device");
    CHECK_NOTHROW(require_openable(disk.file("filling")));  // to empty it makes room
    CHECK_FALSE(fs::exists(path));
  }
  SECTION("read-only") {
    write_file(path, "old");
    disk.make_read_only();
    CHECK_THROWS_WITH(require_replaceable(path), "cannot write " + path + ": Read-only file system");
    CHECK_THROWS_WITH(require_openable(path), "cannot write " + path + ": Read-only file system");
    CHECK_THROWS_WITH(open_output(path), "cannot write " + path + ": Read-only file system");
  }
  SECTION("closed") {
    fs::permissions(disk.path(), fs::perms(0755));
    const std::string expected = "cannot write " + path + ": user nobody may not write " + disk.path() +
                                 ": " + disk.path() + " belongs to root and has mode 0755";
    CHECK(as_nobody([&] { return problem_of([&] { require_replaceable(path); }); }) == expected);
    CHECK(as_nobody([&] { return problem_of([&] { require_openable(path); }); }) == expected);
    CHECK(as_nobody([&] { return problem_of([&] { (void)open_output(path); }); }) == expected);
  }
}

}  // namespace sidestep
