// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/keys/identity.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// The governance document: which protection applies to the messages of all participants (DDS Security 1.1,
/// 9.4.1.2). Datagrams as a whole are not protected, because Fast DDS 2.9.1 then aborts on large best-effort
/// messages, and 3.1.2 loses them.
[[nodiscard]] std::string governance_text();

/// The permissions document: what an identity may write and read, derived from the topic table (DDS Security
/// 1.1, 9.4.1.3). `subject` is the subject of the identity's certificate, in RFC 2253 order.
[[nodiscard]] std::string permissions_text(const Identity& identity, const std::string& subject, Time from,
                                           Time until);

}  // namespace sidestep
