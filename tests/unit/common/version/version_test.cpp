// SPDX-License-Identifier: Apache-2.0
#include "common/version/version.hpp"

#include <regex>

#include "tests/catch.hpp"

namespace sidestep::version_test {

TEST_CASE("the version of the programs is that of the project and thereby of the package") {
  CHECK(std::string(kVersion) == SIDESTEP_PROJECT_VERSION);
}

TEST_CASE("the option --version prints the version, the commit and the version of Fast DDS") {
  const std::regex expected(
      R"(Sidestep \d+\.\d+\.\d+, commit ([0-9a-f]{12}(-changed)?|unknown), Fast DDS 3\.1\.2)");
  const std::string text = version_text("3.1.2");
  CAPTURE(text);
  CHECK(std::regex_match(text, expected));
}

}  // namespace sidestep::version_test
