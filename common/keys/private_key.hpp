// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct evp_pkey_st;

namespace sidestep {

using PrivateKey = std::shared_ptr<evp_pkey_st>;

/// Reads a PEM file. Throws std::invalid_argument that names the file and the problem.
[[nodiscard]] PrivateKey load_private_key(const std::string& path);

/// Signs the SHA-256 hash of the bytes; Certificate::has_signed() checks the signature. Throws
/// std::runtime_error if OpenSSL fails.
[[nodiscard]] std::vector<std::uint8_t> sign(const PrivateKey& key, std::span<const std::uint8_t> bytes);

}  // namespace sidestep
