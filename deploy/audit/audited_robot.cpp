// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/audited_robot.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace sidestep {
namespace {

/// The robot's latest known proposal for which `matches` is true; nullptr if there is none.
template <typename Robot, typename Matches>
auto last_proposal(Robot& robot, Matches matches) -> decltype(&robot.proposals[0]) {
  constexpr std::size_t kMax = AuditedRobot::kMaxProposals;
  const std::size_t count = std::min<std::size_t>(robot.proposal_count, kMax);
  for (std::size_t back = 1; back <= count; ++back) {
    auto& record = robot.proposals[(robot.proposal_count - back) % kMax];
    if (matches(record)) return &record;
  }
  return nullptr;
}

}  // namespace

void EpochMemory::add(Epoch epoch) {
  if (holds(epoch)) return;
  max_evicted_ = std::max(max_evicted_, std::min(epoch, epochs_.back()));
  epochs_.back() = std::max(epoch, epochs_.back());
  std::ranges::sort(epochs_, std::greater<>());
}

bool EpochMemory::holds(Epoch epoch) const {
  return epoch != 0 && std::ranges::find(epochs_, epoch) != epochs_.end();
}

bool KnownVersion::is_in(Epoch epoch) const {
  return epoch != 0 && (granted_in == epoch || (!is_own_stop && registered_in.holds(epoch)));
}

bool KnownVersion::may_be_in(Epoch epoch) const {
  return is_in(epoch) || (!is_own_stop && registered_in.may_have_held(epoch));
}

const msg::Version* ProposalRecord::find(VersionNumber version) const {
  for (std::size_t i = 0; i < count; ++i) {
    if (candidates[i].version_number() == version) return &candidates[i];
  }
  return nullptr;
}

const KnownVersion* AuditedRobot::find(VersionNumber number) const {
  for (auto version = versions.rbegin(); version != versions.rend() && version->number >= number; ++version) {
    if (version->number == number) return &*version;
  }
  return nullptr;
}

const KnownVersion* AuditedRobot::find_near(std::size_t index, VersionNumber number) const {
  // Older versions may have been removed and newer ones appended since the version was at this index.
  if (index < versions.size()) {
    while (index > 0 && versions[index].number > number) --index;
    if (versions[index].number == number) return &versions[index];
  }
  return find(number);
}

KnownVersion* AuditedRobot::find(VersionNumber number) {
  return const_cast<KnownVersion*>(static_cast<const AuditedRobot*>(this)->find(number));
}

KnownVersion& AuditedRobot::find_or_insert(VersionNumber number) {
  if (KnownVersion* known = find(number)) return *known;
  const bool may_be_incomplete = has_evicted_ && number <= max_evicted_version;
  if (versions.size() >= kMaxVersions) {
    const auto is_excluded = [](const KnownVersion& known) { return known.exclusion != Exclusion::kNone; };
    const auto excluded = std::ranges::find_if(versions, is_excluded);
    const auto evicted = excluded == versions.end() ? versions.begin() : excluded;
    note_evicted(*evicted);
    if (evicted - versions.begin() < static_cast<std::ptrdiff_t>(first_recent)) --first_recent;
    versions.erase(evicted);
  }
  auto place = versions.end();
  while (place != versions.begin() && std::prev(place)->number > number) --place;
  place = versions.emplace(place);
  first_recent = std::min(first_recent, static_cast<std::size_t>(place - versions.begin()));
  place->number = number;
  place->may_be_incomplete = may_be_incomplete;
  return *place;
}

bool AuditedRobot::was_evicted(VersionNumber number) const {
  const KnownVersion* known = find(number);
  return known ? known->may_be_incomplete : number <= max_evicted_version;
}

ProposalRecord* AuditedRobot::find_proposal(std::uint64_t number) {
  return last_proposal(*this, [number](const ProposalRecord& record) { return record.number == number; });
}

ProposalRecord* AuditedRobot::find_proposal(std::uint64_t number, std::int64_t stamp_ns) {
  return last_proposal(*this, [=](const ProposalRecord& record) {
    return record.number == number && record.stamp_ns == stamp_ns;
  });
}

const ProposalRecord* AuditedRobot::find_proposal_of(const msg::Version& candidate) const {
  return last_proposal(*this, [&candidate](const ProposalRecord& record) {
    const msg::Version* found = record.find(candidate.version_number());
    return found && found->incarnation() == candidate.incarnation();
  });
}

bool AuditedRobot::continues(VersionNumber from, VersionNumber to) const {
  for (const KnownVersion* step = find(to); step; step = find(step->version.base())) {
    if (step->number <= from) return step->number == from;
    if (!step->has_content || step->version.base() >= step->number) return false;
  }
  return false;
}

const KnownVersion* AuditedRobot::executed_at(VersionNumber latest, std::int64_t at_ns) const {
  const KnownVersion* executed = find(latest);
  while (executed && executed->has_content && executed->path.start_ns() > at_ns && executed->number != 0)
    executed = find(executed->version.base());
  return executed && executed->has_content ? executed : nullptr;
}

double AuditedRobot::distance_from_version_m(const Vec2& position_m, std::int64_t at_ns) const {
  const KnownVersion* const executed = last_report ? executed_at(last_report->executing, at_ns) : nullptr;
  if (!executed) return INFINITY;
  const AuditPath::Node place = executed->path.at_ns(at_ns);
  return std::hypot(position_m.x() - place.x, position_m.y() - place.y);
}

