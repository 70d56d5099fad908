// SPDX-License-Identifier: Apache-2.0
#include "common/process/help/page_path.hpp"

#include "common/file/folder.hpp"
#include "common/file/temporary_folder.hpp"
#include "common/file/write_file.hpp"
#include "tests/catch.hpp"

namespace sidestep::page_path_test {

TEST_CASE("an installed program names the pages that are installed with it") {
  const TemporaryFolder folder;
  create_folder(folder.file("share/sidestep/scenarios"));
  create_folder(folder.file("share/sidestep/vision"));
  const std::string program = folder.file("bin/sidestep"),
                    scenarios = folder.file("share/sidestep/scenarios/README.md"),
                    vision = folder.file("share/sidestep/vision/README.md");
  write_file(scenarios, "# scenarios");
  write_file(vision, "# vision");
  CHECK(page_path("deploy/scenarios/README.md", program) == scenarios);
  CHECK(page_path("vision/README.md", program) == vision);
}

TEST_CASE("a program that is not installed names pages of the source tree") {
  const TemporaryFolder folder;
  CHECK(page_path("deploy/scenarios/README.md", folder.file("bin/sidestep")) == "deploy/scenarios/README.md");
  CHECK(page_path("deploy/scenarios/README.md", "") == "deploy/scenarios/README.md");
  CHECK(page_path("vision/README.md") == "vision/README.md");
}

}  // namespace sidestep::page_path_test
