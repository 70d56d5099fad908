// SPDX-License-Identifier: Apache-2.0
#include "common/file/similar_name.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sidestep {
namespace {

constexpr std::size_t kMaxNames = 3, kMaxLength = 40;

std::string in_lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// The number of letters that are wrong, missing, surplus, or swapped with the next one (optimal string
/// alignment).
std::size_t typing_errors(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> errors(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) errors[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) errors[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      errors[i][j] = std::min({errors[i - 1][j] + 1, errors[i][j - 1] + 1,
                               errors[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        errors[i][j] = std::min(errors[i][j], errors[i - 2][j - 2] + 1);
    }
  }
  return errors[a.size()][b.size()];
}

}  // namespace

std::vector<std::string> similar_names(std::string_view text, std::span<const std::string> names) {
  std::vector<std::string> best;
  if (text.size() < 2 || text.size() > kMaxLength) return best;
  const std::string typed = in_lower_case(text);
  std::size_t fewest = (text.size() + 1) / 3 + 1;
  for (const std::string& name : names) {
    const std::string other = in_lower_case(name);
    const std::size_t errors = other.starts_with(typed) ? 0 : typing_errors(typed, other);
    if (errors > fewest || (best.empty() && errors == fewest)) continue;
    if (errors < fewest) best.clear();
    fewest = errors;
    if (best.size() < kMaxNames) best.push_back(name);
  }
  return best;
}

std::string did_you_mean(std::string_view text, std::span<const std::string> names) {
  const std::vector<std::string> similar = similar_names(text, names);
  return similar.empty() ? "" : fmt::format("; did you mean {}?", fmt::join(similar, " or "));
}

}  // namespace sidestep
