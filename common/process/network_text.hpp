// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <string>

#include "common/messaging/dds/bus.hpp"

namespace sidestep {

/// Where a command listens, for errors that say that it hears nobody.
[[nodiscard]] inline std::string network_text(const DdsSettings& dds) {
  return fmt::format("in domain {} on interface {} (--domain and --interface choose others)", dds.domain,
                     dds.interface);
}

}  // namespace sidestep
