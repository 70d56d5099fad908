// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/log/log_level.hpp"
#include "deploy/trial/test/judgement/test_result.hpp"

namespace sidestep {

/// Runs a test on SimBus, in virtual time. The same seed gives the same outcome. The simulated processes log
/// to stderr at `log_level`.
[[nodiscard]] RunOutcome run_on_sim_bus(const FaultTest& test, std::uint64_t seed,
                                        LogLevel log_level = LogLevel::kOff);

}  // namespace sidestep
