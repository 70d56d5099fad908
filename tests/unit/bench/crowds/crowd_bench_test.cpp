// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_bench.hpp"

#include <filesystem>
#include <stdexcept>

#include "common/config/scenario_loader.hpp"
#include "common/file/read_file.hpp"
#include "common/file/temporary_folder.hpp"
#include "tests/bench/crowds/crowd_families.hpp"
#include "tests/bench/crowds/crowd_trial.hpp"
#include "tests/catch.hpp"

namespace sidestep::crowd_bench_test {

Scenario first_crossing() { return crowd_scene(*find_crowd_family("crossing-streams"), 1); }

TEST_CASE("Sidestep drives the crossing streams without contacts and violations, always alike") {
  const CrowdResult result = crowd_result_of(drive_crowd(first_crossing(), 1));
  CHECK(result.robots == 10);
  CHECK(result.arrived == 10);
  CHECK(result.contacts == 0);
  CHECK(result.violations == 0);
  CHECK(result.ratio.value() > 1);
  CHECK(result.makespan_s.value() > 2);
  CHECK(result.cpu_us > 0);
  CHECK(crowd_result_of(drive_crowd(first_crossing(), 1)).makespan_s == result.makespan_s);
}

TEST_CASE("robots that run out of time have no ratio and no makespan") {
  Scenario scenario = first_crossing();
  scenario.time_limit_s = 1;
  const CrowdResult result = crowd_result_of(drive_crowd(scenario, 1));
  CHECK(result.arrived < 10);
  CHECK_FALSE(result.ratio);
  CHECK_FALSE(result.makespan_s);
}

TEST_CASE("a run of which the audit heard too little counts as a violation") {
  Report report;
  report.robots = report.arrived = 2;
  report.audit.emplace();
  REQUIRE(report.verdict() == AuditVerdict::kNotJudged);
  CHECK(crowd_result_of(report).violations == 1);
}

constexpr std::size_t kMaxBytes = 100'000;

TEST_CASE("the benchmark of crowds writes its tables, its plots and a picture of each family") {
  const TemporaryFolder folder;
  CrowdBenchOptions options;
  options.families = {"crossing-streams"};
  options.methods = {"sidestep", "reciprocal"};
  options.seeds = {1, 2};
  options.folder = folder.path();
  CHECK(bench_crowds(options));
  CHECK(read_file(folder.file("crowds.csv"), kMaxBytes).find("crossing-streams,sidestep,-,2,2,20,20,0,0,") !=
        std::string::npos);
  CHECK(read_file(folder.file("scenes.csv"), kMaxBytes).find("crossing-streams,reciprocal,") !=
        std::string::npos);
  CHECK(std::filesystem::file_size(folder.file("crowds.png")) > 1000);
  CHECK(std::filesystem::file_size(folder.file("crossing-streams.svg")) > 1000);
  CHECK(load_scenario(folder.file("crossing-streams.yaml")).robots.size() == 10);
}

TEST_CASE("the benchmark of crowds rejects unknown names and missing seeds before it begins") {
  CrowdBenchOptions options;
  CHECK_THROWS_AS(bench_crowds(options), std::invalid_argument);
  options.seeds = {1};
  options.families = {"quiet-afternoon"};
  CHECK_THROWS_AS(bench_crowds(options), std::invalid_argument);
  options.families = {"doorway"};
  options.methods = {"telepathy"};
  CHECK_THROWS_AS(bench_crowds(options), std::invalid_argument);
}

}  // namespace sidestep::crowd_bench_test
