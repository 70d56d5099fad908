// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "agents/agent/decoded_ledger_page.hpp"
#include "common/geometry/box.hpp"
#include "common/messaging/attachment.hpp"

namespace sidestep {

/// A received page of the ledger. Its header is decoded and checked. Its versions are decoded on demand,
/// because most pages are out of an agent's range. Valid while the message exists.
class ReceivedPage {
 public:
  /// Returns nullopt if the untrusted page is not from a coordinator, its index is out of range, or its epoch
  /// is implausible at `now`. `attachment`, if not null, is the slot in which all readers of the message
  /// share one decoded copy of it.
  [[nodiscard]] static std::optional<ReceivedPage> decode(const msg::LedgerPage& message, Time now,
                                                          MessageAttachment* attachment = nullptr);

  /// At most kMaxRobots - 1.
  std::uint32_t index() const { return index_; }
  Epoch epoch() const { return epoch_; }
  /// Increases with each message of an epoch.
  std::uint64_t number() const { return number_; }
  /// Bounding box of the start positions of the page's versions, as the coordinator states it. Not checked:
  /// it may be wrong or NaN.
  const Box& bounds_m() const { return bounds_m_; }

  /// Replaces `decoded` with the decoded form of this page. Uses the shared copy if it exists. Otherwise
  /// decodes the page, in the memory of the old `decoded` if that has no other readers.
  void update(std::shared_ptr<DecodedLedgerPage>& decoded) const;

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
