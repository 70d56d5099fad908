// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/time/time.hpp"

namespace sidestep {

/// Throws std::runtime_error where Fast DDS does not have what is replaced in dds_lease.cpp: before there is
/// a participant, whose threads could tell nobody.
void check_library();

/// A participant that nothing is heard of for so long is taken for dead.
Duration participant_lease();

/// How often this process has checked a lease in the place of Fast DDS (see dds_lease.cpp): for tests.
std::uint64_t lease_checks();

}  // namespace sidestep
