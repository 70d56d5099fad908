// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/neighbours.hpp"

#include <algorithm>
#include <utility>

#include "common/messaging/codec.hpp"

namespace sidestep {
namespace {

constexpr std::uint32_t kCounted = 64;  // pages in in_use_

/// Whether everything on the page begins farther away than the horizon, as far as it says. The coordinator
/// has the last word, so a page that does not tell the truth costs no more than a denial.
bool is_far(const msg::LedgerPage& page, const Vec2& here, double horizon) {
  return page.low_x_m() - here.x() > horizon || here.x() - page.high_x_m() > horizon ||
         page.low_y_m() - here.y() > horizon || here.y() - page.high_y_m() > horizon;
}

}  // namespace

void Neighbours::look_about(const Vec2& here, double horizon) {
  here_m_ = here;
  horizon_m_ = horizon;
}

bool Neighbours::is_of_no_concern(const msg::LedgerPage& page) const {
  const std::uint32_t index = page.page_index();
  return index < kCounted && (in_use_ >> index & 1) == 0 && is_far(page, here_m_, horizon_m_);
}

void Neighbours::on_page(const msg::LedgerPage& message) {
  if (is_of_no_concern(message)) return;
  const std::uint32_t index = message.page_index();
  if (index >= kMaxRobots || message.epoch() > kHighestEpoch) {
    ++invalid_;
    return;
  }
  if (pages_.size() <= index) pages_.resize(index + 1);
  Page& page = pages_[index];
  const bool older = message.epoch() < page.epoch ||
                     (message.epoch() == page.epoch && message.head().message_number() <= page.number);
  if (older) return;
  page.epoch = message.epoch();
  page.number = message.head().message_number();
  take(message, page);
  if (index >= kCounted) return;
  const std::uint64_t bit = std::uint64_t{1} << index;
  in_use_ = page.versions.empty() ? in_use_ & ~bit : in_use_ | bit;
}

void Neighbours::take(const msg::LedgerPage& message, Page& page) {
  page.versions.clear();
  page.ends.clear();
  if (is_far(message, here_m_, horizon_m_)) return;
  for (const msg::Version& entry : message.versions()) {
    const Vec2 offset(entry.x_m() - here_m_.x(), entry.y_m() - here_m_.y());
    if (entry.robot() == self_ || offset.squaredNorm() > horizon_m_ * horizon_m_) continue;
    if (const auto version = decode(entry)) {
      page.versions.push_back(*version);
      page.ends.push_back(version->trajectory.end());
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
    for (std::size_t i = 0; i < page.ends.size(); ++i) {
      const Version& version = page.versions[i];
      if (page.ends[i] > since || moves(version.robot, since)) continue;
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
