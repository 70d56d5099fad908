// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

namespace sidestep {

/// The text of deploy/scenarios/README.md.
extern const char* const kKeysPage;

/// What the tables of a page say about keys: the meaning of each key, with its unit, default and range. A
/// heading that is code, such as `vision.images`, stands before the keys of its table. Formatting and links
/// are removed.
[[nodiscard]] std::map<std::string, std::string> key_descriptions(const std::string& markdown);

}  // namespace sidestep
