// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/picture/run_picture.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/file/xml_text.hpp"
#include "common/json/json_text.hpp"
#include "common/svg/axis.hpp"
#include "common/svg/floor_sheet.hpp"
#include "common/svg/palette.hpp"
#include "common/svg/svg.hpp"
#include "deploy/audit/metrics/floor_trace_json.hpp"
#include "deploy/audit/metrics/reported_values.hpp"
#include "deploy/audit/picture/opponent_drawing.hpp"
#include "deploy/audit/picture/robot_drawing.hpp"
#include "deploy/audit/picture/run_timing.hpp"
#include "deploy/audit/picture/shown_part.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kStrip_px = 34, kMinStrip_px = 300;
constexpr double kEnlarged = 1.3;
constexpr const char *kNeutral = "#57606a", *kAlarm = "#d1242f";

/// The time of the run along a bar that fills as the picture plays.
std::string time_strip(const RunTiming& timing, double width_px) {
  const double step_s = round_step(kTickSpacing_px * (timing.end_s - timing.begin_s) / width_px);
  const auto x = [&](double at_s) {
    return width_px * (at_s - timing.begin_s) / (timing.end_s - timing.begin_s);
  };
  std::string marks, labels;
  for (const double at_s : ticks(timing.begin_s, timing.end_s, step_s)) {
    marks += fmt::format("M{:.1f} 2v10", x(at_s));
    labels += svg_text({x(at_s), 25}, tick_label(at_s, step_s) + " s",
                       "font-size='11' fill='#57606a' text-anchor='middle'");
  }
  return fmt::format(
      "<rect y='4' width='{0:.1f}' height='6' fill='#dde2e7'/>\n<rect y='4' width='{0:.1f}' height='6' "
      "fill='#8b949e'><animate attributeName='width' {1}/></rect>\n<path d='{2}' stroke='#57606a'/>\n{3}",
      width_px,
      animation_attributes(timing, {timing.begin_s, timing.end_s}, {"0", fmt::format("{:.1f}", width_px)}),
      marks, labels);
}

std::string cross_data(const Vec2& at_px, double size_px) {
  return fmt::format("M{0:.1f} {1:.1f}l{2:.1f} {2:.1f}m0 -{2:.1f}l-{2:.1f} {2:.1f}", at_px.x() - size_px / 2,
                     at_px.y() - size_px / 2, size_px);
}

std::string incidents(const FloorTrace& trace, const FloorView& view) {
  std::string svg;
  for (const FloorTrace::Incident& incident : trace.incidents) {
    std::string robots;
    for (const RobotId robot : incident.robots)
      robots += fmt::format("{}{}", robots.empty() ? "" : ", ", robot);
    svg += fmt::format(
        "<path d='{}' fill='none' stroke='{}' stroke-width='4'><title>{:.2f} s: {} of robot "
        "{}</title></path>\n",
        cross_data(view.px(incident.position_m), 18), kAlarm, incident.at_s, xml_escaped(incident.kind),
        robots);
  }
  return svg;
}

std::vector<LegendEntry> legend_of(const FloorTrace& trace, const RobotStyle& style,
                                   const RunTiming& timing) {
  const std::string outline = fmt::format("fill='white' stroke='{}' stroke-width='2'", kNeutral);
  std::vector<LegendEntry> legend;
  legend.push_back(dot_entry("start", outline + " stroke-dasharray='4 3'", 7.5));
  legend.push_back({fmt::format("<path d='{}' {}/>", goal_mark_data({9.5, 9}, 8.5), outline), "goal"});
  legend.push_back(
      dot_entry(timing.plays() ? "robot" : "robot at the end", fmt::format("fill='{}'", kNeutral), 8));
  if (style.has_teams)
    for (const Team team : {Team::kBlue, Team::kYellow})
      legend.push_back(
          dot_entry(team == Team::kBlue ? "blue team" : "yellow team",
                    fmt::format("fill='{}' stroke='{}' stroke-width='3'", kNeutral, colour_of(team)), 7));
  if (timing.plays())
    legend.push_back(
        {fmt::format("<path d='M0 9h24' stroke='{0}' stroke-width='2'/><path d='{1}' fill='{0}'/>", kNeutral,
                     svg_arrow_data({12, 9}, {1, 0}, 6)),
         fmt::format("direction, every {:g} s", style.arrow_period_s), 30});
  if (!trace.obstacles.empty() || !trace.walls.empty())
    legend.push_back(area_entry("obstacle", fmt::format("fill='{}'", kObstacleColour)));
  if (!trace.opponents.empty())
    legend.push_back(
        {fmt::format(
             "<path d='M0 9h24' stroke='{0}' stroke-width='1.5' stroke-dasharray='5 4'/><path d='{1}' "
             "fill='{0}' fill-opacity='0.6'/>",
             kOpponentColour, svg_ring_data({12, 9}, 7)),
         "person or opponent", 30});
  if (!trace.incidents.empty())
    legend.push_back(
        {fmt::format("<path d='{}' stroke='{}' stroke-width='4'/>", cross_data({9, 9}, 14), kAlarm),
         "contact"});
  if (style.enlargement > kEnlarged)
    legend.push_back({"",
                      fmt::format("discs: {:.{}f} times the robots' size", style.enlargement,
                                  style.enlargement < 10 ? 1 : 0),
                      0});
  if (timing.speed > 1) legend.push_back({"", fmt::format("plays {:g} times as fast", timing.speed), 0});
  return legend;
}

