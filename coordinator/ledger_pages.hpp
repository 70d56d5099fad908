// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coordinator/ledger.hpp"
#include "idl/negotiation.hpp"

namespace sidestep {

/// Maximum number of robots on a page.
inline constexpr std::size_t kRobotsPerPage = 32;

/// The ledger, divided into pages of nearby robots (sort-tile-recursive packing; Leutenegger, Lopez,
/// Edgington 1997), so that an agent needs only a few of them. The caller fills in the headers.
std::vector<msg::LedgerPage> ledger_pages(const Ledger& ledger, Epoch epoch);

}  // namespace sidestep
