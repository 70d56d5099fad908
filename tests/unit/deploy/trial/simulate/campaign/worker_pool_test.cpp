// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/worker_pool.hpp"

#include <csignal>
#include <map>
#include <numeric>
#include <stdexcept>
#include <unistd.h>

#include "tests/catch.hpp"

namespace sidestep::worker_pool_test {

struct Outcome {
  std::map<std::uint64_t, std::string> lines, deaths;
};

Outcome run(int workers, std::uint64_t first, std::uint64_t last, const WorkerPool::Work& work) {
  Outcome outcome;
  WorkerPool pool(workers, work, [&](std::uint64_t job, const std::string& line, const std::string& reason) {
    (reason.empty() ? outcome.lines : outcome.deaths)[job] = reason.empty() ? line : reason;
  });
  std::vector<std::uint64_t> jobs(last - first + 1);
  std::iota(jobs.begin(), jobs.end(), first);
  pool.run(jobs);
  return outcome;
}

TEST_CASE("every job is done once, for any number of workers") {
  const auto square = [](std::uint64_t job) {
    return std::to_string(job * job) + std::string(job * 100, '.');
  };
  const Outcome one = run(1, 3, 60, square), five = run(5, 3, 60, square);
  CHECK(one.lines.size() == 58);
  CHECK(one.lines == five.lines);
  CHECK(one.lines.at(7).substr(0, 2) == "49");
  CHECK(one.lines.at(60).size() == 6004);
  CHECK(five.deaths.empty());
}

TEST_CASE("a job that kills its worker is reported, and all other jobs are done") {
  const Outcome outcome = run(2, 1, 20, [](std::uint64_t job) {
    if (job == 5) std::raise(SIGKILL);
    if (job == 11) _exit(3);
    return std::to_string(job);
  });
  CHECK(outcome.lines.size() == 18);
  REQUIRE(outcome.deaths.size() == 2);
  CHECK_THAT(outcome.deaths.at(5), ContainsSubstring("signal 9"));
  CHECK(outcome.deaths.at(11) == "exit code 3");
}

}  // namespace sidestep::worker_pool_test
