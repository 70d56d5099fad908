// SPDX-License-Identifier: Apache-2.0
// Links between single processes that are permanently cut, lossy or slow,
// each in one direction.
#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/sim/shuttles.hpp"

namespace sidestep::link_matrix_test {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr double kMaxRest_s = 2;

enum class Link { kGood, kLossy, kSlow, kCut };

LinkQuality quality_of(Link link) {
  LinkQuality quality{0, 1, 0, microseconds(200), microseconds(350), milliseconds(1), false};
  if (link == Link::kLossy) quality.loss = 0.2;
  if (link == Link::kSlow) {
    quality.delay_min = milliseconds(5);
    quality.delay_mean = milliseconds(15);
    quality.delay_max = milliseconds(40);
  }
  quality.is_cut = link == Link::kCut;
  return quality;
}

using Matrix = std::map<std::pair<std::string, std::string>, Link>;

bool is_coordinator(const std::string& process) { return process.starts_with("coordinator"); }

/// Samples the quality of a link. Links that robots need under every coordinator are rarely cut, because no
/// other coordinator could replace them.
Link sample_link(const std::string& from, const std::string& to, double share, Rng& rng) {
  const bool is_of_coordinator = is_coordinator(from) || is_coordinator(to);
  if (!rng.chance(is_of_coordinator ? share : 0.05 * share)) return Link::kGood;
  const double u = rng.uniform();
  return u < 0.6 ? Link::kCut : u < 0.8 ? Link::kLossy : Link::kSlow;
}

Matrix sample_matrix(const Scenario& scenario, Rng& rng) {
  const auto names = system_process_names(scenario);
  const double share = rng.uniform(0.05, 0.6);
  Matrix matrix;
  for (const std::string& from : names)
    for (const std::string& to : names)
      if (from != to) matrix[{from, to}] = sample_link(from, to, share, rng);
  // Some coordinators receive nothing, or none of their messages arrive.
  for (const std::string& process : names) {
    if (!is_coordinator(process)) continue;
    const double u = rng.uniform();
    for (const std::string& other : names) {
      if (other == process) continue;
      if (u < 0.2) matrix[{other, process}] = Link::kCut;
      if (u >= 0.2 && u < 0.35) matrix[{process, other}] = Link::kCut;
    }
  }
  if (rng.chance(0.2)) return matrix;
  // In most matrices at least one coordinator can serve all robots.
  const std::string able =
      coordinator_process(static_cast<int>(rng.below(static_cast<std::uint64_t>(scenario.coordinators))));
  for (const std::string& other : names) {
    if (is_coordinator(other)) continue;
    for (const auto& link : {std::pair(able, other), std::pair(other, able)})
      if (matrix.contains(link)) matrix[link] = rng.chance(0.15) ? Link::kLossy : Link::kGood;
  }
  return matrix;
}

/// Decides independently of the code under test whether any coordinator and all agents can exchange messages,
/// and hear vision and robots.
bool can_any_coordinator_serve(const Scenario& scenario, const Matrix& matrix) {
  const auto is_usable = [&](const std::string& from, const std::string& to) {
    const Link link = matrix.at({from, to});
    return link == Link::kGood || link == Link::kLossy;
  };
  std::vector<std::string> agents;
  for (const RobotSpec& robot : scenario.robots) agents.push_back(agent_process(robot.id));
  const bool do_robots_work =
      is_usable("simulator", "vision") && std::ranges::all_of(agents, [&](const std::string& agent) {
        return is_usable("vision", agent) && is_usable("simulator", agent) && is_usable(agent, "simulator");
      });
  for (int number = 0; number < scenario.coordinators; ++number) {
    const std::string coordinator = coordinator_process(number);
    const bool serves = is_usable("simulator", coordinator) && is_usable("vision", coordinator) &&
                        std::ranges::all_of(agents, [&](const std::string& agent) {
                          return is_usable(agent, coordinator) && is_usable(coordinator, agent);
                        });
    if (do_robots_work && serves) return true;
  }
  return false;
}

std::string describe(const Matrix& matrix) {
  std::string text;
  for (const auto& [link, state] : matrix) {
    if (state == Link::kGood) continue;
    text += fmt::format("{} -> {}: {}\n", link.first, link.second,
                        state == Link::kCut    ? "cut"
                        : state == Link::kSlow ? "slow"
                                               : "lossy");
  }
  return text;
}

/// Runs a system whose links change, and returns the longest rest of any robot afterwards; nullopt if no
/// coordinator could have served all robots.
std::optional<double> run(std::uint64_t seed) {
  Rng rng(seed);
  const Scenario scenario = shuttles(4, 2 + static_cast<int>(rng.below(2)));
  const Duration at = from_seconds(rng.uniform(1.5, 3));
  const Matrix matrix = sample_matrix(scenario, rng);
  if (!can_any_coordinator_serve(scenario, matrix)) return std::nullopt;
  INFO(describe(matrix));
  SimSystem system(scenario, seed);
  MotionWatch motion(system);
  std::string events;
  system.on_event(LogLevel::kInfo, [&](const std::string& process, const LogEvent& event) {
    if (is_coordinator(process))
      events += fmt::format("{:.3f} s: {}: {}\n", to_seconds(system.now() - system.begin() - at), process,
                            event.text);
  });
  system.run_for(at);
  for (const auto& [link, state] : matrix) system.set_link(link.first, link.second, quality_of(state));
  motion.begin();
  system.run_for(seconds(12));
  double rest_s = 0;
  for (const RobotSpec& robot : scenario.robots) rest_s = std::max(rest_s, motion.longest_rest_s(robot.id));
  INFO(events);
  CHECK(rest_s <= kMaxRest_s);
  const Report report = system.metrics().report();
  CHECK(report.contacts == 0);
  CHECK(report.firmware_violations == 0);
  for (const Violation& violation : report.audit->first) UNSCOPED_INFO(to_line(violation));
  CHECK(report.audit->violations == 0);
  return rest_s;
}

void run_all(std::uint64_t first, std::uint64_t last) {
  std::vector<double> rests_s;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    CAPTURE(seed);
    if (const auto rest_s = run(seed)) rests_s.push_back(*rest_s);
  }
  REQUIRE_FALSE(rests_s.empty());
  std::ranges::sort(rests_s);
  const auto part = [&](double share) {
    return rests_s[static_cast<std::size_t>(share * static_cast<double>(rests_s.size() - 1))];
  };
  WARN(
      fmt::format("in {} of {} matrices one coordinator can serve all robots; longest rest of a robot: "
                  "{:.2f} s (median), "
                  "{:.2f} s (90 %), {:.2f} s (99 %), {:.2f} s (longest)",
                  rests_s.size(), last - first + 1, part(0.5), part(0.9), part(0.99), part(1)));
}

