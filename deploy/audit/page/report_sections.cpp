// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/page/report_sections.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/file/xml_text.hpp"
#include "common/json/json_text.hpp"
#include "common/svg/charts.hpp"
#include "common/svg/palette.hpp"
#include "deploy/audit/metrics/report.hpp"
#include "deploy/audit/metrics/reported_values.hpp"
#include "deploy/audit/page/report_events.hpp"
#include "deploy/audit/picture/run_timing.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxBars = 40, kMaxEvents = 500, kMaxSpeedLines = 40;
constexpr int kSpeedSteps = 300;
constexpr const char *kNegotiation = "#0b62c4", *kPlan = "#b4500a", *kSearch = "#137a3a", *kAll = "#0b62c4",
                     *kMiddle = "#b4500a";

/// Where a report has no value.
constexpr const char* kNone = "none";

std::optional<double> number_at(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found == json.end() ? std::nullopt : reported_number(*found);
}

std::string figure(const std::string& name, const std::string& value, const char* kind = "") {
  return fmt::format("<div><dt>{}</dt><dd class='{}'>{}</dd></div>\n", xml_escaped(name), kind,
                     xml_escaped(value));
}

std::string with_unit(const std::optional<double>& value, double factor, int decimals, const char* unit) {
  return value ? fmt::format("{:.{}f} {}", factor * *value, decimals, unit) : kNone;
}

/// A count that should be 0.
std::string alarming(const std::string& name, const Json& count) {
  return figure(name, json_text(count), count == 0 ? "good" : "bad");
}

/// Contacts or crashes. The verdict counts neither those that disturbances excuse nor those that the audit
/// cannot judge.
std::string judged_figure(const std::string& name, double count, const ExcludedCounts& excluded) {
  std::string text = fmt::format("{:.0f}", count);
  if (excluded.excused > 0) text += fmt::format(", {:.0f} excused", excluded.excused);
  if (excluded.undecided > 0) text += fmt::format(", {:.0f} not judged", excluded.undecided);
  const char* const kind = count > excluded.excused + excluded.undecided ? "bad"
                           : excluded.undecided > 0                      ? "unknown"
                                                                         : "good";
  return figure(name, text, kind);
}

std::string contacts_figure(const Json& report) {
  return judged_figure("contacts", required_number(report, "contacts"), excluded_contacts(report));
}

/// Empty if there was no crash.
std::string crashes_figure(const Json& report) {
  if (report.at("crashes") == 0) return {};
  return judged_figure("crashes while moving", required_number(report, "crashes_while_moving"),
                       excluded_crashes(report));
}

std::string audit_figures(const Json& audit) {
  if (!audit.is_object()) return figure("audit", "not audited", "unknown");
  const double share = required_number(audit.at("coverage"), "share"),
               minimum = required_number(audit.at("coverage"), "minimum");
  return alarming("rules broken", audit.at("violations")) +
         figure("audit covered", with_unit(share, 100, 1, "%"), share >= minimum ? "good" : "unknown");
}

/// The robot's speed from the begin of the picture on; before that, no robot may move.
ChartLine speed_line(const FloorTrace::Robot& robot, const std::string& colour, double begin_s) {
  ChartLine line{fmt::format("robot {}", robot.id), colour, {}};
  for (const FloorTrace::Point& point : robot.path)
    if (point.at_s >= begin_s) line.points.emplace_back(point.at_s, point.speed_mps);
  return line;
}

double speed_at(const std::vector<FloorTrace::Point>& path, double at_s) {
  const auto after = std::ranges::upper_bound(path, at_s, {}, &FloorTrace::Point::at_s);
  if (after == path.begin() || after == path.end()) return 0;
  const FloorTrace::Point &from = *std::prev(after), &to = *after;
  return from.speed_mps + (at_s - from.at_s) / (to.at_s - from.at_s) * (to.speed_mps - from.speed_mps);
}

/// The fastest and the median robot, for floors on which single lines cannot be told apart.
std::vector<ChartLine> summary_lines(const FloorTrace& trace, const RunTiming& timing) {
  ChartLine fastest{"fastest robot", kAll, {}}, median{"median of the robots", kMiddle, {}};
  for (int i = 0; i <= kSpeedSteps; ++i) {
    const double at_s = timing.begin_s + (timing.end_s - timing.begin_s) * i / kSpeedSteps;
    std::vector<double> speeds;
    for (const FloorTrace::Robot& robot : trace.robots) speeds.push_back(speed_at(robot.path, at_s));
    std::ranges::sort(speeds);
    fastest.points.emplace_back(at_s, speeds.back());
    median.points.emplace_back(at_s, speeds[speeds.size() / 2]);
  }
  return {fastest, median};
}

