// SPDX-License-Identifier: Apache-2.0
#include "common/yaml/yaml_document.hpp"

#include "common/yaml/config_error.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/config/scenario_errors.hpp"

namespace sidestep::yaml_document_test {

std::string yaml_error(const std::string& text) {
  try {
    (void)parse_yaml(text, "file.yaml", "a file");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST_CASE("a tab that indents a line is reported as the error") {
  const auto [text, line] = GENERATE(table<std::string, int>({
      {"robots:\n\t- {id: 0}\n", 2},
      {"field:\n  length_m: 3\n\twidth_m: 3\n", 3},
      {"a: 1\n\tb: 2\n", 2},
      {"\trobots: 3\n", 1},
      {"a: 1\nb:\n\tc: 1\n", 3},
      {"a:\n  - 1\n \t- 2\n", 3},
  }));
  CAPTURE(text);
  CHECK(yaml_error(text) ==
        "file.yaml:" + std::to_string(line) + ": a tab indents this line, expected spaces");
}

TEST_CASE("tabs after the indentation are allowed, and other errors are not mistaken for tabs") {
  CHECK(yaml_error("a:\t[1,\t2]\t# three\ttabs\n") == "accepted");
  CHECK_THAT(yaml_error("a: [1,\tb: {\n"), ContainsSubstring("not YAML"));
}

TEST_CASE("a merge key adds the entries of another mapping that its own mapping lacks") {
  const auto [text, expected] = GENERATE(table<std::string, std::string>({
      {"[&a {x: 1, y: 2}, {<<: *a, y: 3}]", "[{x: 1, y: 2}, {y: 3, x: 1}]"},
      {"[{<<: {x: 1}}]", "[{x: 1}]"},
      {"[&a {x: 1}, &b {x: 2, y: 2}, {<<: [*a, *b], z: 3}]", "[{x: 1}, {x: 2, y: 2}, {z: 3, x: 1, y: 2}]"},
      {"[&a {x: 1}, &b {<<: *a, y: 2}, {<<: *b}]", "[{x: 1}, {y: 2, x: 1}, {x: 1, y: 2}]"},
      {"[{<<: {}}, {<<: []}]", "[{}, {}]"},
      {"[{\"<<\": 1}]", "[{\"<<\": 1}]"},
  }));
  CAPTURE(text);
  const YAML::Node root = parse_yaml(text, "file.yaml", "a file"), wanted = YAML::Load(expected);
  REQUIRE(root.size() == wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    CHECK(root[i].size() == wanted[i].size());
    for (const auto& entry : wanted[i])
      CHECK(root[i][entry.first.Scalar()].Scalar() == entry.second.Scalar());
  }
}

TEST_CASE("an invalid merge key is rejected with its line") {
  const auto [text, line, why] = GENERATE(table<std::string, int, std::string>({
      {"a: 1\n<<: 3\n", 2, "expected a mapping, or a list of mappings, to merge"},
      {"a: 1\n<<: [{b: 1}, 2]\n", 2, "expected a mapping, or a list of mappings, to merge"},
      {"<<: {a: 1}\n<<: {b: 1}\n", 2, "duplicate key \"<<\""},
      {"a: &a\n  <<: *a\n", 2, "an anchor is used inside its own value"},
      {"a: &a [*a]\n", 1, "an anchor is used inside its own value"},
      {"a: 1\n<<: *b\n", 2, "not YAML"},
  }));
  CAPTURE(text);
  CHECK_THAT(yaml_error(text), StartsWith("file.yaml:" + std::to_string(line) + ": "));
  CHECK_THAT(yaml_error(text), ContainsSubstring(why));
}

TEST_CASE("robots share keys by a merge key, and an error names the shared key's line") {
  const Scenario scenario = parse_scenario(
      "robots:\n"
      "  - &first {id: 0, start_m: [0, 0], heading_rad: 1}\n"
      "  - {<<: *first, id: 1, start_m: [1, 0]}\n",
      "file.yaml");
  REQUIRE(scenario.robots.size() == 2);
  CHECK(scenario.robots[1].id == 1);
  CHECK(scenario.robots[1].start_m == Vec2(1, 0));
  CHECK(scenario.robots[1].start_heading_rad == 1);
  check_rejected(
      "robots:\n"
      "  - {id: 0, start_m: [0, 0]}\n"
      "  - <<: {id: 1, colour: red,\n"
      "         start_m: [1, 0]}\n",
      3, "unknown key \"colour\"");
}

TEST_CASE("merged values count towards the maximum number of values") {
  std::string text = "- &a {";
  for (int i = 0; i < 1000; ++i) text += "k" + std::to_string(i) + ": 1, ";
  text += "}\n";
  for (int i = 0; i < 200; ++i) text += "- {<<: *a}\n";
  CHECK_THAT(yaml_error(text), ContainsSubstring("more than 400000 values"));
}

}  // namespace sidestep::yaml_document_test
