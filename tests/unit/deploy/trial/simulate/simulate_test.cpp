// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/simulate.hpp"

#include "common/file/temporary_folder.hpp"
#include "common/file/write_file.hpp"
#include "deploy/audit/picture/run_picture.hpp"
#include "tests/catch.hpp"
#include "tests/text_of.hpp"

namespace sidestep::simulate_test {

TEST_CASE("a simulated run draws its picture, which is that of its report") {
  const TemporaryFolder folder;
  SimulateOptions options;
  options.scenario_file = folder.file("swap.yaml");
  options.report_file = folder.file("swap.json");
  options.picture_file = folder.file("swap.svg");
  write_file(options.scenario_file,
             "field: {length_m: 4, width_m: 2}\n"
             "robots:\n"
             "- {id: 3, start_m: [-1, 0], goals_m: [[1, 0]]}\n"
             "- {id: 7, start_m: [1, 0], goals_m: [[-1, 0]]}\n");
  CHECK(simulate(options) == 0);
  const std::string svg = text_of(options.picture_file);
  CHECK_THAT(svg, ContainsSubstring("<title>path of robot 3</title>") &&
                      ContainsSubstring("<title>path of robot 7</title>") &&
                      ContainsSubstring("<animateTransform"));
  CHECK(svg == run_picture_from(text_of(options.report_file)));
}

}  // namespace sidestep::simulate_test
