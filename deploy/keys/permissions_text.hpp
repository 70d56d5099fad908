// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/keys/identity.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// What protects the messages of all participants (DDS Security 1.1, 9.4.1.2). Datagrams as a whole are not
/// protected: Fast DDS 2.9.1 aborts at large best-effort messages then, and 3.1.2 loses them.
[[nodiscard]] std::string governance_text();

/// What an identity may write and read, from the topic table (DDS Security 1.1, 9.4.1.3). `subject`: of its
/// certificate, in RFC 2253 order.
[[nodiscard]] std::string permissions_text(const Identity& identity, const std::string& subject, Time from,
                                           Time until);

}  // namespace sidestep
