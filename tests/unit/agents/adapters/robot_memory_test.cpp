// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/robot_memory.hpp"

#include <filesystem>
#include <fstream>

#include "common/file/temporary_folder.hpp"
#include "tests/catch.hpp"
#include "tests/needs_root.hpp"
#include "tests/small_disk.hpp"

namespace sidestep::robot_memory_test {

TEST_CASE("a robot's memory file preserves the stored values") {
  const TemporaryFolder folder;
  const std::string robots = folder.file("a/b");
  const robot::DurableState state{1'795'644'474'375'210'547u, 17, 18'446'744'073'709'551'615u, true};
  {
    RobotMemory memory(robots, 3);
    CHECK(memory.state() == robot::DurableState{});
    REQUIRE(memory.store(state));
    CHECK(memory.state() == state);
  }
  CHECK(RobotMemory(robots, 3).state() == state);
  CHECK(RobotMemory(robots, 4).state() == robot::DurableState{});
}

TEST_CASE("an invalid memory file is refused with its line and is not overwritten") {
  const TemporaryFolder folder;
  const std::string path = folder.file("robot-3.memory");
  const auto broken = GENERATE(
      as<std::pair<std::string, int>>(), std::pair("", 1), std::pair("hello\n", 1),
      std::pair("sidestep robot memory 1\nincarnation -5\n", 2),
      std::pair("sidestep robot memory 1\nincarnation 5\nepoch 7\n", 4),
      std::pair("sidestep robot memory 1\nincarnation 5\nepoch 7\nnumber_bound 8x\n", 4),
      std::pair("sidestep robot memory 1\nincarnation 5\nepoch 7\nnumber_bound 8\nhas_moved 0\n", 6));
  std::ofstream(path) << broken.first;
  CHECK_THROWS_WITH(RobotMemory(folder.path(), 3),
                    StartsWith(path + ":" + std::to_string(broken.second) + ": expected"));
  std::ifstream file(path);
  CHECK(std::string(std::istreambuf_iterator<char>(file), {}) == broken.first);
}

TEST_CASE("only one process can open a robot's memory") {
  const TemporaryFolder folder;
  {
    const RobotMemory memory(folder.path(), 3);
    CHECK_THROWS_WITH(RobotMemory(folder.path(), 3),
                      ContainsSubstring("does another process drive this robot?"));
    CHECK_NOTHROW(RobotMemory(folder.path(), 4));
  }
  CHECK_NOTHROW(RobotMemory(folder.path(), 3));
}

TEST_CASE("a robot whose folder was deleted cannot store anything") {
  const TemporaryFolder folder;
  RobotMemory memory(folder.file("robots"), 3);
  REQUIRE(memory.store({1, 2, 3, false}));
  std::filesystem::remove_all(folder.file("robots"));
  CHECK_FALSE(memory.store({1, 2, 4, false}));
  CHECK(memory.state().number_bound == 3);
}

TEST_CASE("a memory that cannot be written is reported with the cause, not as held by another process") {
  SIDESTEP_NEEDS_ROOT();
  const SmallDisk disk(64);
  {
    RobotMemory memory(disk.path(), 3);
    REQUIRE(memory.store({1, 2, 3, false}));
    CHECK(memory.failure().empty());
    disk.fill();
    CHECK_FALSE(memory.store({1, 2, 4, false}));
    CHECK(memory.failure() == "cannot write " + disk.file("robot-3.memory") + ": No space left on device");
  }
  CHECK(RobotMemory(disk.path(), 3).state().number_bound == 3);
  disk.make_read_only();
  CHECK_THROWS_WITH(RobotMemory(disk.path(), 3),
                    "cannot write " + disk.file("robot-3.memory.lock") + ": Read-only file system");
  CHECK_THROWS_WITH(
      RobotMemory(disk.file("robots"), 3),
      disk.file("robots") + ": cannot create this folder for the robots' memories: Read-only file system");
}

}  // namespace sidestep::robot_memory_test
