// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/idl/readable_form.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "common/json/json_text.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;
using Kind = IdlType::Kind;

/// The size of the prefix, up to an underscore, that all names of an enum share.
std::size_t shared_prefix_size(const IdlType& type) {
  if (type.enumerators.empty()) return 0;
  std::string_view prefix = type.enumerators.begin()->second;
  for (const auto& [value, name] : type.enumerators)
    prefix =
        prefix.substr(0, static_cast<std::size_t>(std::ranges::mismatch(prefix, name).in1 - prefix.begin()));
  return prefix.rfind('_') + 1;  // 0 if there is no underscore
}

std::string word_of(std::string_view enumerator) {
  std::string word(enumerator);
  for (char& c : word) c = c == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return word;
}

bool is_count(const IdlType& type) {
  return type.kind == Kind::kOctet || type.kind == Kind::kUint16 || type.kind == Kind::kUint32;
}

/// The name of the member that counts the used elements of an array; empty if there is none.
std::string count_name(const IdlType& type, const IdlMember& array) {
  if (array.type->kind != Kind::kArray || !array.name.ends_with('s')) return {};
  const std::string name = array.name.substr(0, array.name.size() - 1) + "_count";
  const auto found = std::ranges::find(type.members, name, &IdlMember::name);
  return found != type.members.end() && is_count(*found->type) ? name : std::string();
}

void cut(Json& array, const Json& count) {
  const auto size = std::min<std::size_t>(count.get<std::size_t>(), array.size());
  array.erase(array.begin() + static_cast<std::ptrdiff_t>(size), array.end());
}

}  // namespace

ReadableForm::ReadableForm(const IdlType& type, const Rewrites& rewrites) {
  switch (type.kind) {
    case Kind::kEnum:
      change_ = Change::kWord;
      prefix_size_ = shared_prefix_size(type);
      break;
    case Kind::kSequence:
    case Kind::kArray:
      element_.emplace_back(*type.element, rewrites);
      if (!element_.front().is_exact()) change_ = Change::kElements;
      break;
    case Kind::kStruct:
      add_members(type, rewrites);
      break;
    default:
      break;
  }
}

void ReadableForm::add_members(const IdlType& type, const Rewrites& rewrites) {
  if (const auto found = rewrites.find(type.name); found != rewrites.end()) {
    change_ = Change::kRewrite;
    rewrite_ = found->second;
    return;
  }
  for (const IdlMember& member : type.members) {
    Member changed{member.name, count_name(type, member), ReadableForm(*member.type, rewrites)};
    if (const auto found = rewrites.find(type.name + '.' + member.name); found != rewrites.end()) {
      changed.form.change_ = Change::kRewrite;
      changed.form.rewrite_ = found->second;
    }
    if (!changed.form.is_exact() || !changed.count_name.empty()) members_.push_back(std::move(changed));
  }
  if (!members_.empty()) change_ = Change::kMembers;
}

void ReadableForm::apply(Json& message) const {
  switch (change_) {
    case Change::kNone:
      return;
    case Change::kRewrite:
      message = rewrite_(message);
      return;
    case Change::kWord:
      message = message.is_string()
                    ? word_of(std::string_view(message.get_ref<const std::string&>()).substr(prefix_size_))
                    : "unknown " + json_text(message);
      return;
    case Change::kElements:
      for (Json& element : message) element_.front().apply(element);
      return;
    case Change::kMembers:
      for (const Member& member : members_) {
        Json& value = message[member.name];
        if (!member.count_name.empty()) cut(value, message[member.count_name]);
        member.form.apply(value);
      }
      return;
  }
}

}  // namespace sidestep
