// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coordinator/ledger.hpp"
#include "idl/negotiation.h"

namespace sidestep {

/// A page holds the versions of so many robots at most.
inline constexpr std::size_t kRobotsPerPage = 32;

/// The ledger in pages, each of robots that are near to each other (sort-tile-recursive packing; Leutenegger,
/// Lopez, Edgington 1997), so that agents need to look at few of them. Heads are the sender's.
std::vector<msg::LedgerPage> ledger_pages(const Ledger& ledger, Epoch epoch);

}  // namespace sidestep