void add_latency(std::vector<ChartBar>& bars, const Json& quantiles, const std::string& name,
                 const char* colour) {
  for (const auto& [key, label] : {std::pair{"p50", "median"}, {"p99", "99 %"}, {"max", "longest"}})
    if (const auto us = number_at(quantiles, key))
      bars.push_back({fmt::format("{}, {}", name, label), *us,
                      fmt::format("{:.{}f} \xC2\xB5s", *us, *us < 100 ? 1 : 0), colour});
}

std::string html_table(const std::string& head, const std::string& rows) {
  return fmt::format("<table>\n<tr>{}</tr>\n{}</table>\n", head, rows);
}

std::string counters_table(const Json& counters) {
  std::string rows;
  for (const auto& [process, counts] : counters.items())
    for (const auto& [reason, count] : counts.items())
      rows += fmt::format("<tr><td>{}</td><td>{}</td><td class='number'>{}</td></tr>\n", xml_escaped(process),
                          xml_escaped(reason), xml_escaped(json_text(count)));
  if (rows.empty()) return {};
  return html_section("Dropped or refused",
                      html_table("<th>process</th><th>reason</th><th>times</th>", rows));
}

}  // namespace

std::string html_section(const std::string& heading, const std::string& content) {
  return fmt::format("<section>\n<h2>{}</h2>\n{}</section>\n", xml_escaped(heading), content);
}

std::string figures_section(const Json& r) {
  const Arrivals arrivals = reported_arrivals(r);
  const auto cycles = number_at(r, "cycles"), missed = number_at(r, "missed_cycles");
  std::string figures =
      figure("robots arrived", fmt::format("{} of {}", arrivals.arrived, arrivals.with_goal()),
             arrivals.are_complete() ? "good" : "") +
      (arrivals.without_goal > 0 ? figure("robots without a goal", fmt::format("{}", arrivals.without_goal))
                                 : "") +
      contacts_figure(r) +
      figure("smallest clearance", with_unit(number_at(r, "min_clearance_m"), 1000, 1, "mm")) +
      figure("last arrival", with_unit(number_at(r, "makespan_s"), 1, 2, "s")) +
      figure("mean arrival", with_unit(number_at(r, "mean_arrival_s"), 1, 2, "s"));
  if (const auto ratio = number_at(r, "straight_line_time_ratio"))
    figures += figure("time over a straight line", fmt::format("{:.2f} times", *ratio));
  figures += audit_figures(r.at("audit"));
  figures += crashes_figure(r);
  figures += figure("proposals granted",
                    fmt::format("{} of {}", json_text(r.at("grants")), json_text(r.at("proposals"))));
  if (cycles && missed && *cycles > 0)
    figures += figure("cycles missed", fmt::format("{:.2f} %", 100 * *missed / *cycles));
  std::string note = fmt::format("Contacts: {}.", kContactMeaning);
  if (r.at("crashes") != 0) note += fmt::format(" Crashes: {}.", kCrashMeaning);
  return html_section("Figures", fmt::format("<dl class='figures'>\n{}</dl>\n<p class='dim'>{}</p>\n",
                                             figures, xml_escaped(note)));
}

std::string speeds_section(const FloorTrace& trace) {
  std::vector<ChartLine> lines;
  const RunTiming timing = timing_of(trace);
  if (trace.robots.size() > kMaxSpeedLines)
    lines = summary_lines(trace, timing);
  else
    for (std::size_t i = 0; i < trace.robots.size(); ++i)
      if (!trace.robots[i].path.empty())
        lines.push_back(speed_line(trace.robots[i], distinct_colour(i), timing.begin_s));
  LineAxes axes{"time [s]", "speed [m/s]"};
  if (trace.speed_limit_mps > 0) {
    axes.marked_y = trace.speed_limit_mps;
    axes.mark_label = "limit";
  }
  const std::string chart = line_chart(lines, axes);
  if (chart.empty()) return {};
  const char* note = trace.robots.size() > kMaxSpeedLines
                         ? "<p class='dim'>Blue: the fastest robot; orange: the median of all robots.</p>\n"
                         : "<p class='dim'>In the colours of the picture.</p>\n";
  return html_section("Speeds", note + ("<div class='wide'>" + chart + "</div>\n"));
}

