// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/page/report_page.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/file/utf8.hpp"
#include "common/file/xml_text.hpp"
#include "deploy/audit/metrics/floor_trace_json.hpp"
#include "deploy/audit/page/page_parts.hpp"
#include "deploy/audit/page/report_events.hpp"
#include "deploy/audit/page/report_sections.hpp"
#include "deploy/audit/picture/run_picture.hpp"
#include "deploy/audit/picture/run_timing.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

/// Throws std::invalid_argument unless the JSON is the report of a run, as opposed to that of a campaign.
void require_report(const Json& report) {
  for (const char* key : {"program", "scenario", "passed", "arrival_s", "wall_clock"})
    if (!report.is_object() || !report.contains(key))
      throw std::invalid_argument(fmt::format("is not the report of a run: it has no key \"{}\"", key));
}

/// Turns errors about the types of values into errors about the report.
template <typename Function>
std::string checked(const Json& report, Function&& function) try {
  require_report(report);
  return function();
} catch (const nlohmann::json::exception& error) {
  throw std::invalid_argument(fmt::format("is a damaged report: {}", error.what()));
}

std::string header(const Json& report) {
  const std::string outcome = run_outcome(report);
  const bool has_passed = report.at("passed") == true, is_unknown = outcome.starts_with("not judged");
  std::string origin = fmt::format("made by `sidestep {}`", report.at("program").get<std::string>());
  if (const Json& wall = report.at("wall_clock"); wall.contains("fast_dds"))
    origin += fmt::format(", Fast DDS {}", wall.at("fast_dds").get<std::string>());
  return fmt::format(
      "<header>\n<h1>{}</h1>\n<p class='verdict {}'>{} {}</p>\n<p class='dim'>{}</p>\n</header>\n",
      xml_escaped(run_title(report)),
      has_passed   ? "good"
      : is_unknown ? "unknown"
                   : "bad",
      has_passed   ? "&#10003;"
      : is_unknown ? "?"
                   : "&#10007;",
      xml_escaped(outcome), xml_escaped(origin));
}

std::string picture_section(const Json& report, const std::optional<FloorTrace>& trace) {
  if (!trace)
    return html_section(
        "Paths",
        "<p>This report has no paths. Reports of `sidestep run` and `sidestep simulate` have them, "
        "unless the process that directs the run died.</p>\n");
  const RunTiming timing = timing_of(*trace);
  std::string player;
  if (timing.plays())
    player = fmt::format(
        "<div class='player' id='player' hidden data-begin='{0}' data-end='{1}' data-speed='{2}' "
        "data-round='{3}'><button>Pause</button><input type='range' min='{0}' max='{1}' step='any' "
        "aria-label='time of the run'><output></output></div>\n",
        timing.begin_s, timing.end_s, timing.speed, timing.round_s());
  return html_section("Paths", player + "<div class='wide floor'>" + run_picture(report) + "</div>\n");
}

}  // namespace

std::string report_page(const Json& report) {
  return checked(report, [&] {
    const std::optional<FloorTrace> trace = floor_trace_of(report);
    std::string page = fmt::format(
        "<!DOCTYPE html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n<meta name='viewport' "
        "content='width=device-width'>\n<meta http-equiv='Content-Security-Policy' content=\"default-src "
        "'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n<title>{}</title>\n",
        xml_escaped(run_title(report) + ": " + run_outcome(report)));
    page += std::string("<style>") + kPageStyle + "</style>\n</head>\n<body>\n";
    page += header(report) + figures_section(report) + picture_section(report, trace);
    if (trace) page += speeds_section(*trace);
    page += arrivals_section(report) + latencies_section(report) + events_section(report) +
            processes_section(report);
    return page + "<script>" + kPageScript + "</script>\n</body>\n</html>\n";
  });
}

std::string report_text(const Json& report) {
  return checked(report, [&] {
    std::string text = printable_line(fmt::format("{}: {}", run_title(report), run_outcome(report))) + "\n";
    for (const ReportEvent& event : events_of(report))
      text += fmt::format("{:>10}  {}\n", event.at_s ? fmt::format("{:.2f} s", *event.at_s) : "",
                          printable_line(event.text));
    return text;
  });
}

}  // namespace sidestep
