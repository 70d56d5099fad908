// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/neighbours.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {
namespace {

constexpr std::uint32_t kCounted = 64;  // pages in in_use_

/// Whether everything on the page begins farther away than the horizon, as far as it says. The coordinator
/// has the last word, so a page that does not tell the truth costs no more than a denial.
bool is_far(const msg::LedgerPage& page, const Vec2& here, double horizon) {
  return page.low_x_m() - here.x() > horizon || here.x() - page.high_x_m() > horizon ||
         page.low_y_m() - here.y() > horizon || here.y() - page.high_y_m() > horizon;
}

/// The readers' common view if there is one, or made in the place of the old one where nobody else reads
/// that.
void look_at(const msg::LedgerPage& page, std::shared_ptr<LedgerView>& view, std::shared_ptr<void>* beside) {
  if (beside && *beside) {
    view = std::static_pointer_cast<LedgerView>(*beside);
    return;
  }
  if (!view || view.use_count() > 1) view = std::make_shared<LedgerView>();
  view->assign(page);
  if (beside) *beside = view;
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

void Neighbours::on_page(const msg::LedgerPage& message, std::shared_ptr<void>* beside) {
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
  take(message, page, beside);
  if (index >= kCounted) return;
  const std::uint64_t bit = std::uint64_t{1} << index;
  in_use_ = page.held.empty() ? in_use_ & ~bit : in_use_ | bit;
}

void Neighbours::take(const msg::LedgerPage& message, Page& page, std::shared_ptr<void>* beside) {
  page.held.clear();
  if (is_far(message, here_m_, horizon_m_)) return;
  look_at(message, page.view, beside);
  const auto& entries = page.view->entries;
  for (std::uint32_t i = 0; i < entries.size(); ++i) {
    const LedgerView::Entry& entry = entries[i];
    if (entry.robot == self_ || (entry.place_m - here_m_).squaredNorm() > horizon_m_ * horizon_m_) continue;
    if (entry.is_sound)
      page.held.push_back(i);
    else
      ++invalid_;
  }
}

void Neighbours::gather(const Vec2& here, double horizon, TrajectoryIndex& crowd) const {
  crowd.clear();
  for (const Page& page : pages_) {
    for (const std::uint32_t i : page.held) {
      const LedgerView& view = *page.view;
      if ((view.entries[i].place_m - here).squaredNorm() <= horizon * horizon)
        crowd.add(view.versions[i], view.outlines[i]);
    }
  }
}

std::span<const Version* const> Neighbours::newest(const Vec2& here, double horizon) {
  newest_.clear();
  for (const Page& page : pages_) {
    for (const std::uint32_t i : page.held) {
      if ((page.view->entries[i].place_m - here).squaredNorm() > horizon * horizon) continue;
      const Version& version = page.view->versions[i];
      // A page has a robot's versions side by side.
      const bool is_another = newest_.empty() || newest_.back()->robot != version.robot;
      if (is_another)
        newest_.push_back(&version);
      else if (version.number > newest_.back()->number)
        newest_.back() = &version;
    }
  }
  return newest_;
}

std::span<const Vec2> Neighbours::standing(Time since, const Vec2& here, std::size_t most) {
  standing_.clear();
  for (const Page& page : pages_) {
    for (const std::uint32_t i : page.held) {
      const Version& version = page.view->versions[i];
      if (page.view->ends[i] > since || moves(version.robot, since)) continue;
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
    return std::ranges::any_of(page.held, [&](std::uint32_t i) {
      return page.view->entries[i].robot == robot && page.view->ends[i] > since;
    });
  });
}

}  // namespace sidestep
