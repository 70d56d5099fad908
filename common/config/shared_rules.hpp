// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/config/scenario.hpp"

namespace sidestep {

/// A rule whose value differs between two processes.
struct RuleDifference {
  std::string key;     ///< key in the scenario file, for example limits.speed_mps
  std::string own;     ///< empty: this process does not know the key
  std::string others;  ///< empty: the other process does not know the key
};

/// The rules on which all processes that share a floor must agree: the roster, and the rules that the
/// protocol's safety relies on. Stored as one line "key: value" per rule; values never contain a line break.
class SharedRules {
 public:
  /// Identifies a set of rules in message headers. Never 0.
  using Fingerprint = std::uint64_t;

  explicit SharedRules(const FloorSpec& floor);
  /// Decodes another process's text(). The text may be hostile; nullopt if it is malformed.
  [[nodiscard]] static std::optional<SharedRules> parse(std::string_view text);

  const std::string& text() const { return text_; }
  Fingerprint fingerprint() const { return fingerprint_; }
  /// The rules that differ, in the order of this process's text().
  std::vector<RuleDifference> differences(const SharedRules& others) const;

 private:
  struct Rule {
    std::string key, value;
  };
  SharedRules() = default;
  const Rule* find(const std::string& key) const;
  void finish();

  std::vector<Rule> rules_;
  std::string text_;
  Fingerprint fingerprint_ = 0;
};

/// One line that names the differing rules, e.g. "margin_m is 0.02 instead of 0.01".
std::string describe(const std::vector<RuleDifference>& differences);

}  // namespace sidestep
