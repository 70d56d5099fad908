// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "idl/negotiation.hpp"

namespace sidestep {

/// Descriptions of the reasons of verdicts, indexed by msg::Reason.
inline constexpr const char* kReasonTexts[] = {"granted",       "not evaluated",      "malformed",
                                               "wrong epoch",   "not all registered", "old incarnation",
                                               "old version",   "base unknown",       "not continuous",
                                               "beyond limits", "not at rest",        "outside field",
                                               "obstacle",      "conflict",           "ledger full",
                                               "absent",        "quarantined",        "displaced",
                                               "held"};

/// Precondition: the reason is a valid enumerator.
constexpr const char* to_text(msg::Reason reason) { return kReasonTexts[static_cast<std::size_t>(reason)]; }

}  // namespace sidestep
