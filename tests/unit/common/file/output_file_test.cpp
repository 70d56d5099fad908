// SPDX-License-Identifier: Apache-2.0
#include "common/file/output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/file/temporary_folder.hpp"
#include "tests/catch.hpp"
#include "tests/text_of.hpp"

namespace sidestep {

TEST_CASE("a file is opened to replace or append, and child processes do not inherit it") {
  const TemporaryFolder folder;
  const std::string path = folder.file("file");
  std::fputs("one", open_output(path).get());
  std::fputs("two", open_output(path, WriteMode::kAppend).get());
  CHECK(text_of(path) == "onetwo");
  const OutputFile file = open_output(path);
  CHECK(text_of(path).empty());
  CHECK((fcntl(fileno(file.get()), F_GETFD) & FD_CLOEXEC) != 0);
  CHECK((fcntl(fileno(file.get()), F_GETFL) & O_NONBLOCK) == 0);
}

TEST_CASE("an error about an unwritable file or a pipe without a reader states the reason") {
  const TemporaryFolder folder;
  const std::string pipe = folder.file("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(open_output("/dev/null/x"), "cannot write /dev/null/x: Not a directory");
  CHECK_THROWS_WITH(open_output(pipe), "cannot write " + pipe + ": no process reads this pipe");
  CHECK_THROWS_WITH(
      open_output(folder.file("none/file")),
      "cannot write " + folder.file("none/file") + ": the folder " + folder.file("none") + " does not exist");
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  CHECK_NOTHROW(open_output(pipe));
  close(reader);
}

}  // namespace sidestep
