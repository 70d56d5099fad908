// SPDX-License-Identifier: Apache-2.0
// The picture and the page of a run of real processes, in a real browser.
#include "deploy/audit/page/report_page.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/file/temporary_folder.hpp"
#include "common/file/write_file.hpp"
#include "common/json/json_text.hpp"
#include "tests/catch.hpp"
#include "tests/faults/browser.hpp"
#include "tests/faults/launched_run.hpp"
#include "tests/faults/page_screens.hpp"
#include "tests/text_of.hpp"

namespace sidestep::report_page_test {

/// Whether the document plays: the time of the picture that this expression selects goes on.
bool plays(Browser& browser, const std::string& picture) {
  const double before = browser.run("return " + picture + ".getCurrentTime()");
  return browser.wait_until(fmt::format("{}.getCurrentTime() > {}", picture, before));
}

/// Where robot 0 is on the screen.
std::pair<double, double> robot_at(Browser& browser) {
  const nlohmann::json at = browser.run(
      "const g = [...document.querySelectorAll('g')].find(g => g.querySelector(':scope > "
      "title')?.textContent "
      "=== 'robot 0'); const box = g.getBoundingClientRect(); return [box.x, box.y]");
  return {at[0], at[1]};
}

TEST_CASE("a run draws a picture that plays, and its report becomes a page that plays and seeks") {
  const TemporaryFolder folder;
  const std::string picture_file = folder.file("paths.svg"), page_file = folder.file("report.html");
  LaunchedRun run(shipped_scenario("crossing"), {"--svg", picture_file});
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  REQUIRE(ended == "exit code 0");
  CHECK_THAT(text_of(picture_file), ContainsSubstring("passed: 8 of 8 robots arrived"));
  const auto report = parse_ordered_json(json_text(run.report()));
  REQUIRE(report["paths"].size() == 8);
  for (const auto& [robot, path] : report["paths"].items()) CHECK(path.size() > 3);
  write_file(page_file, report_page(report));

  Browser browser;
  browser.open("file://" + picture_file);
  CHECK(plays(browser, "document.documentElement"));

  for (const PageScreen& screen : kPageScreens) {
    INFO(screen.name("report"));
    open_on(browser, screen, "file://" + page_file);
    const std::string ground = screen.theme == std::string("dark") ? "rgb(20, 24, 29)" : "rgb(244, 245, 247)";
    CHECK(browser.run("return getComputedStyle(document.body).backgroundColor") == ground);
    CHECK(browser.run("return document.getElementById('player').hidden") == false);
    CHECK(plays(browser, "document.querySelector('.floor svg')"));
    // The time of an event seeks to it: at the first grant the robot is at its start, and then it has driven.
    browser.run("document.querySelector('button[data-at=\"0.000\"]').click()");
    const auto start = robot_at(browser);
    check_controls_and_texts(browser, screen, "report-start");
    browser.run(
        "const s = document.querySelector('#player input'); s.value = s.max; s.dispatchEvent(new "
        "Event('input')); document.querySelector('.floor').scrollLeft = 0; scrollTo(0, 0)");
    const auto end = robot_at(browser);
    CHECK(std::abs(end.first - start.first) > 50);
    CHECK(browser.run("return document.querySelector('#player button').textContent") == "Play");
    check_controls_and_texts(browser, screen, "report-end");
    browser.run("document.querySelector('#player button').click()");
    CHECK(plays(browser, "document.querySelector('.floor svg')"));
    CHECK(browser.logged_errors() == "");
  }
}

}  // namespace sidestep::report_page_test
