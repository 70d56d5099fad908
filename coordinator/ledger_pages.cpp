// SPDX-License-Identifier: Apache-2.0
#include "coordinator/ledger_pages.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "common/messaging/version_codec.hpp"

namespace sidestep {
namespace {

struct PlacedRobot {
  std::span<const Version> versions;
  Vec2 position_m;
};

std::size_t pages_for(std::size_t robots) { return (robots + kRobotsPerPage - 1) / kRobotsPerPage; }

/// Sorts the robots into strips along y whose width makes pages about square. Strips alternate between
/// ascending and descending y, so a page that spans two strips stays compact.
void sort_into_tiles(std::vector<PlacedRobot>& robots) {
  if (robots.size() <= kRobotsPerPage) return;
  const double pages = static_cast<double>(pages_for(robots.size()));
  const auto strips = static_cast<std::size_t>(std::ceil(std::sqrt(pages)));
  const std::size_t strip = (robots.size() + strips - 1) / strips;
  // Stable, so robots at equal positions stay in the roster's order.
  std::ranges::stable_sort(robots, {}, [](const PlacedRobot& robot) { return robot.position_m.x(); });
  double direction = 1;
  for (std::size_t i = 0; i < robots.size(); i += strip) {
    std::ranges::stable_sort(
        std::span(robots).subspan(i, std::min(strip, robots.size() - i)), {},
        [direction](const PlacedRobot& robot) { return direction * robot.position_m.y(); });
    direction = -direction;
  }
}

void fill(msg::LedgerPage& page, std::span<const PlacedRobot> robots) {
  std::size_t count = 0;
  for (const PlacedRobot& robot : robots) count += robot.versions.size();
  page.versions().reserve(count);
  Vec2 low(0, 0), high(0, 0);
  for (const PlacedRobot& robot : robots) {
    for (const Version& version : robot.versions) {
      const Vec2& start = version.trajectory.at_start().position_m;
      low = page.versions().empty() ? start : Vec2(low.cwiseMin(start));
      high = page.versions().empty() ? start : Vec2(high.cwiseMax(start));
      page.versions().push_back(encode(version));
    }
  }
  page.min_x_m(low.x());
  page.min_y_m(low.y());
  page.max_x_m(high.x());
  page.max_y_m(high.y());
}

}  // namespace

std::vector<msg::LedgerPage> ledger_pages(const Ledger& ledger, Epoch epoch) {
  std::vector<PlacedRobot> robots;
  robots.reserve(ledger.roster().size());
  for (const RobotId robot : ledger.roster()) {
    const auto versions = ledger.versions(robot);
    robots.push_back(
        {versions, versions.empty() ? Vec2(0, 0) : versions.front().trajectory.at_start().position_m});
  }
  sort_into_tiles(robots);
  // The number of pages depends on the roster only, so every page that was ever published is overwritten.
  std::vector<msg::LedgerPage> pages(pages_for(robots.size()));
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const std::size_t begin = i * kRobotsPerPage;
    pages[i].page_index(static_cast<std::uint32_t>(i));
    pages[i].page_count(static_cast<std::uint32_t>(pages.size()));
    pages[i].epoch(epoch);
    fill(pages[i], std::span(robots).subspan(begin, std::min(kRobotsPerPage, robots.size() - begin)));
  }
  return pages;
}

}  // namespace sidestep
