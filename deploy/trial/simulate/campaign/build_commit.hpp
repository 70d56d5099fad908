// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// The commit that this program was built from, with the suffix "-changed" if files were modified; "unknown"
/// without git.
extern const char* const kBuildCommit;

}  // namespace sidestep
