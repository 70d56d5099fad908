// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"

namespace sidestep {

/// Fails the test unless an independently decoded message equals the output of describe(), which has words
/// for enumerators, omits the unused elements of arrays, and replaces histograms by quantiles.
inline void require_same_fields(const nlohmann::ordered_json& described,
                                const nlohmann::ordered_json& decoded) {
  if (described.is_object() && !described.contains("p50_us")) {
    for (const auto& [name, member] : described.items()) {
      CAPTURE(name);
      REQUIRE(decoded.contains(name));
      require_same_fields(member, decoded[name]);
      if (name == "rules") REQUIRE(member == fmt::format("{:016x}", decoded[name].get<std::uint64_t>()));
    }
  } else if (described.is_array()) {
    REQUIRE(described.size() <= decoded.size());
    for (std::size_t i = 0; i < described.size(); ++i) require_same_fields(described[i], decoded[i]);
  } else if (described.is_number() || described.is_boolean()) {
    REQUIRE(described == decoded);
  }
}

}  // namespace sidestep
