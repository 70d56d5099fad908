// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include "agents/tactics/referee_node.hpp"
#include "common/league/multicast.hpp"
#include "common/log/log.hpp"
#include "common/process/command_line.hpp"
#include "common/process/process.hpp"

namespace sidestep {
namespace {

struct RefereeOptions {
  std::string endpoint = league::kRefereeEndpoint;
  std::string interface = league::kLeagueInterface;
  RefereeSettings settings;
};

/// Passes the packets of the referee's multicast group to a node.
struct RefereeService {
  RefereeService(DdsBus& bus, const Scenario& scenario, const RefereeOptions& options)
      : receiver(league::parse_multicast_endpoint(options.endpoint), options.interface),
        node(bus, scenario, options.settings) {
    bus.watch(receiver.descriptor(), [this] {
      receiver.receive([this](std::span<const std::byte> datagram, const league::Endpoint& from) {
        node.on_datagram(datagram, from);
      });
    });
    log_events_of(node);
    log(LogLevel::kInfo, fmt::format("receiving the referee's packets from {} on interface {}",
                                     options.endpoint, options.interface));
  }

  league::MulticastReceiver receiver;
  RefereeNode node;
};

int run(int argc, char** argv) {
  RefereeOptions options;
  std::string team;
  Program program;
  program.name = "sidestep-referee";
  program.description = "Makes all robots obey the Small Size League's referee.";
  program.add_options = [&](const CliCommand& app) {
    app.add_option("--referee", options.endpoint, "ADDRESS:PORT of the referee's packets").show_default();
    app.add_option("--league-interface", options.interface,
                   "address of the network interface that receives these packets")
        .show_default();
    app.add_option("--team", team, "the team whose robots obey, if the run has only one team")
        .check(one_of({"blue", "yellow"}));
    app.add_flag("--defence-areas", options.settings.closes_defence_areas,
                 "keep all robots, including goalkeepers, out of both defence areas");
    app.on_parsed([&] {
      if (!team.empty()) options.settings.team = team == "blue" ? Team::kBlue : Team::kYellow;
    });
  };
  program.process = [] { return static_cast<std::uint32_t>(Sender::kReferee); };
  program.start = [&](DdsBus& bus, const Scenario& scenario, Incarnation) -> RunningNodes {
    return {std::make_shared<RefereeService>(bus, scenario, options), {}};
  };
  return run_process(argc, argv, program);
}

}  // namespace
}  // namespace sidestep

int main(int argc, char** argv) { return sidestep::run(argc, argv); }
