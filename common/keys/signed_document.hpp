// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "common/keys/certificate.hpp"

namespace sidestep {

/// The text of a document of DDS Security that an authority has signed (S/MIME, DDS Security 1.1, 9.4.1).
/// Throws std::invalid_argument with the file and what is wrong.
[[nodiscard]] std::string load_signed_document(const std::string& path, const Certificate& authority);

/// How long the permissions of a subject are valid on this host, by a permissions document; nullopt if it has
/// none for this subject, or no times that can be read.
[[nodiscard]] std::optional<Validity> permissions_validity(const std::string& permissions,
                                                           const std::string& subject);

}  // namespace sidestep
