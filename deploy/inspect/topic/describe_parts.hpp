// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string>

#include "idl/header.hpp"

/// Parts that the descriptions of messages share.
namespace sidestep::description {

using Json = nlohmann::ordered_json;

/// The enumerator's name. The network may deliver any number.
template <typename Enum, std::size_t kCount>
Json word(Enum value, const char* const (&words)[kCount]) {
  const auto number = static_cast<std::uint32_t>(value);
  return number < kCount ? Json(words[number]) : Json("unknown " + std::to_string(number));
}

template <typename Range, typename Describe>
Json list(const Range& range, std::size_t count, Describe describe_one) {
  Json result = Json::array();
  for (std::size_t i = 0; i < std::min<std::size_t>(count, range.size()); ++i)
    result.push_back(describe_one(range[i]));
  return result;
}

template <typename Range, typename Describe>
Json list(const Range& range, Describe describe_one) {
  return list(range, range.size(), describe_one);
}

inline Json header(const msg::Header& m) {
  return {{"sender", m.sender()},
          {"incarnation", m.incarnation()},
          {"rules", fmt::format("{:016x}", m.rules())},
          {"message_number", m.message_number()},
          {"stamp_ns", m.stamp_ns()}};
}

}  // namespace sidestep::description
