// SPDX-License-Identifier: Apache-2.0
#include "common/marking/layout_file.hpp"

#include "common/config/scenario_loader.hpp"
#include "common/marking/butterfly.hpp"
#include "tests/catch.hpp"

namespace sidestep::layout_file_test {

const std::string kPair = R"(name: pair
centre: {radius_m: 0.02, blue: blue, yellow: yellow}
dots:
  - {position_m: [0.05, 0], radius_m: 0.02}
  - {position_m: [-0.05, 0], radius_m: 0.02}
patterns:
  - {id: 4, colours: [pink, green]}
  - {id: 2, colours: [pink, red]}
)";

void check_rejected(const std::string& old_text, const std::string& new_text, int line,
                    const std::string& expected) {
  std::string text = kPair;
  const auto at = text.find(old_text);
  REQUIRE(at != std::string::npos);
  text.replace(at, old_text.size(), new_text);
  INFO(text);
  try {
    (void)parse_layout(text, "pair.yaml");
    FAIL("the invalid layout was accepted");
  } catch (const ConfigError& error) {
    INFO(error.what());
    const std::string beginning = "pair.yaml:" + std::to_string(line) + ": ";
    CHECK(std::string(error.what()).rfind(beginning, 0) == 0);
    CHECK(std::string(error.what()).find(expected) != std::string::npos);
  }
}

TEST_CASE("a layout is read from a file") {
  const MarkerLayout layout = parse_layout(kPair, "pair.yaml");
  CHECK(layout.name == "pair");
  CHECK(layout.team_colour(Team::kBlue) == Colour::kBlue);
  CHECK(layout.team_colour(Team::kYellow) == Colour::kYellow);
  REQUIRE(layout.dots.size() == 2);
  CHECK(layout.dots[1].position_m == Vec2(-0.05, 0));
  REQUIRE(layout.find(2) != nullptr);
  CHECK(layout.find(2)->colours == std::vector{Colour::kPink, Colour::kRed});
  CHECK(layout.find(0) == nullptr);
}

TEST_CASE("the butterfly file equals the built-in butterfly") {
  const MarkerLayout layout = load_layout(SIDESTEP_SOURCE_DIR "/deploy/scenarios/markings/butterfly.yaml");
  const MarkerLayout& built_in = butterfly();
  CHECK(layout.name == built_in.name);
  CHECK(layout.centre.position_m == built_in.centre.position_m);
  CHECK(layout.centre.radius_m == built_in.centre.radius_m);
  REQUIRE(layout.dots.size() == built_in.dots.size());
  for (std::size_t i = 0; i < layout.dots.size(); ++i) {
    CHECK(layout.dots[i].position_m == built_in.dots[i].position_m);
    CHECK(layout.dots[i].radius_m == built_in.dots[i].radius_m);
  }
  REQUIRE(layout.patterns.size() == built_in.patterns.size());
  for (std::size_t i = 0; i < layout.patterns.size(); ++i) {
    CHECK(layout.patterns[i].id == built_in.patterns[i].id);
    CHECK(layout.patterns[i].colours == built_in.patterns[i].colours);
  }
  CHECK(!validation_error(built_in));
}

TEST_CASE("an invalid layout is rejected with its line") {
  check_rejected("name: pair\n", "", 1, "\"name\" is missing");
  check_rejected("blue: blue", "blue: beige", 2, "expected one of field, white");
  check_rejected("blue: blue", "blue: yellow", 2, "both teams have the same colour");
  check_rejected("radius_m: 0.02, blue", "radius_m: 0, blue", 2, "expected 0.001 to 0.5");
  check_rejected("position_m: [0.05, 0], ", "", 4, "\"position_m\" is missing");
  check_rejected("[0.05, 0]", "[0.03, 0]", 4, "overlaps the centre dot");
  check_rejected("[-0.05, 0]", "[0.05, 0.03]", 5, "overlaps dots[0]");
  check_rejected("[-0.05, 0]", "[-2, 0]", 5, "expected -1 to 1");
  check_rejected("[pink, green]", "[pink, pink]", 7, "the pattern looks the same rotated by 180 degrees");
  check_rejected("[pink, red]", "[green, pink]", 8, "looks like the pattern of id 4 rotated by 180 degrees");
  check_rejected("[pink, red]", "[pink, green]", 8, "looks like the pattern of id 4 rotated by 0 degrees");
  check_rejected("[pink, red]", "[pink, blue]", 8, "blue is a team colour");
  check_rejected("[pink, red]", "[pink]", 8, "expected 2 colours");
  check_rejected("[pink, red]", "[pink, 5]", 8, "expected one of");
  check_rejected("id: 2", "id: 4", 8, "duplicate id 4");
  check_rejected("id: 2", "id: -2", 8, "expected 0 to");
  check_rejected("name: pair", "name: pair\nshape: round", 2, "unknown key \"shape\"");
  CHECK_THROWS_AS(parse_layout("", "empty.yaml"), ConfigError);
  CHECK_THROWS_AS(parse_layout("name: x\ncentre: {radius_m: 0.02, blue: blue, yellow: yellow}\ndots: []\n"
                               "patterns: []",
                               "empty.yaml"),
                  ConfigError);
}

}  // namespace sidestep::layout_file_test
