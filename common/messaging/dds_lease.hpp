// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// Whether Fast DDS calls our check of remote participants' leases (dds_lease.cpp) and not its own, which may
/// end the process when a participant leaves: so it is unless the library was linked to call nothing but
/// itself.
bool is_lease_check_ours();

}  // namespace sidestep
