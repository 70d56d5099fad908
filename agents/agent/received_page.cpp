// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/received_page.hpp"

#include <utility>

#include "common/protocol/senders.hpp"

namespace sidestep {

ReceivedPage::ReceivedPage(const msg::LedgerPage& message, MessageAttachment* attachment)
    : index_(message.page_index()),
      epoch_(message.epoch()),
      number_(message.header().message_number()),
      bounds_m_{{message.min_x_m(), message.min_y_m()}, {message.max_x_m(), message.max_y_m()}},
      message_(&message),
      attachment_(attachment) {}

std::optional<ReceivedPage> ReceivedPage::decode(const msg::LedgerPage& message, Time now,
                                                 MessageAttachment* attachment) {
  const bool is_valid = is_coordinator(message.header().sender()) && message.page_index() < kMaxRobots &&
                        is_plausible(message.epoch(), now);
  if (!is_valid) return std::nullopt;
  return ReceivedPage(message, attachment);
}

void ReceivedPage::update(std::shared_ptr<DecodedLedgerPage>& decoded) const {
  if (attachment_) {
    if (auto shared = attachment_->get<DecodedLedgerPage>()) {
      decoded = std::move(shared);
      return;
    }
  }
  if (!decoded || decoded.use_count() > 1) decoded = std::make_shared<DecodedLedgerPage>();
  decoded->assign(*message_);
  if (attachment_) attachment_->set(decoded);
}

}  // namespace sidestep
