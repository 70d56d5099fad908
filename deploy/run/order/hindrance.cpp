// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/order/hindrance.hpp"

#include <fmt/format.h>

namespace sidestep {
namespace {

std::string joined(const std::vector<Hindrance>& hindrances, bool has_durations) {
  std::string text;
  for (const Hindrance& hindrance : hindrances) {
    text += (text.empty() ? "" : "; ") + hindrance.text;
    if (has_durations && hindrance.silence)
      text += fmt::format(" for {:.0f} s", to_seconds(*hindrance.silence));
  }
  return text;
}

}  // namespace

std::string to_text(const std::vector<Hindrance>& hindrances) { return joined(hindrances, true); }

std::string lasting_text(const std::vector<Hindrance>& hindrances) { return joined(hindrances, false); }

}  // namespace sidestep
