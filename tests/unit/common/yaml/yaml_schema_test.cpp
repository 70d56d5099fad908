// SPDX-License-Identifier: Apache-2.0
#include "common/yaml/yaml_schema.hpp"

#include <array>

#include "common/yaml/yaml_map.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/yaml/schema_check.hpp"

namespace sidestep::yaml_schema_test {

constexpr std::array<std::string_view, 2> kColours{"red", "green"};

/// What a reader leaves in its values; a map without content must leave the defaults.
struct Values {
  double width_m = 2;
  int count = 3;
  Vec2 place_m{0, 1};
  std::string colour{"red"};
  bool is_dry = false;
  Duration delay = std::chrono::milliseconds(10);
};

void read(YamlMap& map, Values& values) {
  (void)map.require("width_m");
  map.read("width_m", {0.5, 4}, values.width_m);
  map.read("count", {1, 9}, values.count);
  map.read("place_m", {-5, 5}, values.place_m);
  map.read("colour", kColours, values.colour);
  map.read("dry", values.is_dry);
  map.read_heading("heading_rad", values.width_m);
  map.read_ms("delay_ms", {0, 100}, values.delay);
  (void)map.text("label");
  (void)map.points("path_m", 1, 3, {-5, 5});
  (void)map.names("colours", kColours, 2);
  (void)map.numbers("triple", 3, 3, {0, 1});
  (void)map.number("share", {0, 1});
  (void)map.integer("robot", {0, 7});
  read_section(map, "inner", [](YamlMap& inner) { (void)inner.number("depth_m", {0, 1}); });
  read_optional_list(map, "parts", 1, 2, [](YamlMap& part) {
    (void)part.require("id");
    (void)part.integer("id", {0, 3});
  });
  (void)map.find("anything");
}

std::string problem(const std::string& yaml) {
  Values values;
  const JsonSchema schema = mapping_schema([&](YamlMap& map) { read(map, values); });
  return schema_problem(schema, json_of(YAML::Load(yaml)));
}

TEST_CASE("a reader describes its keys with their types, ranges and defaults, and reads nothing") {
  Values values;
  const JsonSchema schema = mapping_schema([&](YamlMap& map) { read(map, values); });
  CHECK(values.width_m == 2);
  CHECK(values.delay == std::chrono::milliseconds(10));
  const JsonSchema& keys = schema["properties"];
  CHECK(schema["type"] == "object");
  CHECK(schema["required"] == JsonSchema::array({"width_m"}));
  CHECK(schema["additionalProperties"] == false);
  CHECK_FALSE(keys["width_m"].contains("default"));  // a required key has none
  CHECK(keys["width_m"]["minimum"] == 0.5);
  CHECK(keys["count"] == JsonSchema{{"type", "integer"}, {"minimum", 1}, {"maximum", 9}, {"default", 3}});
  CHECK(keys["place_m"]["default"] == JsonSchema::array({0.0, 1.0}));
  CHECK(keys["colour"] == JsonSchema{{"enum", JsonSchema::array({"red", "green"})}, {"default", "red"}});
  CHECK(keys["dry"] == JsonSchema{{"type", "boolean"}, {"default", false}});
  CHECK(keys["delay_ms"]["default"] == 10);
  CHECK(keys["anything"] == JsonSchema::object());
  CHECK(keys["inner"]["properties"]["depth_m"]["maximum"] == 1);
  CHECK(keys["parts"]["items"]["required"] == JsonSchema::array({"id"}));
}

TEST_CASE("a schema accepts what its reader reads, and rejects unknown keys, types and ranges") {
  CHECK(problem("{width_m: 1}").empty());
  CHECK(problem(
            "{width_m: 1, count: +4, place_m: [1, -2.5], colour: green, dry: true, heading_rad: -6.28, "
            "delay_ms: 0.5, label: 12, path_m: [[0, 0]], colours: [red, red], triple: [0, 1, 0.5], share: 1, "
            "robot: 7, inner: {}, parts: [{id: 0}, {id: 3}], anything: {at: all}}")
            .empty());
  for (const char* wrong : {"{}",
                            "{width_m: 5}",
                            "{width_m: wide}",
                            "{width_m: '1'}",
                            "{width_m: 1, count: 2.5}",
                            "{width_m: 1, place_m: [1]}",
                            "{width_m: 1, place_m: [1, 6]}",
                            "{width_m: 1, colour: blue}",
                            "{width_m: 1, dry: 1}",
                            "{width_m: 1, heading_rad: 7}",
                            "{width_m: 1, delay_ms: -1}",
                            "{width_m: 1, label: [a]}",
                            "{width_m: 1, path_m: []}",
                            "{width_m: 1, colours: [red, blue]}",
                            "{width_m: 1, triple: [0, 1]}",
                            "{width_m: 1, robot: 8}",
                            "{width_m: 1, inner: 3}",
                            "{width_m: 1, inner: {deep: 1}}",
                            "{width_m: 1, parts: []}",
                            "{width_m: 1, parts: [{}]}",
                            "{width_m: 1, parts: [{id: 0}, {id: 1}, {id: 2}]}",
                            "{width_m: 1, height_m: 2}",
                            "[1]"}) {
    CAPTURE(wrong);
    CHECK_FALSE(problem(wrong).empty());
  }
}

TEST_CASE("a reader that chooses among keys is described with each combination of its choices") {
  const std::vector<std::string> shapes{"disc", "bar"}, ends{"until_s", "for_s"};
  int calls = 0;
  const JsonSchema schema = mapping_schema([&](YamlMap& map) {
    ++calls;
    const std::string shape = map.schema()->choose(shapes);
    (void)map.number(shape, {0, 1});
    if (shape == "bar") (void)map.number(map.schema()->choose(ends), {0, 9});
  });
  CHECK(calls == 3);
  CHECK(schema["anyOf"].size() == 3);
  const auto problem = [&](const char* yaml) { return schema_problem(schema, json_of(YAML::Load(yaml))); };
  CHECK(problem("{disc: 1}").empty());
  CHECK(problem("{bar: 1, until_s: 3}").empty());
  CHECK(problem("{bar: 1, for_s: 3}").empty());
  for (const char* wrong :
       {"{}", "{bar: 1}", "{disc: 1, bar: 1}", "{disc: 1, for_s: 1}", "{bar: 1, for_s: 1, until_s: 1}"}) {
    CAPTURE(wrong);
    CHECK_FALSE(problem(wrong).empty());
  }
}

TEST_CASE("a name with a number stands for the names with all numbers") {
  const std::vector<std::string> names{"vision", "agent 0", "agent 12", "agent 0 (twin)"};
  const JsonSchema schema = name_schema(names);
  for (const char* good : {"vision", "agent 0", "agent 345", "agent 7 (twin)"})
    CHECK(schema_problem(schema, Json(good)).empty());
  for (const char* wrong : {"visio", "vision 1", "agent", "agent x", "agent 7 (twins)", "the agent 7"}) {
    CAPTURE(wrong);
    CHECK_FALSE(schema_problem(schema, Json(wrong)).empty());
  }
  const std::vector<std::string> plain{"in", "out"};
  CHECK(name_schema(plain) == JsonSchema{{"enum", JsonSchema::array({"in", "out"})}});
}

TEST_CASE("a mapping that requires any of several keys accepts each of them") {
  const std::vector<std::string> keys{"robots", "circle"};
  const JsonSchema schema = mapping_schema([&](YamlMap& map) {
    for (const std::string& key : keys) (void)map.integer(key, {0, 9});
    map.schema()->require_any(keys);
  });
  CHECK(schema_problem(schema, json_of(YAML::Load("{circle: 1}"))).empty());
  CHECK(schema_problem(schema, json_of(YAML::Load("{circle: 1, robots: 2}"))).empty());
  CHECK_FALSE(schema_problem(schema, json_of(YAML::Load("{}"))).empty());
}

}  // namespace sidestep::yaml_schema_test
