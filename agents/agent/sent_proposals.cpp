// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/sent_proposals.hpp"

#include <algorithm>

namespace sidestep {
namespace {

constexpr int kMaxProposalsPerStart = 4;

}  // namespace

const Version* SentProposal::find(VersionNumber number) const {
  const std::span versions(candidates.data(), count);
  const auto found = std::ranges::find_if(versions, [&](const Version& v) { return v.number == number; });
  return found == versions.end() ? nullptr : &*found;
}

SentProposal& SentProposals::add(Time start, Time now, int lead) {
  const bool is_again = count_ > 0 && newest()->start() == start;
  attempts_ = is_again ? attempts_ + 1 : 1;
  SentProposal& sent = proposals_[count_++ % proposals_.size()];
  sent.count = 0;
  sent.proposed_at = now;
  sent.lead = lead;
  sent.is_answered = false;
  sent.is_open = true;
  return sent;
}

SentProposal* SentProposals::find_unanswered(VersionNumber number) {
  const auto found = std::ranges::find_if(
      proposals_, [=](const SentProposal& sent) { return !sent.is_answered && sent.number() == number; });
  return found == proposals_.end() ? nullptr : &*found;
}

const SentProposal* SentProposals::newest() const {
  return count_ == 0 ? nullptr : &proposals_[(count_ - 1) % proposals_.size()];
}

std::optional<Time> SentProposals::start_to_retry(Time now, Duration answer_timeout, Duration cycle) const {
  const SentProposal* const last = newest();
  const bool is_due = last && attempts_ < kMaxProposalsPerStart && last->is_open &&
                      now - last->proposed_at >= answer_timeout && last->start() - now > cycle;
  return is_due ? std::optional(last->start()) : std::nullopt;
}

bool SentProposals::has_upcoming(Time now) const {
  return std::ranges::any_of(proposals_, [=](const SentProposal& sent) {
    return sent.is_open && sent.start() > now && sent.start() <= now + HeldVersions::kMaxAhead;
  });
}

void SentProposals::close() {
  for (SentProposal& sent : proposals_) sent.is_open = false;
}

bool SentProposals::close_unreachable(const HeldVersions& held) {
  bool has_closed_any = false;
  for (SentProposal& sent : proposals_) {
    if (!sent.is_open || held.has_base(sent.candidates.front().base)) continue;
    sent.is_open = false;
    has_closed_any = true;
  }
  return has_closed_any;
}

int SentProposals::close_started(Time now) {
  int cycles = 0;
  for (SentProposal& sent : proposals_) {
    if (!sent.is_open || sent.start() > now) continue;
    sent.is_open = false;
    cycles = sent.lead;
  }
  return cycles;
}

void SentProposals::discard() {
  close();
  for (SentProposal& sent : proposals_) sent.is_answered = true;
}

}  // namespace sidestep
