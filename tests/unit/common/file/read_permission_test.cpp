// SPDX-License-Identifier: Apache-2.0
#include "common/file/read_permission.hpp"

#include <filesystem>

#include "common/file/temporary_folder.hpp"
#include "common/file/write_file.hpp"
#include "tests/as_nobody.hpp"
#include "tests/catch.hpp"
#include "tests/needs_root.hpp"

namespace sidestep::read_permission_test {

namespace fs = std::filesystem;

/// A tree of folders that every user may read, in a folder that every user may enter.
struct Tree {
  Tree() {
    fs::permissions(fs::path(file("")).parent_path(), fs::perms(0755));
    write_file(file("open/closed/file"), "text");
    fs::create_symlink("open/closed", file("link"));
  }
  std::string file(const std::string& name) const { return temporary.file(name); }
  std::string problem(const std::string& name) const {
    return as_nobody([&] { return denied_read(file(name)).value_or(""); });
  }
  TemporaryFolder temporary;
};

TEST_CASE("readable and missing files do not count as denied") {
  SIDESTEP_NEEDS_ROOT();
  const Tree tree;
  for (const char* name : {"open", "open/closed/file", "link/file", "none", "open/none/file"}) {
    CAPTURE(name);
    CHECK(tree.problem(name).empty());
  }
}

TEST_CASE("a denied read names the user, the path, and the file or folder without permission") {
  SIDESTEP_NEEDS_ROOT();
  const Tree tree;
  const auto denied = [&](const std::string& path, const std::string& closed, const std::string& mode) {
    return "user nobody may not read " + tree.file(path) + ": " + tree.file(closed) +
           " belongs to root and has mode " + mode;
  };
  SECTION("the file is unreadable") {
    fs::permissions(tree.file("open/closed/file"), fs::perms(0600));
    CHECK(tree.problem("open/closed/file") == denied("open/closed/file", "open/closed/file", "0600"));
    CHECK(tree.problem("link/file") == denied("link/file", "link/file", "0600"));
  }
  SECTION("a parent folder is closed") {
    fs::permissions(tree.file("open/closed"), fs::perms(0700));
    CHECK(tree.problem("open/closed/file") == denied("open/closed/file", "open/closed", "0700"));
    CHECK(tree.problem("open/closed/none") == denied("open/closed/none", "open/closed", "0700"));
    CHECK(tree.problem("link/file") == denied("link/file", "link", "0700"));
  }
  SECTION("a parent folder of a link's target is closed") {
    fs::permissions(tree.file("open"), fs::perms(0700));
    CHECK(tree.problem("link/file") == denied("link/file", "open", "0700"));
  }
  SECTION("a parent folder can be entered but not listed") {
    fs::permissions(tree.file("open/closed"), fs::perms(0711));
    CHECK(tree.problem("open/closed/file").empty());
    CHECK(tree.problem("open/closed") == denied("open/closed", "open/closed", "0711"));
  }
}

}  // namespace sidestep::read_permission_test
