// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "common/json/json_text.hpp"
#include "tests/catch.hpp"
#include "tests/faults/launched_run.hpp"
#include "tests/needs_root.hpp"

using namespace sidestep;

namespace {

bool has_namespaces(pid_t launcher) {
  const auto all = run_namespaces();
  return std::any_of(all.begin(), all.end(), [&](const auto& one) { return one.launcher == launcher; });
}

std::string figures(const nlohmann::json& report) {
  return "makespan " + json_text(report["makespan_s"]) + " s, missed " + json_text(report["missed_cycles"]) +
         " of " + json_text(report["cycles"]) + " cycles, negotiation " +
         json_text(report["negotiation_us"]) + " us";
}

}  // namespace

TEST_CASE("22 robots on three hosts with 5 % packet loss all arrive without contact", "[both-cores]") {
  SIDESTEP_NEEDS_ROOT();
  const auto run = LaunchedRun::on_namespaces(shipped_scenario("two-teams-22"));
  for (const char* host : {"floor", "east", "west"}) {
    const std::string name = "sidestep-" + std::to_string(run->pid()) + "-" + host;
    REQUIRE(run->command({"fault", "link", name, "--loss", "0.05"}) == "exit code 0");
  }
  const std::string ended = run->wait_for_end();
  INFO(run->output());
  check_passed_or_missed_messages(*run, ended);
  const auto report = run->report();
  require_no_violations(report);
  CHECK(report["arrived"] == 22);
  for (const char* host : {"floor", "east", "west"}) CHECK(run->robots_on(host).size() >= 7);
  CHECK_FALSE(has_namespaces(run->pid()));
  WARN("22 robots, three hosts, 5 % loss: " << figures(report));
}

TEST_CASE("22 robots on three hosts without multicast all arrive without contact", "[both-cores]") {
  SIDESTEP_NEEDS_ROOT();
  const auto file =
      std::filesystem::temp_directory_path() / ("sidestep-peers-" + std::to_string(getpid()) + ".yaml");
  std::ofstream(file) << shipped("run/launch/hosts/three-namespaces-peers.yaml");
  const auto run = LaunchedRun::on_namespaces(shipped_scenario("two-teams-22"), {}, file.string());
  REQUIRE(run->wait_until([&] { return has_namespaces(run->pid()); }));
  const auto in_namespace = [&](const std::string& host, const std::string& command) {
    return "ip netns exec sidestep-" + std::to_string(run->pid()) + "-" + host + " " + command;
  };
  // All multicast packets are dropped and counted, in both directions.
  for (const char* host : {"floor", "east", "west"}) {
    for (const char* command :
         {"nft add table ip peers", "nft 'add chain ip peers out { type filter hook output priority 0; }'",
          "nft 'add chain ip peers in { type filter hook input priority 0; }'",
          "nft add rule ip peers out ip daddr 224.0.0.0/4 ip protocol udp counter drop",
          "nft add rule ip peers in ip daddr 224.0.0.0/4 counter drop"})
      REQUIRE(std::system(in_namespace(host, command).c_str()) == 0);
  }
  REQUIRE(run->wait_until([&] { return run->printed("the coordinator grants"); }));
  std::string sent;
  for (const char* host : {"floor", "east", "west"}) {
    std::FILE* const list = popen(in_namespace(host, "nft list chain ip peers out").c_str(), "r");
    REQUIRE(list != nullptr);
    char line[256];
    while (std::fgets(line, sizeof line, list)) sent += line;
    pclose(list);
  }
  const std::string ended = run->wait_for_end();
  INFO(run->output() << sent);
  CHECK(ended == "exit code 0");
  const auto report = run->report();
  require_no_violations(report);
  CHECK(report["arrived"] == 22);
  std::size_t silent = 0;
  for (std::size_t at = 0; (at = sent.find("packets 0 bytes 0", at)) != std::string::npos; ++at) ++silent;
  CHECK(silent == 3);
  WARN("22 robots, three hosts, no multicast: started after " << json_text(report["wall_clock"]["startup_s"])
                                                              << " s, " << figures(report));
  std::filesystem::remove(file);
}

