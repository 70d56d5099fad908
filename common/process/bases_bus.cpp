// SPDX-License-Identifier: Apache-2.0
#include "common/process/bases_bus.hpp"

#include <fmt/core.h>
#include <stdexcept>

#include "common/log/log.hpp"

namespace sidestep {

void add_bases_bus_options(const CliCommand& app, const std::string& condition, BasesBusOptions& options) {
  app.add_option("--topic-prefix", options.topic_prefix,
                 condition + ": text before the robot's number in rt/robot3/cmd_vel and rt/robot3/odom")
      .show_default();
  app.add_option("--base-domain", options.domain,
                 condition +
                     ": DDS domain of these topics, on this machine and without keys "
                     "[--domain, --interface]")
      .check(in_range(0, kMaxDomain));
}

std::shared_ptr<Bus> bases_bus(DdsBus& bus, const BasesBusOptions& options) {
  if (!options.domain) {
    if (bus.has_keys())
      throw std::invalid_argument(
          "bases have no keys, so their topics need a separate DDS domain; expected --base-domain");
    return {std::shared_ptr<void>(), &bus};
  }
  log(LogLevel::kInfo,
      fmt::format("the bases' topics are in DDS domain {} of this machine, without keys", *options.domain));
  return bus.local_bus(*options.domain);
}

}  // namespace sidestep
