// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/messaging/dds/bus.hpp"
#include "deploy/view/server/access.hpp"

namespace sidestep {

struct MonitorOptions {
  std::string file;            ///< a scenario or a recording; empty: the scenario is unknown
  std::string recording_file;  ///< file to write; empty: none
  AccessSettings access;
  std::uint32_t port = 8080;
  bool has_control = false;
  bool is_of_run = false;  ///< `sidestep run` has started the monitor; see LauncherInput
  DdsSettings dds;

  bool shows_recording() const { return file.ends_with(".mcap"); }
};

}  // namespace sidestep
