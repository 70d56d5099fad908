// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/page_screens.hpp"

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"

namespace sidestep {

void open_on(Browser& page, const PageScreen& screen, const std::string& url) {
  page.open("about:blank");
  page.resize(screen.width_px, screen.height_px);
  page.prefer(screen.theme);
  page.open(url);
  page.load_script(SIDESTEP_SOURCE_DIR "/tests/faults/page_checks.js");
  REQUIRE(page.run("return innerWidth") == screen.width_px);
}

std::string found_by(Browser& page, const std::string& call) {
  std::string all;
  for (const nlohmann::json& problem : page.run("return pageChecks." + call))
    all += problem.get<std::string>() + "\n";
  return all;
}

void keep_screenshot(Browser& page, const std::string& name) {
  const char* folder = std::getenv("SIDESTEP_SCREENSHOTS");
  if (folder) page.save_screenshot(fmt::format("{}/{}.png", folder, name));
}

void check_controls_and_texts(Browser& page, const PageScreen& screen, const std::string& state) {
  INFO(screen.name(state));
  CHECK(found_by(page, "hiddenControls()") == "");
  CHECK(found_by(page, "faintTexts()") == "");
  keep_screenshot(page, screen.name(state));
}

}  // namespace sidestep
