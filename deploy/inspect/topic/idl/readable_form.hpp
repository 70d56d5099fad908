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

/// Converts a decoded value to a readable one.
using Rewrite = nlohmann::ordered_json (*)(const nlohmann::ordered_json& value);

/// Rewrites for values whose meaning the IDL does not state, indexed by the name of a struct, such as
/// "sidestep::msg::Header", or of a struct's member, such as "sidestep::msg::Header.rules".
using Rewrites = std::map<std::string, Rewrite>;

/// Converts messages of one type to a readable form. Enumerators become words: the lower-case name without
/// the prefix that all enumerators of the enum share; an unknown value becomes, for example, "unknown 7". An
/// array `things` beside a member `thing_count` is cut to that count. Other values remain as decoded.
class ReadableForm {
 public:
  ReadableForm(const IdlType& type, const Rewrites& rewrites);

  /// Converts a message. Precondition: decode_by_idl() returned it for this type, with OctetSequences::kText.
  void apply(nlohmann::ordered_json& message) const;

  /// Whether apply() changes nothing.
  bool is_exact() const { return change_ == Change::kNone; }

 private:
  enum class Change : std::uint8_t { kNone, kRewrite, kWord, kElements, kMembers };
  struct Member;

  void add_members(const IdlType& type, const Rewrites& rewrites);

  Change change_ = Change::kNone;
  Rewrite rewrite_ = nullptr;
  std::size_t prefix_size_ = 0;        ///< length of the prefix that an enum's names share
  std::vector<ReadableForm> element_;  ///< one element if the change is kElements
  std::vector<Member> members_;        ///< members that change
};

/// A member that changes. If `count_name` is not empty, the array is first cut to the value of that member.
/// Then `form` is applied.
struct ReadableForm::Member {
  std::string name, count_name;
  ReadableForm form;
};

}  // namespace sidestep
