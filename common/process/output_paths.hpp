// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace sidestep {

/// A file that a command reads or writes.
struct NamedPath {
  std::string name;  ///< the option or argument that names it, e.g. "--report"
  std::string path;  ///< empty: none
};

/// Throws UsageError if an output is the same file as an input or an earlier output, which it would
/// overwrite. Devices such as /dev/null may be named more than once.
void require_separate_outputs(const std::vector<NamedPath>& inputs, const std::vector<NamedPath>& outputs);

/// Throws UsageError if the output is a file with contents, unless `may_overwrite`, which --force sets.
void require_new_output(const NamedPath& output, bool may_overwrite);

}  // namespace sidestep
