// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/time/time.hpp"

namespace sidestep {

/// Throws std::runtime_error if Fast DDS lacks a function that lease.cpp replaces. Call it before a
/// participant exists, because its threads could not report the error.
void check_fast_dds_version();

/// A participant that has been silent for this long is considered dead.
Duration participant_lease();

/// How often this process has run its own lease check (see lease.cpp) instead of Fast DDS's; for tests.
std::uint64_t lease_check_count();

}  // namespace sidestep
