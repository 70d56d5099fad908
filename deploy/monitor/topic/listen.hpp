// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/messaging/dds/dds_bus.hpp"

namespace sidestep {

struct ListenOptions {
  DdsSettings dds;
  std::string topic;        ///< the name on the wire, e.g. feedback/3
  double seconds = 0;       ///< 0: until Ctrl-C
  std::uint64_t count = 0;  ///< 0: until Ctrl-C
};

/// The three tools; each prints on stdout, ends on SIGINT and SIGTERM and returns the exit code. They throw
/// std::runtime_error as DdsBus does.
int list_topics(const ListenOptions& options);
int measure_rate(const ListenOptions& options);
int echo_topic(const ListenOptions& options);

}  // namespace sidestep
