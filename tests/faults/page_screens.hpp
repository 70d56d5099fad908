// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <string>

#include "tests/faults/browser.hpp"

namespace sidestep {

/// A screen on which a person may open a page: a desk's, a small one or a phone's, in one of the themes.
struct PageScreen {
  const char* theme;
  int width_px, height_px;

  bool is_phone() const { return width_px == 400; }
  std::string name(const std::string& state) const { return fmt::format("{}-{}-{}", state, width_px, theme); }
};

constexpr PageScreen kPageScreens[] = {{"dark", 1500, 900},  {"dark", 1000, 700},  {"dark", 400, 800},
                                       {"light", 1500, 900}, {"light", 1000, 700}, {"light", 400, 800}};

/// Opens a page on the screen, with what page_checks.js defines.
void open_on(Browser& page, const PageScreen& screen, const std::string& url);

/// Lists the problems that a function of page_checks.js finds; empty if there are none.
std::string found_by(Browser& page, const std::string& call);

/// Saves a picture of the page if the environment names a folder for it (SIDESTEP_SCREENSHOTS).
void keep_screenshot(Browser& page, const std::string& name);

/// Fails the test if a control is hidden or a text is faint. Keeps a screenshot.
void check_controls_and_texts(Browser& page, const PageScreen& screen, const std::string& state);

}  // namespace sidestep
