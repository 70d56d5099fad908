// SPDX-License-Identifier: Apache-2.0
#include "common/config/shared_rules.hpp"

#include <fmt/format.h>

#include "common/config/scenario_loader.hpp"
#include "common/random/rng.hpp"
#include "idl/rules.hpp"
#include "tests/catch.hpp"

namespace sidestep::shared_rules_test {

Scenario scenario_of(const std::string& text) { return parse_scenario(text, "test.yaml"); }

const std::string kRobots =
    "robots:\n"
    "  - {id: 0, start_m: [0, 0], goals_m: [[1, 1]]}\n"
    "  - {id: 1, start_m: [1, 0], goals_m: [[2, 1]]}\n"
    "  - {id: 2, start_m: [2, 0], goals_m: [[0, 1]]}\n"
    "  - {id: 5, start_m: [-1, 0], goals_m: [[-1, 1]]}\n"
    "  - {id: 6, team: yellow, start_m: [-2, 0], goals_m: [[-2, 1]]}\n";

TEST_CASE("the rules are listed as scenario keys and values") {
  const SharedRules rules(scenario_of(kRobots + "obstacles: [{centre_m: [0, 2], radius_m: 0.25}]\n"));
  CHECK(rules.text() ==
        "robots.blue: 0-2, 5\n"
        "robots.yellow: 6\n"
        "field.length_m: 9\n"
        "field.width_m: 6\n"
        "obstacles: circle: {centre_m: [0, 2], radius_m: 0.25}\n"
        "limits.acceleration_mps2: 3\n"
        "limits.deceleration_mps2: 5\n"
        "limits.speed_mps: 2\n"
        "radius_m: 0.09\n"
        "margin_m: 0.014\n"
        "tracking_bound_m: 0.005\n"
        "clock_bound_s: 0.0005\n"
        "max_opponent_speed_mps: 1.5\n");
}

TEST_CASE("goals, noise and the network are not part of the rules") {
  Scenario other = scenario_of(kRobots);
  const SharedRules rules(other);
  other.robots.front().goals = {{{2, 2}, 1.0}};
  other.vision.rate_hz = 30;
  other.network.loss = 0.5;
  other.name = "another";
  CHECK(SharedRules(other).fingerprint() == rules.fingerprint());
}

TEST_CASE("maps that differ in one cell or in position are different rules") {
  const auto with_map = [](double origin_m, int column) {
    MapGrid grid;
    grid.columns = 300, grid.rows = 200, grid.origin_m = {origin_m, -5};
    BitGrid blocked(grid.columns, grid.rows);
    blocked.set(column, 199);
    Scenario scenario = scenario_of(kRobots);
    scenario.map = std::make_shared<const FloorMap>(OccupancyMap(grid, blocked));
    return SharedRules(scenario);
  };
  const SharedRules rules = with_map(-7, 10);
  CHECK(with_map(-7, 10).fingerprint() == rules.fingerprint());
  for (const SharedRules& other :
       {with_map(-7, 11), with_map(-7.05, 10), SharedRules(scenario_of(kRobots))}) {
    CHECK(other.fingerprint() != rules.fingerprint());
    CHECK_FALSE(other.differences(rules).empty());
    CHECK_FALSE(rules.differences(other).empty());
  }
}

TEST_CASE("rules survive conversion to text and parsing") {
  const SharedRules rules(scenario_of(kRobots));
  const auto received = SharedRules::parse(rules.text());
  REQUIRE(received);
  CHECK(received->fingerprint() == rules.fingerprint());
  CHECK(received->text() == rules.text());
  CHECK(rules.differences(*received).empty());
}

TEST_CASE("a difference between rules is described by its key and both values") {
  Scenario other = scenario_of(kRobots);
  const SharedRules own(other);
  other.margin_m = 0.02;
  other.robots.pop_back();
  const SharedRules others(other);
  CHECK(own.fingerprint() != others.fingerprint());
  CHECK(describe(own.differences(others)) ==
        "robots.yellow is none instead of 6, margin_m is 0.02 instead of 0.014");
  const auto unknown = SharedRules::parse("margin_m: 0.014\nwings: 2\n");
  REQUIRE(unknown);
  const auto differences = own.differences(*unknown);
  CHECK(differences.size() == 13);
  CHECK(describe({differences.front(), differences.back()}) ==
        "robots.blue is unknown instead of 0-2, 5, wings is 2 instead of unknown");
}

TEST_CASE("the rules of the largest scenario fit a message and change with each of its obstacles") {
  std::string text = "field: {length_m: 1000, width_m: 1000}\nrobots:\n";
  for (int i = 0; i < 500; ++i)
    text += fmt::format("  - {{id: {}, start_m: [{}, 0], goals_m: [[{}, 1]]}}\n", 2 * i, i - 250, i - 250);
  text += "obstacles:\n";
  for (int i = 0; i < 1000; ++i)
    text += fmt::format("  - {{centre_m: [{}, 300], radius_m: 0.123456789}}\n", 0.1 * i);
  Scenario scenario = scenario_of(text);
  const SharedRules rules(scenario);
  CHECK(rules.text().size() < msg::MAX_RULES_TEXT);
  std::get<Circle>(scenario.obstacles[700]).radius_m += 1e-9;
  const auto differences = rules.differences(SharedRules(scenario));
  REQUIRE(differences.size() == 1);
  CHECK(differences.front().key == "obstacles");
}

TEST_CASE("text that does not contain rules is rejected") {
  for (const std::string text : {"margin_m", "margin_m: 0.01", ": 0.01\n", "margin_m: \n", "margin_m:0.01\n",
                                 "a: 1\na: 2\n", "a: \x1b[2J\n", "a: 1\n\n", "\n", "a: 1\nb\n"}) {
    CAPTURE(text);
    CHECK_FALSE(SharedRules::parse(text));
  }
  CHECK_FALSE(SharedRules::parse(std::string(65, 'k') + ": 1\n"));
  CHECK_FALSE(SharedRules::parse("k: " + std::string(msg::MAX_RULES_TEXT, '1') + "\n"));
  std::string many;
  for (int i = 0; i < 65; ++i) many += fmt::format("k{}: 1\n", i);
  CHECK_FALSE(SharedRules::parse(many));
  const auto none = SharedRules::parse("");
  REQUIRE(none);
  CHECK(none->fingerprint() != 0);
}

TEST_CASE("random bytes are rejected or decode to printable rules") {
  Rng rng(7);
  const std::string original = SharedRules(scenario_of(kRobots)).text();
  for (int i = 0; i < 20'000; ++i) {
    std::string text = original;
    for (std::uint64_t changes = 1 + rng.below(4); changes > 0; --changes)
      text[rng.below(text.size())] = static_cast<char>(rng.below(256));
    const auto rules = SharedRules::parse(text);
    if (!rules) continue;
    REQUIRE(rules->text() == text);
    for (const char c : text) REQUIRE((c == '\n' || (c >= ' ' && c <= '~')));
  }
}

}  // namespace sidestep::shared_rules_test