void AuditedRobot::ExecutedVersions::add(const KnownVersion& version, std::int64_t after_ns,
                                         std::int64_t until_ns) {
  const bool is_agent_kind = version.number != 0 && !version.is_own_stop;
  const std::int64_t start_ns = version.path.start_ns();
  if (!version.was_executed || !is_agent_kind || start_ns <= after_ns || start_ns > until_ns) return;
  ++all;
  traced += version.is_traced();
}

void AuditedRobot::note_evicted(const KnownVersion& version) {
  has_evicted_ = true;
  max_evicted_version = std::max(max_evicted_version, version.number);
  forgotten_.add(version, traceable_from_ns, kNever);
  forgotten_first_.add(version, traceable_from_ns - kMaxLead_ns, traceable_from_ns);
}

AuditedRobot::ExecutedVersions AuditedRobot::executed_versions() const {
  ExecutedVersions total = forgotten_;
  for (const KnownVersion& known : versions) total.add(known, traceable_from_ns, kNever);
  return total;
}

AuditedRobot::ExecutedVersions AuditedRobot::first_executed_versions() const {
  ExecutedVersions total = forgotten_first_;
  for (const KnownVersion& known : versions)
    total.add(known, traceable_from_ns - kMaxLead_ns, traceable_from_ns);
  return total;
}

void AuditedRobot::forget(std::int64_t before_ns) {
  if (versions.empty() || versions.front().excluded_ns >= before_ns) return;
  std::erase_if(versions, [&](const KnownVersion& known) {
    if (known.excluded_ns >= before_ns) return false;
    note_evicted(known);
    return true;
  });
  first_recent = 0;
}

void AuditedRobot::advance_recent(std::int64_t since_ns) {
  while (first_recent < versions.size() && versions[first_recent].excluded_ns < since_ns) ++first_recent;
}

void AuditedRobot::make_recent(VersionNumber number) {
  while (first_recent > 0 && versions[first_recent - 1].number >= number) --first_recent;
}

ProposalRecord& AuditedRobot::add_proposal() {
  ProposalRecord& record = proposals[proposal_count++ % kMaxProposals];
  max_evicted_proposal = std::max(max_evicted_proposal, record.number);
  record = ProposalRecord();
  return record;
}

void AuditedRobot::reset() {
  AuditedRobot kept;
  kept.id = id;
  kept.registered_in = registered_in;
  kept.attested_until = attested_until;
  kept.attested_in = attested_in;
  kept.forgotten_until_epoch = std::max(forgotten_until_epoch, registered ? registered->epoch : 0);
  kept.max_evicted_proposal = max_evicted_proposal;
  for (const ProposalRecord& record : proposals)
    kept.max_evicted_proposal = std::max(kept.max_evicted_proposal, record.number);
  kept.forgotten_ = executed_versions();
  kept.forgotten_first_ = first_executed_versions();
  *this = std::move(kept);
}

void AuditedRobot::forget_times() {
  if (last_report) last_report->at_ns = kAlways;
  drifted_since_ns = beyond_bound_since_ns = kNever;
  max_drift_m = 0;
  observation = {};
  for (KnownVersion& version : versions) {
    version.executed_until_ns = kAlways;
    // Undoes exclusions that relied on the robot's clock while it was ahead, because messages about the
    // version may arrive before the first report by the corrected clock.
    if (version.exclusion != Exclusion::kLate) continue;
    version.exclusion = Exclusion::kNone;
    version.excluded_ns = kNever;
  }
  first_recent = 0;
}

Exclusion exclusion_by(const AuditedRobot::ReceivedReport& robot_report, const KnownVersion& version) {
  if (robot_report.is_lifted && robot_report.executing == 0) {
    // A lifted robot can only execute a granted rest version that it has not yet executed, and versions that
    // continue this rest version after the robot has been put down.
    const bool is_later =
        version.has_content && !version.was_executed && version.path.start_ns() > robot_report.at_ns;
    const bool is_rest_version =
        is_later && version.version.base() == 0 && version.number != 0 && version.path.reach_m() == 0;
    const bool continues_later = is_later && version.version.base() > robot_report.last_executed;
    return is_rest_version || continues_later ? Exclusion::kNone : Exclusion::kLifted;
  }
  if (version.number < robot_report.executing) return Exclusion::kOlder;
  if (version.number == robot_report.executing || !version.has_content) return Exclusion::kNone;
  if (version.path.start_ns() <= robot_report.at_ns) return Exclusion::kLate;
  // The firmware drops the versions of agents that it no longer obeys.
  if (version.version.incarnation() < robot_report.obeyed_incarnation) return Exclusion::kFenced;
  return Exclusion::kNone;
}

void BoundingDisc::add(const LiveVersion& version) {
  if (reach_m < 0) {
    *this = {version.x, version.y, version.reach_m};
  } else {
    const double dx = version.x - x, dy = version.y - y;
    reach_m = std::max(reach_m, std::sqrt(dx * dx + dy * dy) + version.reach_m);
  }
}

BoundingDisc collect_live_versions(const AuditedRobot& robot, std::vector<LiveVersion>& live) {
  live.clear();
  BoundingDisc bounds;
  for (std::size_t i = robot.first_recent; i < robot.versions.size(); ++i) {
    const KnownVersion& known = robot.versions[i];
    if (!known.has_content) continue;
    const auto& first = known.path.first();
    live.push_back({first.x, first.y, known.path.reach_m(), known.path.start_ns(), known.executed_until_ns,
                    known.granted_in == 0 ? kAlways : known.granted_by_ns, static_cast<std::uint32_t>(i),
                    known.number});
    bounds.add(live.back());
  }
  return bounds;
}

}  // namespace sidestep
