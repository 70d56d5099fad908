// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/page/report_page.hpp"

#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/page/report_example.hpp"

namespace sidestep::report_page_test {

std::string page_of(const Report& report) { return report_page(json_of(report)); }

TEST_CASE("the page of a run has its verdict, figures, paths, speeds, arrivals, latencies and events") {
  const std::string page = page_of(example_report());
  CAPTURE(page);
  CHECK_THAT(page, StartsWith("<!DOCTYPE html>") && ContainsSubstring("<h1>hall, seed 7</h1>"));
  CHECK_THAT(page, ContainsSubstring("<p class='verdict bad'>&#10007; failed: 1 contacts"));
  CHECK_THAT(page, ContainsSubstring("<dt>robots arrived</dt><dd class=''>1 of 2</dd>") &&
                       ContainsSubstring("<dt>contacts</dt><dd class='bad'>1</dd>") &&
                       ContainsSubstring("<dd class=''>14.2 mm</dd>") &&
                       ContainsSubstring("<dt>rules broken</dt><dd class='bad'>1</dd>"));
  for (const char* heading :
       {"Figures", "Paths", "Speeds", "Arrivals", "Latencies", "Events", "Dropped or refused", "Processes"})
    CHECK_THAT(page, ContainsSubstring(std::string("<h2>") + heading + "</h2>"));
  CHECK_THAT(page,
             ContainsSubstring("<title>path of robot 3</title>") && ContainsSubstring("<animateTransform"));
  CHECK_THAT(page,
             ContainsSubstring(">negotiation, 99 %</text>") && ContainsSubstring(">planning, median</text>"));
  CHECK_THAT(page, ContainsSubstring("<button data-at='0.500'>0.50 s</button>"));
  CHECK_THAT(page, ContainsSubstring("made by `sidestep run`, Fast DDS 2.9.1"));
  CHECK_THAT(page, ContainsSubstring("data-begin='0' data-end='1.25' data-speed='1' data-round='2.75'"));
  CHECK_THAT(page, ContainsSubstring(">0.75 s, 22 MB</text>"));
}

TEST_CASE("figures of a damaged report do not count as good") {
  const auto [path, value] = GENERATE(table<std::string, std::string>({{"/contacts", "null"},
                                                                       {"/contacts", "\"0\""},
                                                                       {"/without_goal", "3"},
                                                                       {"/audit/coverage/share", "null"},
                                                                       {"/audit/coverage/minimum", "null"}}));
  CAPTURE(path, value);
  auto report = json_of(example_report());
  report[nlohmann::ordered_json::json_pointer(path)] = nlohmann::ordered_json::parse(value);
  CHECK_THROWS_WITH(report_page(report), ContainsSubstring("is a damaged report"));
}

TEST_CASE("the page says what counts as a contact and, if there are any, as a crash") {
  Report report = example_report();
  CHECK_THAT(page_of(report),
             ContainsSubstring("<p class='dim'>Contacts: between robots or with obstacles.</p>"));
  report.crashes = 2;
  report.crashes_while_moving = 1;
  CHECK_THAT(
      page_of(report),
      ContainsSubstring("<dt>crashes while moving</dt><dd class='bad'>1</dd>") &&
          ContainsSubstring("<p class='dim'>Contacts: between robots or with obstacles. Crashes: contacts of "
                            "a robot with an opponent or a person.</p>"));
}

TEST_CASE("a page needs no other file and no network") {
  const std::string page = page_of(example_report());
  for (const char* part : {"src=", "href=", "url(http", "@import", "<link", "fetch("})
    CHECK_THAT(page, !ContainsSubstring(part));
  CHECK_THAT(page, ContainsSubstring("content=\"default-src 'none'; "));
}

TEST_CASE("texts of a report cannot leave their place in the page") {
  Report report = example_report();
  report.scenario = "<script>alert(1)</script>";
  report.not_arrived[8] = "</td><b onclick='x'>";
  const std::string page = page_of(report);
  CHECK_THAT(page, !ContainsSubstring("<script>alert") && !ContainsSubstring("<b onclick") &&
                       !ContainsSubstring("<moved>"));
  CHECK_THAT(page, ContainsSubstring("&lt;script&gt;alert(1)&lt;/script&gt;"));
}

TEST_CASE("the page says in words and colour whether a run passed, failed, or was not judged") {
  Report report = example_report();
  report.contacts = 0;
  report.arrived = 2;
  report.audit.reset();
  CHECK_THAT(page_of(report),
             ContainsSubstring("<p class='verdict good'>&#10003; passed: 2 of 2 robots arrived"));
  CHECK_THAT(page_of(report), ContainsSubstring("<dd class='unknown'>not audited</dd>"));
  report.audit = AuditTotals{};
  report.contacts = report.audit->excused_contacts = 3;
  CHECK_THAT(page_of(report), ContainsSubstring("<dt>contacts</dt><dd class='good'>3, 3 excused</dd>"));
  report.audit.reset();
  report.contacts = 0;
  report.director_deaths = {"killed by signal 9"};
  CHECK_THAT(page_of(report), ContainsSubstring("<p class='verdict unknown'>? not judged: "));
}

/// Of three robots one has no goal, and all others have arrived.
Report goalless_report() {
  Report report = example_report();
  report.contacts = 0;
  report.audit.reset();
  report.robots = 3;
  report.arrived = 2;
  report.without_goal = 1;
  report.arrival_s = {{3, 1.25}, {5, 2.5}, {8, std::nullopt}};
  report.not_arrived.clear();
  return report;
}

TEST_CASE("robots without a goal are not counted among those that should arrive") {
  const std::string page = page_of(goalless_report());
  CHECK_THAT(page, ContainsSubstring("passed: 2 of 2 robots arrived and 1 had no goal") &&
                       ContainsSubstring("<dt>robots arrived</dt><dd class='good'>2 of 2</dd>") &&
                       ContainsSubstring("<dt>robots without a goal</dt><dd class=''>1</dd>"));
  CHECK_THAT(page, ContainsSubstring(">no goal</text>") && !ContainsSubstring(">not arrived</text>"));
  Report late = goalless_report();
  late.robots = 4;
  late.arrival_s[9] = std::nullopt;
  late.not_arrived = {{9, "no path leads to its goal"}};
  CHECK_THAT(page_of(late), ContainsSubstring(">no goal</text>") &&
                                ContainsSubstring(">not arrived</text>") &&
                                ContainsSubstring("<dd class=''>2 of 3</dd>"));
}

TEST_CASE("in reports of versions that do not count robots without a goal, every robot has one") {
  auto old = json_of(example_report());
  old.erase("without_goal");
  CHECK_THAT(report_page(old), ContainsSubstring(">1 of 2</dd>") && ContainsSubstring(">not arrived</text>"));
}

TEST_CASE("contacts and crashes that the verdict does not count are not red") {
  Report report = example_report();
  report.audit = AuditTotals{};
  report.contacts = 6;
  report.audit->excused_contacts = 3;
  report.audit->unidentified_contacts = 2;
  report.audit->undecided_contacts = 1;
  report.crashes = report.crashes_while_moving = 2;
  report.audit->excused_crashes = 2;
  REQUIRE(report.unexcused_contacts() == 0);
  REQUIRE(report.unexcused_crashes() == 0);
  std::string page = page_of(report);
  CHECK_THAT(page, ContainsSubstring("<dt>contacts</dt><dd class='unknown'>6, 3 excused, 3 not judged</dd>"));
  CHECK_THAT(page, ContainsSubstring("<dt>crashes while moving</dt><dd class='good'>2, 2 excused</dd>"));
  ++report.contacts;
  ++report.crashes_while_moving;
  page = page_of(report);
  CHECK_THAT(page, ContainsSubstring("<dt>contacts</dt><dd class='bad'>7, 3 excused, 3 not judged</dd>"));
  CHECK_THAT(page, ContainsSubstring("<dt>crashes while moving</dt><dd class='bad'>3, 2 excused</dd>"));
}

TEST_CASE("the page of a report without paths says so, and shows the rest") {
  Report report = example_report();
  report.trace.reset();
  const std::string page = page_of(report);
  CHECK_THAT(page, ContainsSubstring("This report has no paths.") && !ContainsSubstring("id='player'") &&
                       !ContainsSubstring("<h2>Speeds</h2>") && ContainsSubstring("<h2>Latencies</h2>"));
}

TEST_CASE("for hundreds of robots the page shows sums instead of hundreds of lines and bars") {
  Report report = example_report();
  report.trace->robots.clear();
  report.arrival_s.clear();
  for (RobotId id = 0; id < 300; ++id) {
    report.trace->robots.push_back({id, Team::kBlue, {0, 0}, {}, {{0, {0, 0}, 0}, {5, {1, 0}, 1}}});
    report.arrival_s[id] = 0.01 * id;
    report.processes["agent " + std::to_string(id)] = {1, 20};
  }
  const std::string page = page_of(report);
  CHECK_THAT(page, ContainsSubstring("median of the robots") &&
                       ContainsSubstring("robots that have arrived") &&
                       ContainsSubstring("The 40 of 300 that used most."));
  CHECK_THAT(page, !ContainsSubstring(">robot 299</text>"));
}

TEST_CASE("what is not the report of a run is refused with the reason") {
  CHECK_THROWS_WITH(report_page(parse_ordered_json("[1]")),
                    "is not the report of a run: it has no key \"program\"");
  CHECK_THROWS_WITH(
      report_page(parse_ordered_json(R"({"program": "simulate", "scenario": "a", "trials": 7})")),
      "is not the report of a run: it has no key \"passed\"");
  auto damaged = json_of(example_report());
  damaged["audit"]["first"] = {{{"rule", 7}}};
  CHECK_THROWS_WITH(report_page(damaged), StartsWith("is a damaged report: "));
  damaged = json_of(example_report());
  damaged["scenario"] = 7;
  CHECK_THROWS_WITH(report_text(damaged), StartsWith("is a damaged report: "));
  for (const char* count : {"-1", "1e300", "\"two\"", "null"}) {
    damaged = json_of(example_report());
    damaged["robots"] = parse_ordered_json(count);
    CHECK_THROWS_WITH(report_page(damaged), StartsWith("is a damaged report: "));
  }
  for (const char* place : {"/arrival_s/3", "/min_clearance_m", "/negotiation_us/max", "/deaths/0/at_s"}) {
    CAPTURE(place);
    damaged = json_of(example_report());
    damaged[nlohmann::ordered_json::json_pointer(place)] = -1e300;
    CHECK_THROWS_WITH(report_page(damaged), StartsWith("is a damaged report: -1e+300 is not between"));
  }
  damaged = json_of(example_report());
  damaged["paths"]["3"][0][0] = "soon";
  CHECK_THROWS_AS(report_page(damaged), std::invalid_argument);
}

TEST_CASE("as text, a report is its verdict and its events") {
  const std::string text = report_text(json_of(example_report()));
  CHECK_THAT(text, StartsWith("hall, seed 7: failed: 1 contacts"));
  CHECK_THAT(text, ContainsSubstring("\n    1.25 s  robot 3 arrived\n"));
}

TEST_CASE("texts of a report cannot control the terminal that shows them") {
  Report report = example_report();
  report.scenario = "a\x1b[2J";
  report.abort_reason = "b\r\x07";
  report.not_arrived[8] = "c\x1b]0;title\x07";
  report.deaths[0].reason = "d\n    1.00 s  robot 8 arrived";
  const std::string text = report_text(json_of(report));
  CHECK(text.find_first_of("\x1b\x07\r\t") == std::string::npos);
  CHECK_THAT(text, ContainsSubstring("c\xEF\xBF\xBD]0;title") &&
                       !ContainsSubstring("\n    1.00 s  robot 8 arrived"));
}

}  // namespace sidestep::report_page_test
