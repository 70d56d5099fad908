// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_score.hpp"

#include <sstream>
#include <stdexcept>
#include <vector>

#include "tests/catch.hpp"

namespace sidestep::crowd_score_test {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
  return cells;
}

TEST_CASE("a crowd result survives the way through a row of cells") {
  const CrowdResult result{8, 8, 2, 1, 1.25, 4.5, 12.5};
  const CrowdResult read = crowd_result_from(split(crowd_result_cells(result)));
  CHECK(read.robots == 8);
  CHECK(read.arrived == 8);
  CHECK(read.contacts == 2);
  CHECK(read.violations == 1);
  CHECK(read.ratio == 1.25);
  CHECK(read.makespan_s == 4.5);
  CHECK(read.cpu_us == 12.5);
}

TEST_CASE("a crowd result without arrival times survives the way through a row of cells") {
  const CrowdResult read = crowd_result_from(split(crowd_result_cells({8, 7, 0, 0, {}, {}, 3})));
  CHECK(read.arrived == 7);
  CHECK_FALSE(read.ratio);
  CHECK_FALSE(read.makespan_s);
}

TEST_CASE("damaged cells of a crowd result are rejected") {
  CHECK_THROWS_AS(crowd_result_from(split("8,8,0,0,1.2,3.4")), std::invalid_argument);
  CHECK_THROWS_AS(crowd_result_from(split("8,8,0,0,1.2,3.4,1,1")), std::invalid_argument);
  CHECK_THROWS_AS(crowd_result_from(split("8,eight,0,0,1.2,3.4,1")), std::invalid_argument);
  CHECK_THROWS_AS(crowd_result_from(split("8,8,0,0,nan,3.4,1")), std::invalid_argument);
}

/// The score of results of the seeds 1, 2, ...
CrowdScore score_of(const std::vector<CrowdResult>& results) {
  CrowdScore score;
  for (std::uint64_t seed = 1; seed <= results.size(); ++seed) score.add(seed, results[seed - 1]);
  return score;
}

TEST_CASE("a crowd score is clean if all robots arrive without contacts and violations") {
  CHECK(score_of({{8, 8, 0, 0, 1.2, 3, 1}, {8, 8, 0, 0, 1.4, 5, 1}}).is_clean());
  CHECK_FALSE(score_of({{8, 8, 0, 0, 1.2, 3, 1}, {8, 7, 0, 0, {}, {}, 1}}).is_clean());
  CHECK_FALSE(score_of({{8, 8, 1, 0, 1.2, 3, 1}}).is_clean());
  CHECK_FALSE(score_of({{8, 8, 0, 1, 1.2, 3, 1}}).is_clean());
}

TEST_CASE(
    "a crowd score has the times of scenes in which all robots arrive, and the arrivals of all scenes") {
  const CrowdScore score = score_of({{8, 8, 0, 0, 1.2, 3, 2}, {8, 7, 0, 0, {}, {}, 4}});
  CHECK(score.scenes == 2);
  CHECK(score.robots == 16);
  CHECK(score.arrived == 15);
  CHECK(score.incomplete() == 1);
  CHECK(score.ratios().size() == 1);
  CHECK(score.makespans_s().size() == 1);
  CHECK(score.cpu_us.mean() == 3);
}

TEST_CASE(
    "a clean crowd score is better than a faster one with faults, and otherwise the lower ratio decides") {
  const CrowdScore clean = score_of({{8, 8, 0, 0, 1.5, 6, 1}}), faster = score_of({{8, 8, 0, 0, 1.3, 7, 1}});
  const CrowdScore contact = score_of({{8, 8, 1, 0, 1.1, 3, 1}});
  const CrowdScore stuck = score_of({{8, 7, 0, 0, {}, {}, 1}});
  CHECK(is_better(clean, contact));
  CHECK(is_better(clean, stuck));
  CHECK(is_better(stuck, contact));
  CHECK(is_better(faster, clean));
  CHECK_FALSE(is_better(clean, faster));
  CHECK_FALSE(is_better(clean, clean));
}

TEST_CASE("a crowd score without a complete scene never wins by its ratio") {
  const CrowdScore stuck_in_both = score_of({{8, 7, 0, 0, {}, {}, 1}, {8, 7, 0, 0, {}, {}, 1}});
  const CrowdScore stuck_in_one = score_of({{8, 6, 0, 0, {}, {}, 1}, {8, 8, 0, 0, 1.4, 5, 1}});
  CHECK(stuck_in_both.arrived == stuck_in_one.arrived);
  CHECK(is_better(stuck_in_one, stuck_in_both));
  CHECK_FALSE(is_better(stuck_in_both, stuck_in_one));
  CHECK_FALSE(is_better(stuck_in_both, stuck_in_both));
  CHECK_FALSE(relative_ratio(stuck_in_both, stuck_in_one));
}

TEST_CASE("the ratios of two crowd scores are compared over the scenes that both completed") {
  const CrowdScore fails_hard = score_of({{8, 8, 0, 0, 1.5, 3, 1}, {8, 7, 0, 0, {}, {}, 1}});
  const CrowdScore fails_easy = score_of({{8, 7, 0, 0, {}, {}, 1}, {8, 8, 0, 0, 4.0, 9, 1}});
  const CrowdScore fast = score_of({{8, 8, 0, 0, 1.2, 3, 1}, {8, 8, 0, 0, 4.0, 9, 1}});
  REQUIRE(relative_ratio(fails_hard, fast));
  CHECK(*relative_ratio(fails_hard, fast) == Approx(1.25));
  CHECK(*relative_ratio(fails_easy, fast) == Approx(1));
  // No scene tells which of these is faster.
  CHECK_FALSE(relative_ratio(fails_hard, fails_easy));
  CHECK_FALSE(is_better(fails_hard, fails_easy));
  CHECK_FALSE(is_better(fails_easy, fails_hard));
}

}  // namespace sidestep::crowd_score_test
