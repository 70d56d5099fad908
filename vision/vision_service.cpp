// SPDX-License-Identifier: Apache-2.0
#include "vision/vision_service.hpp"

#include <fmt/format.h>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/process/command_line.hpp"
#include "common/process/process.hpp"

namespace sidestep {
namespace {

FrameSource source_of(const Scenario& scenario, const VisionOptions& options) {
  const bool uses_bus = !options.is_league_source && !scenario.vision.images;
  return uses_bus ? FrameSource::kBus : FrameSource::kCaller;
}

std::vector<std::uint32_t> configured_cameras(const Scenario& scenario, const VisionOptions& options) {
  const bool are_given = options.is_league_source && !options.league_cameras.empty();
  return are_given ? options.league_cameras : cameras_of(scenario.vision);
}

/// Throws std::invalid_argument if an option names a file that only image processing uses. Called if no
/// images arrive, because the user would believe that the file is used.
void require_none(const ImageOptions& options) {
  const std::pair<const char*, const std::string&> files[] = {{"--colours", options.colours_file},
                                                              {"--cameras", options.cameras_file},
                                                              {"--layout", options.layout_file}};
  for (const auto& [name, file] : files)
    if (!file.empty())
      throw std::invalid_argument(fmt::format(
          "{} {}: no images arrive, expected a scenario with the key vision.images and not --source ssl",
          name, file));
}

std::vector<std::string> receiving_interfaces(const Scenario& scenario, const VisionOptions& options) {
  if (!options.league_interfaces.empty()) return options.league_interfaces;
  return {scenario.vision.has_league_everywhere ? "all" : league::kLeagueInterface};
}

/// The interface over which packets are sent: loopback, unless the options name one.
std::string sending_interface(const VisionOptions& options) {
  const auto& interfaces = options.league_interfaces;
  return interfaces.empty() || interfaces.front() == "all" ? league::kLeagueInterface : interfaces.front();
}

}  // namespace

void add_league_options(const CliCommand& app, VisionOptions& options) {
  const Option source =
      app.add_option(
             "--source", [&options](const std::string& name) { options.is_league_source = name == "ssl"; },
             "source of detections: the cameras over DDS, or SSL-Vision's multicast")
          .check(one_of({"dds", "ssl"}))
          .show_default("dds");
  app.add_option("--ssl-vision", options.league_vision, "ADDRESS:PORT of the multicast group of SSL-Vision")
      .needs(source)
      .show_default();
  app.add_option("--league-cameras", options.league_cameras,
                 "numbers of SSL-Vision's cameras that together see all of the floor, e.g. 0,1,3; robots "
                 "drive only while all these cameras send frames")
      .comma_separated()
      .check(in_range(0U, league::kMaxCameras - 1))
      .needs(source)
      .show_default("0 .. N-1 for the scenario's N = vision.columns x vision.rows");
  app.add_option("--league-sender", options.league_senders,
                 "ADDRESS or ADDRESS:PORT of the only senders whose vision packets are used, e.g. 10.0.0.7")
      .comma_separated()
      .check([](const std::string& text) {
        try {
          (void)parse_sender(text);
          return std::string();
        } catch (const std::invalid_argument& error) {
          return std::string(error.what());
        }
      })
      .needs(source)
      .show_default("the first that is heard");
  app.add_flag("--other-field", options.may_have_other_field,
               "use vision packets although the sender's field has another size than the scenario's")
      .needs(source);
  app.add_optional_value("--tracked", options.tracked, league::kTrackedEndpoint,
                         "send tracked packets to this ADDRESS:PORT");
  app.add_option(
         "--league-interface", options.league_interfaces,
         "addresses of the network interfaces on which league packets are received, or 'all'; packets "
         "are sent over the first")
      .comma_separated()
      .show_default("the scenario's vision.league_interfaces");
}

VisionService::VisionService(DdsBus& bus, const Scenario& scenario, Incarnation incarnation,
                             const VisionOptions& options)
    : node_(bus, scenario, incarnation, source_of(scenario, options), configured_cameras(scenario, options)) {
  if (options.is_league_source || !scenario.vision.images) require_none(options.images);
  if (options.is_league_source) {
    league_.emplace(bus, scenario,
                    LeagueReception{options.league_vision, receiving_interfaces(scenario, options),
                                    options.league_senders, options.may_have_other_field},
                    node_);
  } else if (scenario.vision.images) {
    images_.emplace(bus, image_reader(scenario, options.images), node_);
  }
  if (!options.tracked) return;
  tracked_.emplace(scenario, incarnation);
  tracked_sender_.emplace(league::parse_multicast_endpoint(*options.tracked), sending_interface(options));
  node_.set_listener([this](const msg::WorldState& world) {
    tracked_sender_->send(league::encode(tracked_->packet_of(world)));
  });
}

}  // namespace sidestep
