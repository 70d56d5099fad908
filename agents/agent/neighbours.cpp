// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/neighbours.hpp"

#include "common/messaging/codec.hpp"

namespace sidestep {

void Neighbours::on_page(const msg::LedgerPage& message, const Vec2& here, double horizon) {
  if (message.page_index() >= kMaxRobots) {
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
  for (const msg::Version& entry : message.versions()) {
    const Vec2 offset(entry.x_m() - here.x(), entry.y_m() - here.y());
    if (entry.robot() == self_ || offset.squaredNorm() > horizon * horizon) continue;
    if (const auto version = decode(entry)) {
      page.versions.push_back(*version);
    } else {
      ++invalid_;
    }
  }
  versions_.clear();
  for (const Page& p : pages_) versions_.insert(versions_.end(), p.versions.begin(), p.versions.end());
}

}  // namespace sidestep
