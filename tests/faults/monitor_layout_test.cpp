// SPDX-License-Identifier: Apache-2.0
// What a person sees of the monitor's page on a desk, on a small screen and on a phone, in both themes.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/faults/browser.hpp"
#include "tests/faults/monitored_run.hpp"
#include "tests/faults/page_screens.hpp"
#include "tests/faults/shown_recording.hpp"

namespace sidestep::monitor_layout_test {

using namespace std::chrono_literals;
using Json = nlohmann::json;

void check_layout(Browser& page, const PageScreen& screen, const std::string& state) {
  INFO(screen.name(state));
  CHECK(page.run("return document.documentElement.dataset.theme") == screen.theme);
  if (screen.width_px == 1500) CHECK(page.run("return pageChecks.floorShare()") >= 0.55);
  if (screen.is_phone())
    CHECK(found_by(page,
                   "belowFirstScreen(['floor', 'play', 'live', 'time', 'speed', 'step-back', 'next-event', "
                   "'clock', 'lamp'])")
              .empty());
  check_controls_and_texts(page, screen, state);
}

void check_numbers(Browser& page, const PageScreen& screen) {
  INFO(screen.name("numbers"));
  (void)page.wait_until("pageChecks.illegibleRobots().length === 0");
  CHECK(found_by(page, "illegibleRobots()").empty());
}

/// Waits until what scripts have caused is drawn.
void settle(Browser& page) {
  page.run(
      "return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))");
}

void check_menus(Browser& page, const PageScreen& screen) {
  for (const char* menu : {"layer-list", "panel-menu", "columns-robots"}) {
    page.run(fmt::format("document.getElementById('{}').scrollIntoView({{block: 'nearest'}})", menu));
    settle(page);  // scrolling closes menus
    page.run(fmt::format("document.getElementById('{}').open = true", menu));
    REQUIRE(page.wait_until(fmt::format("document.querySelector('#{} > div').style.left !== ''", menu)));
    INFO(screen.name(menu));
    // Behind an open menu, other controls are hidden.
    CHECK(
        page.run(fmt::format(
            "return [...document.querySelectorAll('#{} > div :is(button, input)')].filter((node) => {{ "
            "node.scrollIntoView({{block: 'nearest'}}); const b = node.getBoundingClientRect(); const top = "
            "document.elementFromPoint(b.x + b.width / 2, b.y + b.height / 2); return "
            "!(node.contains(top) || top?.closest('label')?.contains(node)); }}).map((node) => node.id)",
            menu)) == Json::array());
    CHECK(found_by(page, "faintTexts()").empty());
    keep_screenshot(page, screen.name(menu));
    page.run(fmt::format("document.getElementById('{}').open = false", menu));
  }
}

void check_panels(Browser& page, const PageScreen& screen) {
  for (const char* panel : {"events", "coordinators", "topics", "inspect", "robots"}) {
    page.click(fmt::format("tab-{}", panel));
    CHECK(page.run(fmt::format("return document.getElementById('panel-{}').innerText.length", panel)) > 10);
    check_controls_and_texts(page, screen, std::string("panel-") + panel);
  }
}

void check_selection(Browser& page, const PageScreen& screen, int robot) {
  INFO(screen.name("selection"));
  const int before = page.run(fmt::format("return pageChecks.markedPixels({})", robot));
  page.run(fmt::format("document.querySelector('#panel-robots [data-key=\"{}\"]').click()", robot));
  CHECK(page.wait_until(fmt::format(
      "monitor.floor.selected === {0} && !monitor.floor.isStale && pageChecks.markedPixels({0}) > {1} + 60",
      robot, before)));
  CHECK(page.run("return document.querySelectorAll('#panel-robots [data-selected=\"true\"]').length") == 1);
  keep_screenshot(page, screen.name("selection"));
}

TEST_CASE("a recording of 22 robots is shown well on each screen, in both themes", "[slow]") {
  ShownRecording recording("two-teams-22.yaml", {"--seconds", "8"});
  Browser page;
  for (const PageScreen& screen : kPageScreens) {
    INFO(screen.name("recording"));
    open_on(page, screen, recording.url());
    REQUIRE(page.wait_until("window.monitor && monitor.frame && monitor.whole && monitor.whole.is_over"));
    // The first state: the first granted motion, with all robots, and the verdict on the whole.
    CHECK(page.wait_until(
        "document.getElementById('clock').textContent.includes('paused at the first granted motion')"));
    CHECK(page.text("lamp-whole") == "whole recording: ✓ promise kept");
    CHECK(page.run("return monitor.drawn.marks.length") == 22);
    CHECK(page.run("return document.getElementById('floor-hint').hidden") == true);
    check_layout(page, screen, "recording");
    check_numbers(page, screen);
    check_menus(page, screen);
    check_panels(page, screen);

    // Plays, from the first state on.
    const double opened_s = page.run("return monitor.frame.time");
    page.click("play");
    CHECK(page.wait_until(fmt::format("monitor.frame.time > {:.3f}", opened_s + 0.3)));
    CHECK(page.text("play") == "Pause");
    page.click("play");
    CHECK(page.wait_until("document.getElementById('play').textContent === 'Play'"));

    // Seeks to a moment that was not shown before; the trails of its past are there.
    page.run(fmt::format("pageChecks.seekTo({:.3f})", opened_s + 4));
    CHECK(page.wait_until(fmt::format("Math.abs(monitor.frame.time - {:.3f}) < 0.1", opened_s + 4)));
    CHECK(page.wait_until("monitor.trails.before(0, monitor.frame.time).length > 20"));
    check_layout(page, screen, "seek");
    // On smaller screens, the marks of robots that meet overlap by themselves.
    if (screen.width_px == 1500) check_numbers(page, screen);
    check_selection(page, screen, 17);

    // The end is not live, and Play plays it again.
    page.click("live");
    CHECK(page.wait_until("document.getElementById('clock').textContent.includes('end of the recording')"));
    CHECK(page.text("clock").find("live") == std::string::npos);
    page.click("play");
    CHECK(page.wait_until(fmt::format("monitor.frame.time < {:.3f}", opened_s + 3)));
    CHECK(page.logged_errors() == "");
  }
  recording.end();
}

TEST_CASE("robots of a large building have legible marks, and a key shows them large", "[slow]") {
  ShownRecording recording("house.yaml", {"--seconds", "2"});
  Browser page;
  open_on(page, kPageScreens[0], recording.url());
  REQUIRE(page.wait_until("window.monitor && monitor.drawn.marks.length > 0"));
  CHECK(page.run("return monitor.drawn.marks.every((mark) => mark.r >= 6)") == true);
  const double whole = page.run("return monitor.floor.view.scale");
  page.press("z");
  CHECK(page.run("return monitor.floor.view.scale") >= whole);
  CHECK(page.run("return monitor.floor.hasOutsiders()") == false);
  keep_screenshot(page, "house-fit-robots");
  page.press("f");
  CHECK(page.run("return monitor.floor.view.scale") == whole);
  recording.end();
}

TEST_CASE("panels are dragged over the floor, closed and opened again, and stay there", "[slow]") {
  ShownRecording recording("crossing.yaml", {"--seconds", "2"});
  Browser page;
  open_on(page, kPageScreens[0], recording.url());
  REQUIRE(page.wait_until("window.monitor && monitor.panels"));
  page.run(
      "const tab = document.getElementById('tab-events'), box = tab.getBoundingClientRect(); "
      "pageChecks.dragPointer(tab, {x: box.x + 10, y: box.y + 10}, {x: 90, y: 480})");
  const std::string window = "document.querySelector('#windows #panel-events')";
  REQUIRE(page.run("return " + window + " !== null") == true);
  CHECK(page.run("const b = " + window +
                 ".getBoundingClientRect(); return b.x <= 90 && b.y <= 480 && b.right > "
                 "90 && b.bottom > 480") == true);
  check_controls_and_texts(page, kPageScreens[0], "window");
  page.click("close-robots");
  CHECK(page.run("return document.getElementById('panel-robots').hidden") == true);
  page.open("about:blank");
  open_on(page, kPageScreens[0], recording.url());
  REQUIRE(page.wait_until("window.monitor && monitor.panels"));
  CHECK(page.run("return " + window + " !== null") == true);
  CHECK(page.run("return document.getElementById('panel-robots').hidden") == true);
  page.click("menu-robots");
  CHECK(page.run("return document.getElementById('panel-robots').hidden") == false);

  // Without the side, the floor has all the width.
  page.press("p");
  CHECK(page.wait_until("document.getElementById('floor').clientWidth === innerWidth"));
  recording.end();
}

TEST_CASE("the planning page is legible on each screen, in both themes, with a legend in its colours",
          "[slow]") {
  ShownRecording recording("crossing.yaml", {"--seconds", "1"});
  Browser page;
  for (const PageScreen& screen : kPageScreens) {
    open_on(page, screen, recording.url() + "planning.html");
    REQUIRE(page.wait_until("window.planning && planning.plan && planning.plan.nodes.length > 100"));
    check_controls_and_texts(page, screen, "planning");
    CHECK(page.run("return pageChecks.floorShare()") > (screen.is_phone() ? 0.4 : 0.7));
    // The colour of each line of the legend is on the canvas.
    CHECK(page.wait_until(R"(
      (() => {
        const canvas = document.getElementById('floor');
        const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
        const isDrawn = (name) => {
          const [r, g, b] = getComputedStyle(document.querySelector('#legend .' + name)).color.match(/\d+/g).map(Number);
          for (let i = 0; i < data.length; i += 4)
            if (data[i + 3] > 60 && Math.abs(data[i] - r) + Math.abs(data[i + 1] - g) + Math.abs(data[i + 2] - b) < 40) return true;
          return false;
        };
        return ['free', 'blocked', 'path', 'start', 'goal', 'obstacle'].every(isDrawn);
      })())"));
    page.click("theme");
    CHECK(page.run("return document.documentElement.dataset.theme") != screen.theme);
    page.run("localStorage.clear()");
  }
  CHECK(page.logged_errors() == "");
  recording.end();
}

TEST_CASE("a run is shown and commanded on each screen, in both themes", "[both-cores][slow]") {
  LaunchedRun run(kWaitingRobots);
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  const MonitorProcess monitor(run, {"--control"});
  Browser page;
  double x_m = -1;
  for (const PageScreen& screen : kPageScreens) {
    INFO(screen.name("run"));
    open_on(page, screen, monitor.url());
    REQUIRE(
        page.wait_until("window.monitor && monitor.panels && monitor.panels.promise.state === 'kept' && "
                        "monitor.drawn.marks.length === 3",
                        polling(run)));
    CHECK(page.text("lamp-text") == "promise kept");
    CHECK(page.text("clock").ends_with(" · live"));
    check_layout(page, screen, "run");
    check_numbers(page, screen);
    check_selection(page, screen, 1);
    page.click("tab-control");
    check_controls_and_texts(page, screen, "control");

    // Drags robot 0 to another place.
    page.run("scrollTo(0, 0)");
    page.run(fmt::format(
        "const at = monitor.floor.places().find((p) => p.id === 0); pageChecks.dragPointer("
        "document.getElementById('floor'), pageChecks.pagePlace(at.x, at.y), pageChecks.pagePlace({}, -1))",
        x_m));
    CHECK(
        page.wait_until("/^Robot 0: order \\d+ arrived/.test(document.getElementById('command-result')."
                        "textContent)",
                        polling(run)));
    const auto is_there = [&] {
      return std::ranges::any_of(run.truth().robots(), [&](const msg::TrueRobotState& robot) {
        return robot.robot() == 0 && std::hypot(robot.x_m() - x_m, robot.y_m() + 1) < 0.1;
      });
    };
    CHECK(run.wait_until(is_there));
    x_m = -x_m;
    CHECK(page.logged_errors() == "");
  }
}

}  // namespace sidestep::monitor_layout_test
