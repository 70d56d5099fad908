// SPDX-License-Identifier: Apache-2.0
#include "common/yaml/yaml_structure.hpp"

#include <fmt/format.h>

#include "common/yaml/config_error.hpp"
#include "common/yaml/yaml_document.hpp"
#include "tests/catch.hpp"

namespace sidestep::yaml_structure_test {

constexpr std::size_t kMaxValues = 1000;

std::string repeated(const std::string& part, std::size_t times) {
  std::string text;
  for (std::size_t i = 0; i < times; ++i) text += part;
  return text;
}

std::string structure_error(const std::string& text) {
  try {
    check_yaml_structure(text, "file.yaml", kMaxValues);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST_CASE("YAML with far more structure than the permitted values need is rejected before it is parsed") {
  const std::string part =
      GENERATE("[],", "{}", "a,", "a:\n", "*a,", "&a ", "!a ", "'a' ", "\"a\" ", "? ", "[#]\n", "%a b ");
  CAPTURE(part);
  CHECK_THAT(
      structure_error("[" + repeated(part, 2 * kMaxValues + 1)),
      ContainsSubstring("more than 2000 of the characters []{},:?&*!'\", expected at most 1000 values"));
  CHECK(structure_error("[" + repeated(part, kMaxValues / 2)) == "accepted");
}

TEST_CASE("brackets may nest as deep as yaml-cpp can parse, and brackets in comments do not count") {
  CHECK(structure_error("a: 1\nb: " + repeated("[", 501)) ==
        "file.yaml:2: expected at most 500 nested brackets");
  CHECK(structure_error(repeated("[{", 300)) == "file.yaml:1: expected at most 500 nested brackets");
  CHECK(structure_error(repeated("[", 500) + repeated("]", 500) + "[]") == "accepted");
  CHECK(structure_error(repeated("# of [0, 1)\n", 600)) == "accepted");
}

TEST_CASE("a file with the maximum number of values stays within the limit of structural characters") {
  const auto [robot, robots, values] = GENERATE(table<std::string, std::size_t, std::size_t>({
      {"  - [[-1.25, 2], [3, -4]]  # corners\n", 57'000, 7},
      {"  - {id: 1, start_m: [-1.5, 2.5], goals_m: [[1, 2], [3, 4]]}\n", 23'500, 17},
      {"  - id: 1\n    start_m: [1, 2]\n    goals_m:\n      - - 3\n        - -4\n", 33'000, 12},
      {"  - {\"id\": 1, \"start_m\": [1, 2]}\n", 57'000, 7},
  }));
  CAPTURE(robot, robots);
  CHECK(robots * values < 400'000);
  CHECK(parse_yaml("robots:\n" + repeated(robot, robots), "file.yaml", "a file")["robots"].size() == robots);
}

}  // namespace sidestep::yaml_structure_test
