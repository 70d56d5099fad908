// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "deploy/inspect/topic/idl/idl_type.hpp"

namespace sidestep {

/// Returns what people read instead of a decoded value.
using Rewrite = nlohmann::ordered_json (*)(const nlohmann::ordered_json& value);

/// Rewrites of values whose meaning does not follow from the IDL, indexed by a struct,
/// "sidestep::msg::Header", or by one of its members, "sidestep::msg::Header.rules".
using Rewrites = std::map<std::string, Rewrite>;

/// What people read of the messages of a type. Enumerators become words: the lower-case name without the
/// prefix that all enumerators of the enum share, unknown ones "unknown 7". An array `things` beside a member
/// `thing_count` is cut to that count. Other values remain as decoded.
class ReadableForm {
 public:
  ReadableForm(const IdlType& type, const Rewrites& rewrites);

  /// Precondition: decode_by_idl() returned the message for the type, with OctetSequences::kText.
  void apply(nlohmann::ordered_json& message) const;

  /// Whether apply() changes nothing.
  bool is_exact() const { return change_ == Change::kNone; }

 private:
  enum class Change : std::uint8_t { kNone, kRewrite, kWord, kElements, kMembers };
  struct Member;

  void add_members(const IdlType& type, const Rewrites& rewrites);

  Change change_ = Change::kNone;
  Rewrite rewrite_ = nullptr;
  std::size_t prefix_size_ = 0;        ///< of an enum's names
  std::vector<ReadableForm> element_;  ///< one element if the change is kElements
  std::vector<Member> members_;        ///< members that change
};

/// A member that changes: it is cut to the value of another member, unless that has no name, and then
/// changed.
struct ReadableForm::Member {
  std::string name, count_name;
  ReadableForm form;
};

}  // namespace sidestep
