// SPDX-License-Identifier: Apache-2.0
#include "coordinator/ledger_pages.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "common/messaging/codec.hpp"

namespace sidestep {
namespace {

struct Placed {
  std::span<const Version> versions;
  Vec2 place_m;
};

std::size_t pages_for(std::size_t robots) { return (robots + kRobotsPerPage - 1) / kRobotsPerPage; }

/// Into strips along y, as wide as makes their pages about square, one up and the next one down: so a page
/// that begins in one and ends in the next is no larger than the others.
void put_in_order(std::vector<Placed>& robots) {
  if (robots.size() <= kRobotsPerPage) return;
  const double pages = static_cast<double>(pages_for(robots.size()));
  const auto strips = static_cast<std::size_t>(std::ceil(std::sqrt(pages)));
  const std::size_t strip = (robots.size() + strips - 1) / strips;
  // Stable: equal places stay in the roster's order.
  std::ranges::stable_sort(robots, {}, [](const Placed& robot) { return robot.place_m.x(); });
  double up = 1;
  for (std::size_t i = 0; i < robots.size(); i += strip) {
    std::ranges::stable_sort(std::span(robots).subspan(i, std::min(strip, robots.size() - i)), {},
                             [up](const Placed& robot) { return up * robot.place_m.y(); });
    up = -up;
  }
}

void fill(msg::LedgerPage& page, std::span<const Placed> robots) {
  std::size_t count = 0;
  for (const Placed& robot : robots) count += robot.versions.size();
  page.versions().reserve(count);
  Vec2 low(0, 0), high(0, 0);
  for (const Placed& robot : robots) {
    for (const Version& version : robot.versions) {
      const Vec2& place = version.trajectory.at_start().position_m;
      low = page.versions().empty() ? place : Vec2(low.cwiseMin(place));
      high = page.versions().empty() ? place : Vec2(high.cwiseMax(place));
      page.versions().push_back(encode(version));
    }
  }
  page.low_x_m(low.x());
  page.low_y_m(low.y());
  page.high_x_m(high.x());
  page.high_y_m(high.y());
}

}  // namespace

std::vector<msg::LedgerPage> ledger_pages(const Ledger& ledger, Epoch epoch) {
  std::vector<Placed> robots;
  robots.reserve(ledger.roster().size());
  for (const RobotId robot : ledger.roster()) {
    const auto versions = ledger.versions(robot);
    robots.push_back(
        {versions, versions.empty() ? Vec2(0, 0) : versions.front().trajectory.at_start().position_m});
  }
  put_in_order(robots);
  // As many as the roster needs, however many versions there are: a page that was there once is written
  // again.
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
