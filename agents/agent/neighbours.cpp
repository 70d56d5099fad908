// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/neighbours.hpp"

#include <algorithm>

#include "common/messaging/codec.hpp"

namespace sidestep {

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
  if (!page.versions.empty()) is_gathered_ = false;
  page.versions.clear();
  for (const msg::Version& entry : message.versions()) {
    const Vec2 offset(entry.x_m() - here.x(), entry.y_m() - here.y());
    if (entry.robot() == self_ || offset.squaredNorm() > horizon * horizon) continue;
    if (const auto version = decode(entry)) {
      page.versions.push_back(*version);
    } else {
      ++invalid_;
    }
  }
  if (!page.versions.empty()) is_gathered_ = false;
}

std::span<const Version> Neighbours::versions() {
  if (!is_gathered_) {
    versions_.clear();
    for (const Page& p : pages_) versions_.insert(versions_.end(), p.versions.begin(), p.versions.end());
    is_gathered_ = true;
  }
  return versions_;
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

std::vector<Vec2> Neighbours::standing(Time since, const Vec2& here, std::size_t most) {
  std::vector<const Version*> found;
  for (const Version& version : versions()) {
    if (version.trajectory.end() > since) continue;
    const auto moves = [&](const Version& other) {
      return other.robot == version.robot && other.trajectory.end() > since;
    };
    if (std::ranges::none_of(versions(), moves)) found.push_back(&version);
  }
  const auto distance = [&](const Version* v) {
    return (v->trajectory.rest_position_m() - here).squaredNorm();
  };
  std::ranges::sort(found, {}, distance);
  if (found.size() > most) found.resize(most);
  std::ranges::sort(found, {}, &Version::robot);
  std::vector<Vec2> places;
  for (const Version* version : found) places.push_back(version->trajectory.rest_position_m());
  return places;
}

}  // namespace sidestep
