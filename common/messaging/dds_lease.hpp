// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

namespace sidestep {

/// A participant that nothing is heard of for so long is taken for dead.
inline constexpr Duration kLease{4'000'000'000};

/// Whether Fast DDS calls our check of remote participants' leases (dds_lease.cpp) and not its own, which may
/// end the process when a participant leaves: so it is unless the library was linked to call nothing but
/// itself.
bool is_lease_check_ours();

}  // namespace sidestep
