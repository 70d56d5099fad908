// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "agents/agent/ledger_view.hpp"
#include "common/geometry/box.hpp"
#include "common/messaging/attachment.hpp"

namespace sidestep {

/// A page of the ledger that has arrived. Its header is decoded and checked. Its versions are decoded on
/// demand, because most pages are out of an agent's range. Valid as long as the message.
class ReceivedPage {
 public:
  /// Returns nullopt if the untrusted page is not from a coordinator, its index is out of range, or its epoch
  /// is implausible at `now`. `attachment`, if not null, is the slot in which all readers of the message
  /// share their decoded view of it.
  [[nodiscard]] static std::optional<ReceivedPage> decode(const msg::LedgerPage& message, Time now,
                                                          MessageAttachment* attachment = nullptr);

  /// Below kMaxRobots.
  std::uint32_t index() const { return index_; }
  Epoch epoch() const { return epoch_; }
  /// Orders the messages of one epoch.
  std::uint64_t number() const { return number_; }
  /// Contains the start positions of the page's versions, by the coordinator's statement. Not checked: may be
  /// wrong, or NaN.
  const Box& bounds_m() const { return bounds_m_; }

  /// Replaces a view by this page's: the shared one if there is one. Otherwise decodes the page, and reuses
  /// the old view's memory if it has no other readers.
  void update(std::shared_ptr<LedgerView>& view) const;

 private:
  ReceivedPage(const msg::LedgerPage& message, MessageAttachment* attachment);

  std::uint32_t index_;
  Epoch epoch_;
  std::uint64_t number_;
  Box bounds_m_;
  const msg::LedgerPage* message_;
  MessageAttachment* attachment_;
};

}  // namespace sidestep
