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

/// Reads a PEM file. Throws std::invalid_argument with the file and what is wrong.
[[nodiscard]] PrivateKey load_private_key(const std::string& path);

/// The signature of the bytes' SHA-256; Certificate::has_signed() checks it. Throws std::runtime_error if
/// OpenSSL fails.
[[nodiscard]] std::vector<std::uint8_t> sign(const PrivateKey& key, std::span<const std::uint8_t> bytes);

}  // namespace sidestep