std::string arrivals_section(const Json& report) {
  const auto late = report.find("not_arrived");
  const bool has_goalless = reported_arrivals(report).without_goal > 0 && late != report.end();
  const Json& arrivals = report.at("arrival_s");
  std::vector<ChartBar> bars;
  std::vector<double> times;
  std::size_t index = 0;
  for (const auto& [robot, at] : arrivals.items()) {
    const std::string colour = distinct_colour(index++);
    const auto at_s = reported_number(at);
    if (at_s) times.push_back(*at_s);
    const char* const without_time = has_goalless && !late->contains(robot) ? "no goal" : "not arrived";
    bars.push_back(
        {"robot " + robot, at_s.value_or(0), at_s ? fmt::format("{:.2f} s", *at_s) : without_time, colour});
  }
  if (times.empty()) return {};
  std::string chart;
  if (bars.size() <= kMaxBars) {
    chart = bar_chart(bars, {"time of arrival [s]"});
  } else {
    std::ranges::sort(times);
    ChartLine line{"robots that have arrived", kAll, {{0, 0}}};
    for (std::size_t i = 0; i < times.size(); ++i) {
      line.points.emplace_back(times[i], i);
      line.points.emplace_back(times[i], i + 1);
    }
    chart = line_chart({line}, {"time [s]", "robots that have arrived"});
  }
  return html_section("Arrivals", "<div class='wide'>" + chart + "</div>\n");
}

std::string latencies_section(const Json& report) {
  std::vector<ChartBar> bars;
  add_latency(bars, report.at("negotiation_us"), "negotiation", kNegotiation);
  const Json& wall = report.at("wall_clock");
  add_latency(bars, wall.at("plan_us"), "planning", kPlan);
  add_latency(bars, wall.at("search_us"), "safety search", kSearch);
  const char* note =
      report.at("program") == "simulate"
          ? "<p class='dim'>From proposal to verdict, in virtual time; planning and safety search "
            "of one robot in one cycle, by the clock.</p>\n"
          : "<p class='dim'>From proposal to verdict; planning and safety search of one robot in "
            "one cycle.</p>\n";
  return html_section(
      "Latencies",
      note + ("<div class='wide'>" + bar_chart(bars, {"time [\xC2\xB5s], logarithmic", true}) + "</div>\n"));
}

std::string events_section(const Json& report) {
  const std::vector<ReportEvent> events = events_of(report);
  std::string rows;
  for (std::size_t i = 0; i < std::min(events.size(), kMaxEvents); ++i) {
    const ReportEvent& event = events[i];
    const std::string time =
        event.at_s ? fmt::format("<button data-at='{:.3f}'>{:.2f} s</button>", *event.at_s, *event.at_s) : "";
    rows += fmt::format("<tr><td class='number'>{}</td><td class='{}'>{}</td></tr>\n", time,
                        event.is_bad ? "bad" : "", xml_escaped(event.text));
  }
  if (events.size() > kMaxEvents)
    rows += fmt::format("<tr><td></td><td>and {} others</td></tr>\n", events.size() - kMaxEvents);
  return html_section("Events", html_table("<th>time</th><th>event</th>", rows));
}

std::string processes_section(const Json& report) {
  std::string html = counters_table(report.at("counters"));
  const Json& wall = report.at("wall_clock");
  if (!wall.contains("processes")) return html;
  std::vector<ChartBar> bars;
  for (const auto& [name, use] : wall.at("processes").items()) {
    const double cpu_s = number_at(use, "cpu_s").value_or(0),
                 memory_mb = number_at(use, "max_memory_mb").value_or(0);
    bars.push_back({name, cpu_s, fmt::format("{:.2f} s, {:.0f} MB", cpu_s, memory_mb), kAll});
  }
  if (bars.empty()) return html;
  std::ranges::stable_sort(bars, std::ranges::greater{}, &ChartBar::value);
  std::string note;
  if (bars.size() > kMaxBars) {
    note = fmt::format("<p class='dim'>The {} of {} that used most.</p>\n", kMaxBars, bars.size());
    bars.resize(kMaxBars);
  }
  return html +
         html_section("Processes", note + "<div class='wide'>" +
                                       bar_chart(bars, {"processor time [s], and memory"}) + "</div>\n");
}

}  // namespace sidestep