TEST_CASE("vision finds the robots in images of cameras on another host", "[both-cores]") {
  SIDESTEP_NEEDS_ROOT();
  std::string hosts = shipped("run/launch/hosts/three-namespaces.yaml");
  for (const auto& [from, to] : {std::pair<std::string, std::string>("simulator, vision, ", "simulator, "),
                                 {"    standbys: rest", "    processes: [vision]\n    standbys: rest"}}) {
    REQUIRE(hosts.find(from) != std::string::npos);
    hosts.replace(hosts.find(from), from.size(), to);
  }
  const auto file =
      std::filesystem::temp_directory_path() / ("sidestep-hosts-" + std::to_string(getpid()) + ".yaml");
  std::ofstream(file) << hosts;
  // With 60 images a second per camera, packets between hosts would use most of two slow cores.
  const auto run = LaunchedRun::on_namespaces(crossing_images(30), {"--seconds", "120"}, file.string());
  const std::string ended = run->wait_for_end();
  INFO(run->output());
  CHECK(ended == "exit code 0");
  const auto report = run->report();
  require_no_violations(report);
  CHECK(report["arrived"] == 8);
  std::filesystem::remove(file);
}

TEST_CASE("robots on a host that is cut off for five seconds stop, the others continue, and all arrive",
          "[both-cores]") {
  SIDESTEP_NEEDS_ROOT();
  const auto run = LaunchedRun::on_namespaces(shipped_scenario("two-teams-22"));
  REQUIRE(run->wait_until([&] { return run->max_speed_mps() > 0.5; }));
  const auto cut_off = run->robots_on("west");
  std::vector<RobotId> others = run->robots_on("floor");
  const auto east = run->robots_on("east");
  others.insert(others.end(), east.begin(), east.end());
  REQUIRE(cut_off.size() >= 7);
  REQUIRE(run->wait_until([&] { return run->max_speed_mps(cut_off) > 0.5; }));

  const std::string west = "sidestep-" + std::to_string(run->pid()) + "-west";
  run->start("partition", "sidestep", {"fault", "partition", west, "--seconds", "5"});
  REQUIRE(run->wait_until([&] { return run->printed("drops 100 %"); }));
  const Time cut_at = run->bus().now();
  REQUIRE(run->wait_until([&] { return run->max_speed_mps(cut_off) < 0.02; }));
  // During the partition the cut-off robots stay at rest while others move. Robots may notice the end of the
  // partition before it is printed.
  double max_cut_off_mps = 0, max_others_mps = 0;
  REQUIRE(run->wait_until([&] {
    if (run->bus().now() > cut_at + std::chrono::seconds(4)) return true;
    max_cut_off_mps = std::max(max_cut_off_mps, run->max_speed_mps(cut_off));
    max_others_mps = std::max(max_others_mps, run->max_speed_mps(others));
    return false;
  }));
  CHECK(max_cut_off_mps < 0.05);
  CHECK(max_others_mps > 0.3);
  const std::string ended = run->wait_for_end();
  INFO(run->output());
  CHECK(ended == "exit code 0");
  require_no_violations(run->report());
  CHECK(run->report()["arrived"] == 22);
  WARN("one of three hosts cut off for 5 s: " << figures(run->report()));
}

TEST_CASE("a run removes the namespaces that a killed launcher has left behind") {
  SIDESTEP_NEEDS_ROOT();
  const auto killed = LaunchedRun::on_namespaces(shipped_scenario("crossing"));
  REQUIRE(killed->wait_until([&] { return killed->children().size() == 11; }));
  REQUIRE(has_namespaces(killed->pid()));
  REQUIRE(kill(killed->pid(), SIGKILL) == 0);
  (void)killed->wait_for_end();
  CHECK(has_namespaces(killed->pid()));
  LaunchedRun next(shipped_scenario("crossing"), {"--hosts", three_hosts_file(), "--seconds", "0.1"});
  REQUIRE(next.wait_for_end() == "exit code 1");
  CHECK_FALSE(has_namespaces(killed->pid()));
  CHECK_FALSE(has_namespaces(next.pid()));
}

TEST_CASE("a packet fault is refused if its host is unknown or no loss is given") {
  SIDESTEP_NEEDS_ROOT();
  const auto run = LaunchedRun::on_namespaces(shipped_scenario("crossing"));
  CHECK(run->command({"fault", "partition", "sidestep-" + std::to_string(run->pid()) + "-south"}) ==
        "exit code 1");
  CHECK(run->printed("no host sidestep-"));
  CHECK(run->command({"fault", "link", "west"}) == "exit code 2");
  CHECK(run->printed("--loss is required"));
}
