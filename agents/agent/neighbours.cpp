// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/neighbours.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {
namespace {

constexpr std::uint32_t kTrackedPages = 64;  // bits of nonempty_pages_

/// Whether the page's bounding rectangle is beyond the horizon. A wrong rectangle can only cost a denial,
/// because the coordinator decides.
bool is_far(const Box& bounds, const Vec2& centre, double horizon) {
  return bounds.min_m.x() - centre.x() > horizon || centre.x() - bounds.max_m.x() > horizon ||
         bounds.min_m.y() - centre.y() > horizon || centre.y() - bounds.max_m.y() > horizon;
}

}  // namespace

void Neighbours::set_horizon(const Vec2& centre, double horizon) {
  centre_m_ = centre;
  horizon_m_ = horizon;
}

void Neighbours::count_drops(DropCounters& drops) const {
  drops.count(DropReason::kMalformedVersion, std::nullopt, invalid_);
  drops.count(DropReason::kLatePage, std::nullopt, late_);
}

bool Neighbours::can_skip(const ReceivedPage& received) const {
  const std::uint32_t index = received.index();
  return index < kTrackedPages && (nonempty_pages_ >> index & 1) == 0 &&
         is_far(received.bounds_m(), centre_m_, horizon_m_);
}

void Neighbours::on_page(const ReceivedPage& received) {
  if (can_skip(received)) return;
  const std::uint32_t index = received.index();
  if (pages_.size() <= index) pages_.resize(index + 1);
  Page& page = pages_[index];
  const bool is_older =
      received.epoch() < page.epoch || (received.epoch() == page.epoch && received.number() <= page.number);
  if (is_older) {
    ++late_;
    return;
  }
  page.epoch = received.epoch();
  page.number = received.number();
  store(received, page);
  if (index >= kTrackedPages) return;
  const std::uint64_t bit = std::uint64_t{1} << index;
  nonempty_pages_ = page.nearby.empty() ? nonempty_pages_ & ~bit : nonempty_pages_ | bit;
}

void Neighbours::store(const ReceivedPage& received, Page& page) {
  page.nearby.clear();
  if (remembered_.empty() && is_far(received.bounds_m(), centre_m_, horizon_m_)) return;
  received.update(page.decoded);
  const auto& entries = page.decoded->entries;
  for (std::uint32_t i = 0; i < entries.size(); ++i) {
    const DecodedLedgerPage::Entry& entry = entries[i];
    const bool is_near = (entry.position_m - centre_m_).squaredNorm() <= horizon_m_ * horizon_m_;
    if (entry.robot == self_ || !(is_near || is_remembered(entry.robot))) continue;
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
      const DecodedLedgerPage& decoded = *page.decoded;
      if ((decoded.entries[i].position_m - centre).squaredNorm() <= horizon * horizon)
        index.add(decoded.versions[i], decoded.bounds[i]);
    }
  }
}

std::span<const Version* const> Neighbours::newest(const Vec2& centre, double horizon) {
  newest_.clear();
  for (const Page& page : pages_) {
    for (const std::uint32_t i : page.nearby) {
      if ((page.decoded->entries[i].position_m - centre).squaredNorm() > horizon * horizon) continue;
      const Version& version = page.decoded->versions[i];
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

std::span<const Neighbours::Stationary> Neighbours::find_stationary(Time since, const Vec2& centre,
                                                                    std::size_t max_count) {
  stationary_.clear();
  for (const Page& page : pages_) {
    for (const std::uint32_t i : page.nearby) {
      const Version& version = page.decoded->versions[i];
      if (page.decoded->ends[i] > since || is_moving(version.robot, since)) continue;
      stationary_.push_back(
          {version.robot, version.trajectory.rest_position_m(), version.intent ? &*version.intent : nullptr});
    }
  }
  const auto distance2 = [&](const Stationary& s) { return (s.position_m - centre).squaredNorm(); };
  std::ranges::sort(stationary_, {}, [&](const Stationary& s) { return std::pair(distance2(s), s.robot); });
  if (stationary_.size() > max_count) stationary_.resize(max_count);
  std::ranges::sort(stationary_, {}, [&](const Stationary& s) { return std::pair(s.robot, distance2(s)); });
  remembered_.clear();
  for (const Stationary& found : stationary_) remembered_.push_back(found.robot);
  return stationary_;
}

bool Neighbours::is_remembered(RobotId robot) const {
  return std::ranges::find(remembered_, robot) != remembered_.end();
}

bool Neighbours::is_moving(RobotId robot, Time since) const {
  return std::ranges::any_of(pages_, [=](const Page& page) {
    return std::ranges::any_of(page.nearby, [&](std::uint32_t i) {
      return page.decoded->entries[i].robot == robot && page.decoded->ends[i] > since;
    });
  });
}

}  // namespace sidestep
