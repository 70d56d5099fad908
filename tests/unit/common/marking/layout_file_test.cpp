// SPDX-License-Identifier: Apache-2.0
#include "common/marking/layout_file.hpp"

#include <catch2/catch.hpp>

#include "common/config/scenario_loader.hpp"
#include "common/marking/butterfly.hpp"
#include "deploy/evaluation/camera/pattern_count.hpp"

using namespace sidestep;

namespace {

const std::string kPair = R"(name: pair
centre: {radius_m: 0.02, blue: blue, yellow: yellow}
dots:
  - {position_m: [0.05, 0], radius_m: 0.02}
  - {position_m: [-0.05, 0], radius_m: 0.02}
patterns:
  - {id: 4, colours: [pink, green]}
  - {id: 2, colours: [pink, red]}
)";

void check_refused(const std::string& old_words, const std::string& new_words, int line,
                   const std::string& words) {
  std::string text = kPair;
  const auto at = text.find(old_words);
  REQUIRE(at != std::string::npos);
  text.replace(at, old_words.size(), new_words);
  INFO(text);
  try {
    (void)parse_layout(text, "pair.yaml");
    FAIL("it was accepted");
  } catch (const ScenarioError& error) {
    INFO(error.what());
    const std::string beginning = "pair.yaml:" + std::to_string(line) + ": ";
    CHECK(std::string(error.what()).rfind(beginning, 0) == 0);
    CHECK(std::string(error.what()).find(words) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("a layout comes from a file") {
  const MarkingLayout layout = parse_layout(kPair, "pair.yaml");
  CHECK(layout.name == "pair");
  CHECK(layout.team_colour(Team::kBlue) == Colour::kBlue);
  CHECK(layout.team_colour(Team::kYellow) == Colour::kYellow);
  REQUIRE(layout.dots.size() == 2);
  CHECK(layout.dots[1].position_m == Vec2(-0.05, 0));
  REQUIRE(layout.find(2) != nullptr);
  CHECK(layout.find(2)->colours == std::vector{Colour::kPink, Colour::kRed});
  CHECK(layout.find(0) == nullptr);
}

TEST_CASE("the butterfly's file is the built-in butterfly") {
  const MarkingLayout layout = load_layout(SIDESTEP_SOURCE_DIR "/deploy/scenarios/markings/butterfly.yaml");
  const MarkingLayout& built_in = butterfly();
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
  CHECK(!fault_of(built_in));
}

TEST_CASE("the square's patterns differ in two dots at least") {
  const MarkingLayout layout = load_layout(SIDESTEP_SOURCE_DIR "/deploy/scenarios/markings/square.yaml");
  CHECK(smallest_difference(layout) == 2);
  CHECK(countable_patterns(layout, used_colours(layout)) == 60);
}

TEST_CASE("a wrong layout is refused with the line") {
  check_refused("name: pair\n", "", 1, "\"name\" is missing");
  check_refused("blue: blue", "blue: beige", 2, "expected one of field, white");
  check_refused("blue: blue", "blue: yellow", 2, "both teams have one colour");
  check_refused("radius_m: 0.02, blue", "radius_m: 0, blue", 2, "expected 0.001 to 0.5");
  check_refused("position_m: [0.05, 0], ", "", 4, "\"position_m\" is missing");
  check_refused("[0.05, 0]", "[0.03, 0]", 4, "overlaps the centre dot");
  check_refused("[-0.05, 0]", "[0.05, 0.03]", 5, "overlaps dots[0]");
  check_refused("[-0.05, 0]", "[-2, 0]", 5, "expected -1 to 1");
  check_refused("[pink, green]", "[pink, pink]", 7, "turned by 180 degrees it looks the same");
  check_refused("[pink, red]", "[green, pink]", 8, "looks like that of id 4, turned by 180 degrees");
  check_refused("[pink, red]", "[pink, green]", 8, "looks like that of id 4, turned by 0 degrees");
  check_refused("[pink, red]", "[pink, blue]", 8, "blue is a team's colour");
  check_refused("[pink, red]", "[pink]", 8, "expected 2 colours");
  check_refused("[pink, red]", "[pink, 5]", 8, "expected one of");
  check_refused("id: 2", "id: 4", 8, "stands here twice");
  check_refused("id: 2", "id: -2", 8, "expected 0 to");
  check_refused("name: pair", "name: pair\nshape: round", 2, "unknown key \"shape\"");
  CHECK_THROWS_AS(parse_layout("", "empty.yaml"), ScenarioError);
  CHECK_THROWS_AS(parse_layout("name: x\ncentre: {radius_m: 0.02, blue: blue, yellow: yellow}\ndots: []\n"
                               "patterns: []",
                               "empty.yaml"),
                  ScenarioError);
}
