// SPDX-License-Identifier: Apache-2.0
#include "common/file/permission.hpp"

#include <filesystem>

#include "common/file/temporary_folder.hpp"
#include "common/file/write_file.hpp"
#include "tests/as_nobody.hpp"
#include "tests/catch.hpp"
#include "tests/needs_root.hpp"

namespace sidestep::permission_test {

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
  std::string write_problem(const std::string& name) const {
    return as_nobody([&] { return denied_write(file(name)).value_or(""); });
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

TEST_CASE("a denied write names the user, the file or folder, and the one without permission") {
  SIDESTEP_NEEDS_ROOT();
  const Tree tree;
  for (const char* folder : {"open", "open/closed"}) fs::permissions(tree.file(folder), fs::perms(0755));
  fs::permissions(tree.file("open/closed/file"), fs::perms(0644));
  const auto denied = [&](const std::string& target, const std::string& closed, const std::string& mode) {
    return "user nobody may not write " + tree.file(target) + ": " + tree.file(closed) +
           " belongs to root and has mode " + mode;
  };
  CHECK(tree.write_problem("open/closed/file") == denied("open/closed/file", "open/closed/file", "0644"));
  CHECK(tree.write_problem("open/none") == denied("open", "open", "0755"));
  CHECK(tree.write_problem("open/none/neither/file") == denied("open", "open", "0755"));
  fs::permissions(tree.file("open/closed"), fs::perms(0700));
  CHECK(tree.write_problem("open/closed/file") == denied("open/closed", "open/closed", "0700"));
  fs::permissions(tree.file("open/closed"), fs::perms(0777));
  CHECK(tree.write_problem("open/closed/none").empty());
}

}  // namespace sidestep::permission_test
