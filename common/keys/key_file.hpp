// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

struct bio_st;

namespace sidestep {

/// The content of a key file, for OpenSSL. Throws std::invalid_argument that names the file and the problem:
/// this user may not read it, it is not a regular file, or it is too large. A pipe is refused because it
/// would block a process that reloads a list of revoked keys.
[[nodiscard]] std::shared_ptr<bio_st> open_key_file(const std::string& path);

}  // namespace sidestep
