// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/time/time.hpp"

namespace sidestep {

/// A participant that nothing is heard of for so long is taken for dead. Throws std::runtime_error where the
/// library is none whose dealing with that can be replaced (see dds_lease.cpp).
Duration participant_lease();

/// How often this process has checked a lease in the place of Fast DDS (see dds_lease.cpp): for tests.
std::uint64_t lease_checks();

}  // namespace sidestep