TEST_CASE("robots keep driving, with stops below two seconds, while any coordinator can reach all agents") {
  run_all(1, 40);
}

TEST_CASE(
    "robots keep driving, with stops below two seconds, while any coordinator can reach all agents, in 1,000 "
    "matrices",
    "[.long][slow]") {
  run_all(1, 1000);
}

/// Cuts links in one direction, and checks that no robot rests for long in the next 20 s.
void require_motion(int coordinators, const std::vector<std::pair<std::string, std::string>>& cuts) {
  const Scenario scenario = shuttles(3, coordinators);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(coordinators, seed);
    SimSystem system(scenario, seed);
    MotionWatch motion(system);
    system.run_for(milliseconds(2000));
    for (const auto& [from, to] : cuts) system.set_link(from, to, quality_of(Link::kCut));
    motion.begin();
    system.run_for(seconds(20));
    for (const RobotSpec& robot : scenario.robots) {
      CAPTURE(robot.id);
      CHECK(motion.longest_rest_s(robot.id) <= kMaxRest_s);
    }
    CHECK(system.metrics().report().contacts == 0);
    CHECK(system.metrics().report().audit->violations == 0);
  }
}

std::vector<std::pair<std::string, std::string>> links_to(const std::string& process, int coordinators) {
  std::vector<std::pair<std::string, std::string>> links;
  for (const std::string& other : system_process_names(shuttles(3, coordinators)))
    if (other != process) links.emplace_back(other, process);
  return links;
}

std::vector<std::pair<std::string, std::string>> links_from(const std::string& process, int coordinators) {
  auto links = links_to(process, coordinators);
  for (auto& [from, to] : links) std::swap(from, to);
  return links;
}

TEST_CASE("robots keep driving although a standby receives nothing") {
  const int coordinators = GENERATE(2, 3);
  require_motion(coordinators, links_to(coordinator_process(coordinators - 1), coordinators));
}

TEST_CASE("robots keep driving after the active coordinator stops receiving messages") {
  require_motion(2, links_to("coordinator 0", 2));
}

TEST_CASE("robots keep driving after all messages from the active coordinator are lost") {
  require_motion(2, links_from("coordinator 0", 2));
}

TEST_CASE("robots keep driving although the active coordinator does not hear one agent") {
  require_motion(2, {{"agent 1", "coordinator 0"}});
}

TEST_CASE("robots keep driving although one agent does not hear the active coordinator") {
  require_motion(2, {{"coordinator 0", "agent 1"}});
}

TEST_CASE("robots keep driving although the active coordinator does not hear vision or the robots") {
  require_motion(2, {{GENERATE("vision", "simulator"), "coordinator 0"}});
}

TEST_CASE(
    "robots keep driving although a standby hears the robots but neither the active coordinator nor one "
    "agent") {
  require_motion(2, {{"coordinator 0", "coordinator 1"}, {"agent 2", "coordinator 1"}});
}

TEST_CASE(
    "robots keep driving although coordinators do not hear each other and one of them does not hear one "
    "agent") {
  require_motion(
      2,
      {{"coordinator 0", "coordinator 1"}, {"coordinator 1", "coordinator 0"}, {"agent 2", "coordinator 1"}});
}

}  // namespace sidestep::link_matrix_test
