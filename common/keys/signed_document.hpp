// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "common/keys/certificate.hpp"

namespace sidestep {

/// The text of a DDS Security document that was signed by an authority (S/MIME, DDS Security 1.1, 9.4.1).
/// Throws std::invalid_argument that names the file and the problem.
[[nodiscard]] std::string load_signed_document(const std::string& path, const Certificate& authority);

/// The period in which a subject's permissions are valid on this host, according to a permissions document.
/// nullopt if the document has no permissions for this subject, or its times cannot be parsed.
[[nodiscard]] std::optional<ValidityPeriod> permissions_validity(const std::string& permissions,
                                                                 const std::string& subject);

/// Whether a governance or permissions document names the domain, alone or in a range (DDS Security 1.1,
/// 9.4.1.2.4). As for Fast DDS, a range without a minimum begins at 0, and one without a maximum is its
/// minimum alone.
[[nodiscard]] bool covers_domain(const std::string& document, int domain);

}  // namespace sidestep