FloorSheet sheet_of(const FloorTrace& trace) {
  FloorSheet sheet;
  sheet.view = sheet_view(shown_part(trace));
  const RunTiming timing = timing_of(trace);
  const RobotStyle style = robot_style(trace, sheet.view, timing);
  const Box field = field_box(trace.field);
  sheet.floor = svg_polygon(sheet.view, corners_of(field), "fill='none' stroke='#57606a' stroke-width='3'") +
                svg_obstacles(sheet.view, trace.walls);
  for (const Shape& obstacle : trace.obstacles) sheet.floor += svg_obstacle(sheet.view, obstacle);
  std::string paths, goals, starts, discs;
  for (std::size_t i = 0; i < trace.robots.size(); ++i) {
    const RobotDrawing robot = draw_robot(trace.robots[i], distinct_colour(i), style, sheet.view, timing);
    paths += robot.path;
    goals += robot.goals;
    starts += robot.start;
    discs += robot.disc;
  }
  sheet.floor += paths + goals + starts + svg_opponents(trace, sheet.view, timing) + discs +
                 incidents(trace, sheet.view);
  if (timing.plays() && sheet.view.size_px().x() >= kMinStrip_px) {
    sheet.strip = time_strip(timing, sheet.view.size_px().x());
    sheet.strip_px = kStrip_px;
  }
  sheet.legend = legend_of(trace, style, timing);
  return sheet;
}

std::string field_text(const FloorTrace& trace) {
  const Box part = shown_part(trace), field = field_box(trace.field);
  const bool is_part = ((part.max_m - part.min_m).array() < (field.max_m - field.min_m).array() - 1e-6).any();
  return fmt::format("{} {:g} x {:g} m", is_part ? "part of a field of" : "field of", trace.field.length_m,
                     trace.field.width_m);
}

}  // namespace

std::string run_title(const Json& report) {
  const Json& seed = report.at("seed");
  const std::string name = report.at("scenario").get<std::string>();
  return seed.is_null() ? name : fmt::format("{}, seed {}", name, json_text(seed));
}

std::string run_outcome(const Json& report) {
  const Json& failure = report.at("failure");
  if (report.at("passed") != true) {
    const std::string reason = failure.is_string() ? failure.get<std::string>() : "";
    // The reason of a run that was not judged says so itself.
    return reason.starts_with("not judged") ? reason : "failed: " + reason;
  }
  const auto makespan_s = reported_number(report.at("makespan_s"));
  const std::string when = makespan_s ? fmt::format(" in {:.2f} s", *makespan_s) : "";
  return fmt::format("passed: {}, {} contacts", arrivals_text(reported_arrivals(report), when),
                     json_text(report.at("contacts")));
}

std::string run_picture(const Json& report) try {
  const auto trace = floor_trace_of(report);
  if (!trace) {
    return svg_document(620, 80,
                        svg_text({20, 30}, run_title(report), "font-size='17' font-weight='bold'") +
                            svg_text({20, 54}, "This report has no paths, so there is nothing to draw.", ""));
  }
  FloorSheet sheet = sheet_of(*trace);
  sheet.title = run_title(report);
  sheet.subtitle = fmt::format("{}; {}", run_outcome(report), field_text(*trace));
  return svg_sheet(sheet);
} catch (const nlohmann::json::exception& error) {
  throw std::invalid_argument(error.what());
}

std::string run_picture_from(std::string_view report_text) {
  return run_picture(parse_ordered_json(report_text));
}

}  // namespace sidestep
