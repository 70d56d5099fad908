// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

struct bio_st;

namespace sidestep {

/// The content of a file of keys, as OpenSSL reads it. Throws std::invalid_argument with the file and what is
/// wrong: this user may not read it, it is not a regular file, or it is too large. A pipe would block a
/// process that reloads a list of revoked keys.
[[nodiscard]] std::shared_ptr<bio_st> open_key_file(const std::string& path);

}  // namespace sidestep
