// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/neighbours.hpp"

#include <algorithm>
#include <utility>

#include "common/messaging/codec.hpp"

namespace sidestep {
namespace {

/// Whether everything on the page begins farther away than the horizon, as far as it says. The coordinator
/// has the last word, so a page that does not tell the truth costs no more than a denial.
bool is_far(const msg::LedgerPage& page, const Vec2& here, double horizon) {
  return page.low_x_m() - here.x() > horizon || here.x() - page.high_x_m() > horizon ||
         page.low_y_m() - here.y() > horizon || here.y() - page.high_y_m() > horizon;
}

}  // namespace

void Neighbours::on_page(const msg::LedgerPage& message, const Vec2& here, double horizon) {
  if (message.page_index() >= kMaxRobots || message.epoch() > kHighestEpoch) {
    ++invalid_;
    return;
  }
  if (pages_.size() <= message.page_index()) pages_.resize(message.page_index() + 1);
  Page& page = pages_[message.page_index()];
  const bool older = message.epoch() < page.epoch ||
                     (message.epoch() == page.epoch && message.head().message_number() <= page.number);
  if (older) return;
  page.epoch = message.epoch();
  page.number = message.head().message_number();
  page.versions.clear();
  if (is_far(message, here, horizon)) return;
  for (const msg::Version& entry : message.versions()) {
    const Vec2 offset(entry.x_m() - here.x(), entry.y_m() - here.y());
    if (entry.robot() == self_ || offset.squaredNorm() > horizon * horizon) continue;
    if (const auto version = decode(entry)) {
      page.versions.push_back(*version);
    } else {
      ++invalid_;
    }
  }
}

Crowd& Neighbours::crowd(const Vec2& here, double horizon) {
  crowd_.clear();
  for (const Page& page : pages_) {
    for (const Version& version : page.versions) {
      const Vec2 offset = version.trajectory.at_start().position_m - here;
      if (offset.squaredNorm() <= horizon * horizon) crowd_.add(version);
    }
  }
  return crowd_;
}

std::span<const Vec2> Neighbours::standing(Time since, const Vec2& here, std::size_t most) {
  standing_.clear();
  for (const Page& page : pages_) {
    for (const Version& version : page.versions) {
      if (version.trajectory.end() > since || moves(version.robot, since)) continue;
      const Vec2 place = version.trajectory.rest_position_m();
      standing_.push_back({version.robot, place, (place - here).squaredNorm()});
    }
  }
  std::ranges::sort(standing_, {}, [](const Stand& s) { return std::pair(s.distance2, s.robot); });
  if (standing_.size() > most) standing_.resize(most);
  std::ranges::sort(standing_, {}, [](const Stand& s) { return std::pair(s.robot, s.distance2); });
  places_.clear();
  for (const Stand& stand : standing_) places_.push_back(stand.place_m);
  return places_;
}

bool Neighbours::moves(RobotId robot, Time since) const {
  return std::ranges::any_of(pages_, [=](const Page& page) {
    return std::ranges::any_of(page.versions, [=](const Version& version) {
      return version.robot == robot && version.trajectory.end() > since;
    });
  });
}

}  // namespace sidestep
