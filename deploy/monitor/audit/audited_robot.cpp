// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/audit/audited_robot.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace sidestep {

void EpochMemory::add(Epoch epoch) {
  if (epoch == 0 || holds(epoch)) return;
  given_up_ = std::max(given_up_, std::min(epoch, epochs_.back()));
  epochs_.back() = std::max(epoch, epochs_.back());
  std::ranges::sort(epochs_, std::greater<>());
}

bool EpochMemory::holds(Epoch epoch) const {
  return epoch != 0 && std::ranges::find(epochs_, epoch) != epochs_.end();
}

bool Known::is_in(Epoch epoch) const {
  return epoch != 0 && (granted_in == epoch || (!is_own && registered_in.holds(epoch)));
}

bool Known::may_be_in(Epoch epoch) const {
  return is_in(epoch) || (!is_own && registered_in.may_have_held(epoch));
}

const msg::Version* HeardProposal::find(VersionNumber version) const {
  for (std::size_t i = 0; i < count; ++i) {
    if (candidates[i].version_number() == version) return &candidates[i];
  }
  return nullptr;
}

const Known* AuditedRobot::find(VersionNumber number) const {
  for (auto at = versions.rbegin(); at != versions.rend() && at->number >= number; ++at) {
    if (at->number == number) return &*at;
  }
  return nullptr;
}

const Known* AuditedRobot::find_near(std::size_t index, VersionNumber number) const {
  // Since then older ones have gone, and newer ones come.
  if (index < versions.size()) {
    while (index > 0 && versions[index].number > number) --index;
    if (versions[index].number == number) return &versions[index];
  }
  return find(number);
}

Known* AuditedRobot::find(VersionNumber number) {
  return const_cast<Known*>(static_cast<const AuditedRobot*>(this)->find(number));
}

Known& AuditedRobot::note(VersionNumber number) {
  if (Known* known = find(number)) return *known;
  if (versions.size() >= kMostVersions) {
    const auto is_gone = [](const Known& known) { return known.excluded != Excluded::kNo; };
    const auto gone = std::ranges::find_if(versions, is_gone);
    const auto given_up = gone == versions.end() ? versions.begin() : gone;
    given_up_version = std::max(given_up_version, given_up->number);
    if (given_up - versions.begin() < static_cast<std::ptrdiff_t>(first_recent)) --first_recent;
    versions.erase(given_up);
  }
  auto place = versions.end();
  while (place != versions.begin() && std::prev(place)->number > number) --place;
  place = versions.emplace(place);
  first_recent = std::min(first_recent, static_cast<std::size_t>(place - versions.begin()));
  place->number = number;
  return *place;
}

HeardProposal* AuditedRobot::proposal(std::uint64_t number, VersionNumber candidate) {
  const std::size_t count = std::min<std::size_t>(proposal_count, kMostProposals);
  for (std::size_t back = 1; back <= count; ++back) {
    HeardProposal& heard = proposals[(proposal_count - back) % kMostProposals];
    if (number != 0 ? heard.number == number : heard.find(candidate) != nullptr) return &heard;
  }
  return nullptr;
}

void AuditedRobot::forget(std::int64_t before_ns) {
  if (versions.empty() || versions.front().excluded_ns >= before_ns) return;
  std::erase_if(versions, [&](const Known& known) {
    if (known.excluded_ns >= before_ns) return false;
    given_up_version = std::max(given_up_version, known.number);
    return true;
  });
  first_recent = 0;
}

void AuditedRobot::age(std::int64_t since_ns) {
  while (first_recent < versions.size() && versions[first_recent].excluded_ns < since_ns) ++first_recent;
}

void AuditedRobot::make_recent(VersionNumber number) {
  while (first_recent > 0 && versions[first_recent - 1].number >= number) --first_recent;
}

HeardProposal& AuditedRobot::new_proposal() {
  HeardProposal& heard = proposals[proposal_count++ % kMostProposals];
  given_up_proposal = std::max(given_up_proposal, heard.number);
  heard = HeardProposal();
  return heard;
}

void AuditedRobot::start_again() {
  const RobotId same = id;
  *this = AuditedRobot();
  id = same;
}

Excluded excluded_by(const AuditedRobot::Fact& fact, const Known& version) {
  if (fact.is_lifted && fact.executing == 0) {
    // Nothing but a place to stand, granted and not yet taken, outlasts being lifted.
    const bool is_stand = version.has_content && version.version.base() == 0 && version.number != 0 &&
                          version.path.reach_m() == 0 && !version.was_executed &&
                          version.path.start_ns() > fact.at_ns;
    return is_stand ? Excluded::kNo : Excluded::kLifted;
  }
  if (version.number < fact.executing) return Excluded::kOlder;
  if (version.number == fact.executing || !version.has_content) return Excluded::kNo;
  if (version.path.start_ns() <= fact.at_ns) return Excluded::kLate;
  // The firmware drops what it holds of agents that it does not obey any more.
  if (version.version.incarnation() < fact.obeyed) return Excluded::kFenced;
  return Excluded::kNo;
}

void Whereabouts::add(const Live& version) {
  if (reach_m < 0) {
    *this = {version.x, version.y, version.reach_m};
  } else {
    const double dx = version.x - x, dy = version.y - y;
    reach_m = std::max(reach_m, std::sqrt(dx * dx + dy * dy) + version.reach_m);
  }
}

Whereabouts look_at(const AuditedRobot& robot, std::vector<Live>& live) {
  live.clear();
  Whereabouts all;
  for (std::size_t i = robot.first_recent; i < robot.versions.size(); ++i) {
    const Known& known = robot.versions[i];
    if (!known.has_content) continue;
    const auto& first = known.path.first();
    live.push_back({first.x, first.y, known.path.reach_m(), known.path.start_ns(), known.executed_until_ns,
                    known.granted_in == 0 ? kAlways : known.granted_by_ns, static_cast<std::uint32_t>(i),
                    known.number});
    all.add(live.back());
  }
  return all;
}

}  // namespace sidestep
