// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/neighbours.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {
namespace {

constexpr std::uint32_t kTrackedPages = 64;  // bits of nonempty_pages_

/// Whether the page's bounding rectangle is beyond the horizon. A wrong rectangle can only cost a denial,
/// because the coordinator decides.
bool is_far(const msg::LedgerPage& page, const Vec2& centre, double horizon) {
  return page.min_x_m() - centre.x() > horizon || centre.x() - page.max_x_m() > horizon ||
         page.min_y_m() - centre.y() > horizon || centre.y() - page.max_y_m() > horizon;
}

/// Adopts the view in the attachment if it holds one. Otherwise decodes the page, reusing the old view's
/// memory if it has no other readers.
void update_view(const msg::LedgerPage& page, std::shared_ptr<LedgerView>& view,
                 MessageAttachment* attachment) {
  if (attachment) {
    if (auto shared = attachment->get<LedgerView>()) {
      view = std::move(shared);
      return;
    }
  }
  if (!view || view.use_count() > 1) view = std::make_shared<LedgerView>();
  view->assign(page);
  if (attachment) attachment->set(view);
}

}  // namespace

void Neighbours::set_horizon(const Vec2& centre, double horizon) {
  centre_m_ = centre;
  horizon_m_ = horizon;
}

bool Neighbours::can_skip(const msg::LedgerPage& page) const {
  const std::uint32_t index = page.page_index();
  return index < kTrackedPages && (nonempty_pages_ >> index & 1) == 0 && is_far(page, centre_m_, horizon_m_);
}

void Neighbours::on_page(const msg::LedgerPage& message, MessageAttachment* attachment) {
  if (can_skip(message)) return;
  const std::uint32_t index = message.page_index();
  if (index >= kMaxRobots || message.epoch() > kMaxEpoch) {
    ++invalid_;
    return;
  }
  if (pages_.size() <= index) pages_.resize(index + 1);
  Page& page = pages_[index];
  const bool is_older = message.epoch() < page.epoch ||
                        (message.epoch() == page.epoch && message.header().message_number() <= page.number);
  if (is_older) return;
  page.epoch = message.epoch();
  page.number = message.header().message_number();
  store(message, page, attachment);
  if (index >= kTrackedPages) return;
  const std::uint64_t bit = std::uint64_t{1} << index;
  nonempty_pages_ = page.nearby.empty() ? nonempty_pages_ & ~bit : nonempty_pages_ | bit;
}

void Neighbours::store(const msg::LedgerPage& message, Page& page, MessageAttachment* attachment) {
  page.nearby.clear();
  if (is_far(message, centre_m_, horizon_m_)) return;
  update_view(message, page.view, attachment);
  const auto& entries = page.view->entries;
  for (std::uint32_t i = 0; i < entries.size(); ++i) {
    const LedgerView::Entry& entry = entries[i];
    if (entry.robot == self_ || (entry.position_m - centre_m_).squaredNorm() > horizon_m_ * horizon_m_)
      continue;
    if (entry.is_valid)
      page.nearby.push_back(i);
    else
      ++invalid_;
  }
}

void Neighbours::collect(const Vec2& centre, double horizon, TrajectoryIndex& index) const {
  index.clear();
  for (const Page& page : pages_) {
    for (const std::uint32_t i : page.nearby) {
      const LedgerView& view = *page.view;
      if ((view.entries[i].position_m - centre).squaredNorm() <= horizon * horizon)
        index.add(view.versions[i], view.bounds[i]);
    }
  }
}

std::span<const Version* const> Neighbours::newest(const Vec2& centre, double horizon) {
  newest_.clear();
  for (const Page& page : pages_) {
    for (const std::uint32_t i : page.nearby) {
      if ((page.view->entries[i].position_m - centre).squaredNorm() > horizon * horizon) continue;
      const Version& version = page.view->versions[i];
      // Versions of one robot are adjacent on a page.
      const bool is_new_robot = newest_.empty() || newest_.back()->robot != version.robot;
      if (is_new_robot)
        newest_.push_back(&version);
      else if (version.number > newest_.back()->number)
        newest_.back() = &version;
    }
  }
  return newest_;
}

std::span<const Vec2> Neighbours::find_stationary(Time since, const Vec2& centre, std::size_t max_count) {
  stationary_.clear();
  for (const Page& page : pages_) {
    for (const std::uint32_t i : page.nearby) {
      const Version& version = page.view->versions[i];
      if (page.view->ends[i] > since || is_moving(version.robot, since)) continue;
      const Vec2 position = version.trajectory.rest_position_m();
      stationary_.push_back({version.robot, position, (position - centre).squaredNorm()});
    }
  }
  std::ranges::sort(stationary_, {}, [](const Stationary& s) { return std::pair(s.distance2, s.robot); });
  if (stationary_.size() > max_count) stationary_.resize(max_count);
  std::ranges::sort(stationary_, {}, [](const Stationary& s) { return std::pair(s.robot, s.distance2); });
  positions_.clear();
  for (const Stationary& robot : stationary_) positions_.push_back(robot.position_m);
  return positions_;
}

bool Neighbours::is_moving(RobotId robot, Time since) const {
  return std::ranges::any_of(pages_, [=](const Page& page) {
    return std::ranges::any_of(page.nearby, [&](std::uint32_t i) {
      return page.view->entries[i].robot == robot && page.view->ends[i] > since;
    });
  });
}

}  // namespace sidestep
