// SPDX-License-Identifier: Apache-2.0
#include "common/process/output_reader.hpp"

#include "common/file/console.hpp"

namespace sidestep {

void stop_without_reader(DdsBus& bus) {
  call_periodically(bus, kReaderPeriod, [&bus] {
    if (is_output_abandoned()) bus.stop();
  });
}

}  // namespace sidestep
