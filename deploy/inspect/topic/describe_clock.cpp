// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/describe.hpp"
#include "deploy/inspect/topic/describe_parts.hpp"

namespace sidestep {

using namespace description;

Json describe(const msg::ClockProbe& m) { return {{"client", m.client()}, {"header", header(m.header())}}; }

Json describe(const msg::ClockReading& m) {
  return {{"process", m.process()},
          {"header", header(m.header())},
          {"client", m.client()},
          {"probe_sent_ns", m.probe_sent_ns()},
          {"probe_received_ns", m.probe_received_ns()},
          {"host_ahead_ns", m.host_ahead_ns()},
          {"clock_bound_s", m.clock_bound_s()},
          {"place", std::string(m.place().begin(), m.place().end())}};
}

}  // namespace sidestep
