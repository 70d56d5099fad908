// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/scenario/key_descriptions.hpp"

#include "tests/catch.hpp"

namespace sidestep::key_descriptions_test {

TEST_CASE("descriptions are read from the tables of a page, without formatting") {
  const auto found = key_descriptions(
      "# Page\n| file | robots |\n|---|---|\n| `a.yaml` | 8 |\n\n"
      "## Keys\n| key | unit | default | range | meaning |\n|---|---|---|---|---|\n"
      "| `field.length_m`, `field.width_m` | m | 9, 6 | 0.5–1000 | size, see [the field](#field) |\n"
      "| `name` | | | | [a] name of `x` |\n\nText.\n\n"
      "### `laser`\n| key | unit | range | meaning |\n|---|---|---|---|\n| `beams` | | 8–2048 | |\n\n"
      "### `faults`\n| fault | other keys | effect |\n|---|---|---|\n"
      "| `network: PROCESS` or `all` | `loss` (0–1) | impairs |\n"
      "| `switch_off: ROBOT`, `switch_on: ROBOT` | | power |\n");
  CHECK(found.at("field.length_m") == "size, see the field (unit: m; default: 9, 6; range: 0.5–1000)");
  CHECK(found.at("field.width_m") == found.at("field.length_m"));
  CHECK(found.at("name") == "[a] name of x");
  CHECK(found.at("laser.beams") == "range: 8–2048");
  CHECK(found.at("faults.network") == "impairs (other keys: loss (0–1))");
  CHECK(found.at("faults.switch_on") == "power");
  CHECK(found.count("faults.all") == 0);
  CHECK(found.at("a.yaml") == "8");
}

}  // namespace sidestep::key_descriptions_test
