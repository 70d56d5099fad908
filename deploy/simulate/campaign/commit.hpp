// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// The commit that this was built from, "-changed" behind it where files were changed since; "unknown" where
/// there is no git.
extern const char* const kCommit;

}  // namespace sidestep
