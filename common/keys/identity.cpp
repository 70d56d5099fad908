// SPDX-License-Identifier: Apache-2.0
#include "common/keys/identity.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>

#include "common/motion/version.hpp"
#include "common/protocol/client_name.hpp"
#include "common/protocol/senders.hpp"

namespace sidestep {
namespace {

struct RoleWord {
  Role role;
  const char* word;
};
constexpr std::array kWords{RoleWord{Role::kAgent, "agent"},   RoleWord{Role::kCoordinator, "coordinator"},
                            RoleWord{Role::kVision, "vision"}, RoleWord{Role::kSimulator, "simulator"},
                            RoleWord{Role::kRobot, "robot"},   RoleWord{Role::kReferee, "referee"},
                            RoleWord{Role::kClient, "client"}, RoleWord{Role::kOperator, "operator"},
                            RoleWord{Role::kViewer, "viewer"}, RoleWord{Role::kJudge, "judge"}};

const char* word_of(Role role) { return std::ranges::find(kWords, role, &RoleWord::role)->word; }

bool is_numbered(Role role) {
  return role == Role::kAgent || role == Role::kCoordinator || role == Role::kRobot;
}

/// How many numbers a numbered role has.
std::uint32_t count_of(Role role) { return role == Role::kCoordinator ? kMaxCoordinators : kMaxRobots; }

std::optional<std::uint32_t> parse_number(std::string_view digits, std::uint32_t count) {
  std::uint32_t number = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, number);
  // No leading zeros, so that each identity has exactly one text.
  const bool has_leading_zero = digits.size() > 1 && digits.front() == '0';
  if (error != std::errc{} || stop != end || number >= count || has_leading_zero) return std::nullopt;
  return number;
}

/// Parses "3" or, for robots, "0-10".
bool parse_numbers(std::string_view text, Identity& identity) {
  const std::uint32_t count = count_of(identity.role);
  const auto dash = text.find('-');
  if (dash != std::string_view::npos && identity.role != Role::kRobot) return false;
  const auto first = parse_number(text.substr(0, dash), count);
  const auto last = dash == std::string_view::npos ? first : parse_number(text.substr(dash + 1), count);
  if (!first || !last || *last < *first || (dash != std::string_view::npos && *last == *first)) return false;
  identity.first = *first;
  identity.last = *last;
  return true;
}

bool is_client_name(std::string_view text) {
  return !text.empty() && text.size() <= msg::MAX_CLIENT_NAME && text.front() != '-' &&
         std::ranges::all_of(text, is_name_character);
}

}  // namespace

std::optional<Identity> parse_identity(const std::string& text) {
  const auto space = text.find(' ');
  const std::string word = text.substr(0, space);
  const std::string_view rest =
      space == std::string::npos ? std::string_view() : std::string_view(text).substr(space + 1);
  const auto* const found =
      std::ranges::find(kWords, word, [](const RoleWord& w) { return std::string(w.word); });
  if (found == kWords.end()) return std::nullopt;
  Identity identity;
  identity.role = found->role;
  if (text == "coordinator") return identity;
  if (is_numbered(identity.role))
    return parse_numbers(rest, identity) ? std::optional(identity) : std::nullopt;
  if (identity.role != Role::kClient)
    return space == std::string::npos ? std::optional(identity) : std::nullopt;
  if (!is_client_name(rest)) return std::nullopt;
  identity.name = rest;
  return identity;
}

std::string identity_forms() {
  return "'agent 3', 'coordinator 1', vision, simulator, 'robot 3', 'robot 0-10', referee, 'client NAME', "
         "operator, "
         "viewer or judge";
}

std::string expected_identity(const std::string& text) {
  const std::string word = text.substr(0, text.find(' '));
  const auto* const found =
      std::ranges::find(kWords, word, [](const RoleWord& w) { return std::string(w.word); });
  if (found != kWords.end() && found->role == Role::kClient)
    return fmt::format(
        "'client NAME' with a name of 1 to {} letters, digits, '-' and '_' that does not begin with '-'",
        msg::MAX_CLIENT_NAME);
  if (found == kWords.end() || !is_numbered(found->role)) return identity_forms();
  return fmt::format("'{} N' with a number from 0 to {}", word, count_of(found->role) - 1);
}

std::string to_text(const Identity& identity) {
  const std::string word = word_of(identity.role);
  if (identity.role == Role::kClient) return word + " " + identity.name;
  if (!is_numbered(identity.role)) return word;
  return identity.first == identity.last ? fmt::format("{} {}", word, identity.first)
                                         : fmt::format("{} {}-{}", word, identity.first, identity.last);
}

std::string folder_name(const Identity& identity) {
  std::string result = to_text(identity);
  std::ranges::replace(result, ' ', '-');
  return result;
}

bool may_use_sender(const Identity& identity, std::uint32_t sender) {
  const auto is = [sender](Sender process) { return sender == static_cast<std::uint32_t>(process); };
  switch (identity.role) {
    case Role::kAgent:
      return identity.covers(sender);
    case Role::kCoordinator:
      return is_coordinator(sender) &&
             sender - static_cast<std::uint32_t>(Sender::kCoordinator) == identity.first;
    case Role::kVision:
      return is(Sender::kVision);
    case Role::kSimulator:
      // Robots send with their agents' numbers.
      return is(Sender::kSimulator) || sender < kMaxRobots;
    case Role::kRobot:
      return is(Sender::kRobots) || identity.covers(sender);
    case Role::kReferee:
      return is(Sender::kReferee);
    case Role::kClient:
      return sender == client_id(identity.name);
    case Role::kOperator:
      // An operator's orders take precedence over those of all clients, so it may also send theirs.
      return is(Sender::kOperator) || sender >= static_cast<std::uint32_t>(Sender::kClient);
    case Role::kViewer:
    case Role::kJudge:
      return false;
  }
  return false;
}

}  // namespace sidestep
