// SPDX-License-Identifier: Apache-2.0
// What the coordinator may grant, and what its ledger holds.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "deploy/monitor/audit/auditor.hpp"

namespace sidestep {
namespace {

constexpr double kLength_m = 2e-6;    // a clearance a micrometre too small is rounding
constexpr double kContinuity = 1e-7;  // metres, and metres a second
constexpr double kSpeed_mps = 1e-5;
constexpr double kEffort = 2e-3;

/// How much of what a robot can do an acceleration takes: 1 is all. Ahead and sideways F, against the
/// velocity D.
double effort(const AuditPath::Node& n, const MotionLimits& limits) {
  const double f = limits.acceleration_mps2, d = limits.deceleration_mps2;
  const double speed = std::hypot(n.vx, n.vy), asked = std::hypot(n.ax, n.ay);
  if (speed < 1e-6) return asked / f;
  const double along = (n.ax * n.vx + n.ay * n.vy) / speed, across = (n.vx * n.ay - n.vy * n.ax) / speed;
  if (along >= 0) return asked / f;
  return std::sqrt(along * along / (d * d) + across * across / (f * f));
}

/// Whether a verdict says the last word about a candidate of its proposal that it does not grant.
bool is_final(const msg::Verdict& verdict) {
  if (verdict.granted() != 0) return true;
  switch (verdict.reasons().front()) {
    case msg::REASON_NOT_CONTINUOUS:
    case msg::REASON_BEYOND_LIMITS:
    case msg::REASON_NOT_AT_REST:
    case msg::REASON_OUTSIDE_FIELD:
    case msg::REASON_OBSTACLE:
    case msg::REASON_CONFLICT:
      return true;
    default:
      return false;  // a copy of the proposal that comes later may be granted
  }
}

}  // namespace

void Auditor::on_verdict(const msg::Verdict& verdict, Time now) {
  now_ = now;
  if (verdict.robot() >= index_.size() || index_[verdict.robot()] == robots_.size()) {
    ++totals_.invalid;
    return;
  }
  AuditedRobot& robot = robots_[index_[verdict.robot()]];
  const Heard heard = note(kVerdictKind, robot.id, verdict.head());
  if (verdict.proposal_number() == 0) return;
  HeardProposal* proposal = robot.proposal(verdict.proposal_number(), 0);
  if (!proposal && is_final(verdict)) {
    robot.early_verdicts[robot.early_verdict_count++ % robot.early_verdicts.size()] = {
        verdict.proposal_number(), verdict.epoch(), verdict.granted()};
  } else if (is_final(verdict)) {
    rule(robot, *proposal, verdict.epoch(), verdict.granted());
  }
  if (verdict.granted() == 0) return;
  const Known* before = robot.find(verdict.granted());
  // A coordinator that was held up answers a copy of an old proposal as it did before, when what it granted
  // has been given up here.
  if (robot.has_given_up(verdict.granted())) return;
  if (before && before->granted_in == verdict.epoch()) {
    robot.find(verdict.granted())->granted_by_ns = std::min(before->granted_by_ns, heard.latest_ns);
    return;
  }
  if (before && before->granted_in != 0 && !before->is_own && !before->is_granted_by_page) {
    report(AuditRule::kNumbers, robot.id, before, verdict.epoch(),
           fmt::format("was granted in epoch {} before", before->granted_in));
    return;
  }
  const msg::Version* candidate = proposal ? proposal->find(verdict.granted()) : nullptr;
  const bool was_never_proposed =
      how_.is_complete && !proposal && verdict.proposal_number() > robot.given_up_proposal;
  const bool is_wrong_epoch = candidate && proposal->epoch != verdict.epoch();
  if ((proposal && !candidate) || is_wrong_epoch || was_never_proposed) {
    Known& known = robot.note(verdict.granted());
    report(AuditRule::kProposed, robot.id, &known, verdict.epoch(),
           is_wrong_epoch ? fmt::format("epoch {} was asked", proposal->epoch)
                          : fmt::format("is no candidate of proposal {}", verdict.proposal_number()));
  }
  Known* known = candidate ? learn(robot, *candidate) : &robot.note(verdict.granted());
  if (!known) return;
  known->granted_in = verdict.epoch();
  known->granted_by_ns = heard.latest_ns;
  known->is_granted_by_page = false;
  judge_grant(robot, *known, verdict);
}

void Auditor::rule(AuditedRobot& robot, HeardProposal& proposal, Epoch epoch, VersionNumber granted) {
  if (proposal.epoch != epoch) return;
  proposal.is_ruled = true;
  proposal.granted = granted;
  for (std::size_t i = 0; i < proposal.count; ++i)
    judge_forwarded(robot, proposal.candidates[i].version_number());
}

void Auditor::judge_grant(AuditedRobot& robot, Known& known, const msg::Verdict& verdict) {
  judge_epoch(robot, known, verdict);
  if (how_.is_complete && robot.newest_granted_in == verdict.epoch() &&
      known.number <= robot.newest_granted) {
    report(AuditRule::kNumbers, robot.id, &known, verdict.epoch(),
           fmt::format("after version {} was granted", robot.newest_granted));
  }
  if (verdict.epoch() >= robot.newest_granted_in) {
    robot.newest_granted = verdict.epoch() > robot.newest_granted_in
                               ? known.number
                               : std::max(robot.newest_granted, known.number);
    robot.newest_granted_in = verdict.epoch();
  }
  if (!known.has_content) return;
  judge_content(robot, known);
  judge_new_pairs_of(robot, known);
}

void Auditor::judge_epoch(const AuditedRobot& robot, const Known& known, const msg::Verdict& verdict) {
  EpochRecord& record = epoch_record(verdict.epoch());
  const Incarnation life = verdict.head().incarnation();
  if (record.first_grant_ns == kNever) {
    record.granter = verdict.head().sender();
    record.granter_life = life;
    for (const AuditedRobot& other : robots_) {
      if (!how_.is_complete || other.registered_in.may_have_held(verdict.epoch())) continue;
      record.is_reported = true;
      report(
          AuditRule::kAllRegistered, other.id, nullptr, verdict.epoch(),
          fmt::format("has not registered when version {} of robot {} is granted", known.number, robot.id));
    }
  } else if (record.granter_life != life || record.granter != verdict.head().sender()) {
    report(AuditRule::kOneCoordinator, robot.id, &known, verdict.epoch(),
           fmt::format("coordinator {} of life {} grants, and {} of life {} did", verdict.head().sender(),
                       life, record.granter, record.granter_life));
  }
  record.first_grant_ns = std::min(record.first_grant_ns, known.granted_by_ns);
}

void Auditor::judge_content(const AuditedRobot& robot, const Known& known) {
  judge_limits(robot, known);
  judge_floor(robot, known);
  judge_base(robot, known);
}

void Auditor::judge_limits(const AuditedRobot& robot, const Known& known) {
  for (int i = 0; i <= known.path.phase_count(); ++i) {
    const AuditPath::Node& n = known.path.phase(i);
    const double speed = std::hypot(n.vx, n.vy);
    const bool lasts = i < known.path.phase_count() && known.path.phase(i + 1).after_s > n.after_s;
    if (speed > scenario_.limits.speed_mps + kSpeed_mps) {
      report(AuditRule::kLimits, robot.id, &known, known.granted_in,
             fmt::format("{:.6f} m/s at phase {}, {:.6f} allowed", speed, i, scenario_.limits.speed_mps));
    } else if (lasts && effort(n, scenario_.limits) > 1 + kEffort) {
      report(AuditRule::kLimits, robot.id, &known, known.granted_in,
             fmt::format("acceleration ({:.4f}, {:.4f}) m/s2 in phase {} is {:.4f} of what is allowed", n.ax,
                         n.ay, i, effort(n, scenario_.limits)));
    }
  }
  const AuditPath::Node& end = known.path.last();
  if (std::hypot(end.vx, end.vy) > kSpeed_mps) {
    report(AuditRule::kRest, robot.id, &known, known.granted_in,
           fmt::format("ends with {:.6f} m/s", std::hypot(end.vx, end.vy)));
  }
}

void Auditor::judge_floor(const AuditedRobot& robot, const Known& known) {
  const double room_x = scenario_.field.length_m / 2 - scenario_.radius_m + kLength_m;
  const double room_y = scenario_.field.width_m / 2 - scenario_.radius_m + kLength_m;
  const auto outside = [&](const AuditPath& path) {
    double most = 0;
    // Where a coordinate is largest it is at a phase's end or turns round.
    for (int i = 0; i <= path.phase_count(); ++i) {
      const AuditPath::Node& n = path.phase(i);
      for (const double turn : {0.0, n.ax != 0 ? -n.vx / n.ax : 0.0, n.ay != 0 ? -n.vy / n.ay : 0.0}) {
        const bool is_within =
            turn >= 0 && i < path.phase_count() && n.after_s + turn < path.phase(i + 1).after_s;
        const AuditPath::Node p = is_within ? path.at_s(n.after_s + turn) : n;
        most = std::max({most, std::abs(p.x) - room_x, std::abs(p.y) - room_y});
      }
    }
    return most;
  };
  // What was pushed over the edge may come back, in as many steps as it takes.
  const Known* base = robot.find(known.version.base());
  const double allowed = base && base->has_content ? std::max(0.0, outside(base->path) + kLength_m) : 0;
  if (const double most = outside(known.path); most > allowed) {
    report(AuditRule::kFloor, robot.id, &known, known.granted_in,
           fmt::format("{:.6f} m over the edge", most));
  }
  for (const Circle& obstacle : scenario_.obstacles) {
    const double keep = obstacle.radius_m + scenario_.radius_m + scenario_.margin_m + known.version.inflation_m();
    const double far = keep + known.path.reach_m();
    if (std::hypot(known.version.x_m() - obstacle.centre_m.x(), known.version.y_m() - obstacle.centre_m.y()) >
        far)
      continue;
    const Approach near = nearest(known.path, obstacle.centre_m.x(), obstacle.centre_m.y(), keep);
    if (near.distance_m >= keep - kLength_m - known.version.inflation_m()) continue;
    const bool was_near =
        base && base->has_content &&
        nearest(base->path, obstacle.centre_m.x(), obstacle.centre_m.y(), keep).distance_m <=
            near.distance_m + 1e-6;
    if (was_near) continue;
    report(AuditRule::kObstacle, robot.id, &known, known.granted_in,
           fmt::format("{:.6f} m from the centre of the obstacle at ({:.3f}, {:.3f}) m, {:.6f} m required",
                       near.distance_m, obstacle.centre_m.x(), obstacle.centre_m.y(), keep));
  }
}

void Auditor::judge_base(const AuditedRobot& robot, const Known& known) {
  const Known* base = robot.find(known.version.base());
  if (known.number <= known.version.base()) {
    report(AuditRule::kNumbers, robot.id, &known, known.granted_in,
           fmt::format("its base is {}", known.version.base()));
  }
  const bool is_stand = known.version.base() == 0 && known.path.reach_m() == 0;
  const bool is_absent =
      (robot.fact && robot.fact->is_lifted) || (robot.registered && robot.registered->is_absent);
  if (is_stand && is_absent) return;
  const bool is_given_up = robot.has_given_up(known.version.base());
  if (how_.is_complete && !is_given_up && !(base && (base->may_be_in(known.granted_in) || base->is_own))) {
    report(AuditRule::kBase, robot.id, &known, known.granted_in,
           fmt::format("its base {} was neither registered nor granted in the epoch", known.version.base()));
  }
  if (!base || !base->has_content) return;
  const AuditPath::Node& from = known.path.first();
  const AuditPath::Node there = base->path.at_ns(known.path.start_ns());
  const double jump_m = std::hypot(from.x - there.x, from.y - there.y);
  const double jump_mps = std::hypot(from.vx - there.vx, from.vy - there.vy);
  if (known.path.start_ns() <= base->path.start_ns() || !(jump_m <= kContinuity && jump_mps <= kContinuity)) {
    report(AuditRule::kContinuity, robot.id, &known, known.granted_in,
           fmt::format("{:.9f} m and {:.9f} m/s from its base {} at its start, {:.6f} s after that one's",
                       jump_m, jump_mps, base->number,
                       static_cast<double>(known.path.start_ns() - base->path.start_ns()) * 1e-9));
  }
  const bool begins_at_rest = from.vx == 0 && from.vy == 0 && known.version.inflation_m() == 0;
  if (known.version.inflation_m() != base->version.inflation_m() && !begins_at_rest) {
    report(AuditRule::kInflation, robot.id, &known, known.granted_in,
           fmt::format("grown by {:.6f} m, its base by {:.6f} m", known.version.inflation_m(),
                       base->version.inflation_m()));
  }
}

void Auditor::on_ledger(const msg::LedgerPage& page, Time now) {
  now_ = now;
  const Heard heard = note(kLedgerKind, 0, page.head());
  if (page.versions().size() > 256 || page.epoch() == 0) {
    ++totals_.invalid;
    return;
  }
  const auto granter = epochs_.find(page.epoch());
  const bool is_of_epoch =
      granter == epochs_.end() || granter->second.granter_life == page.head().incarnation();
  for (const msg::Version& version : page.versions()) {
    if (version.robot() >= index_.size() || index_[version.robot()] == robots_.size()) {
      ++totals_.invalid;
      continue;
    }
    AuditedRobot& robot = robots_[index_[version.robot()]];
    const Known* known = robot.find(version.version_number());
    // A coordinator that hears nothing keeps what was given up here long ago.
    if (robot.has_given_up(version.version_number())) continue;
    if (how_.is_complete && is_of_epoch && !(known && (known->may_be_in(page.epoch()) || known->is_own))) {
      report(AuditRule::kLedgerPage, robot.id, known ? known : &robot.note(version.version_number()),
             page.epoch(), "is in the ledger, and was neither registered nor granted");
    }
    Known* learnt = learn(robot, version);
    if (!learnt || learnt->is_in(page.epoch()) || learnt->granted_in != 0) continue;
    // What an agent has proposed or sent is not the robot's own; so its verdict was missed.
    const bool was_granted =
        !how_.is_complete && (learnt->sent_ns != kNever || robot.proposal(0, learnt->number) != nullptr);
    if (!learnt->is_own && !was_granted) continue;
    learnt->granted_in = page.epoch();
    learnt->granted_by_ns = heard.latest_ns;
    learnt->is_granted_by_page = true;
    if (!learnt->is_own) {
      judge_content(robot, *learnt);
      judge_new_pairs_of(robot, *learnt);
    }
  }
  if (is_of_epoch && how_.is_complete) judge_page(page);
}

void Auditor::judge_page(const msg::LedgerPage& page) {
  const auto& versions = page.versions();
  std::size_t begin = 0;
  while (begin < versions.size()) {
    std::size_t end = begin;
    page_numbers_.clear();
    for (; end < versions.size() && versions[end].robot() == versions[begin].robot(); ++end)
      page_numbers_.push_back(versions[end].version_number());
    const std::uint32_t id = versions[begin].robot();
    begin = end;
    if (id >= index_.size() || index_[id] == robots_.size()) continue;
    const AuditedRobot& robot = robots_[index_[id]];
    for (std::size_t i = robot.first_recent; i < robot.versions.size(); ++i) {
      const Known& known = robot.versions[i];
      // What it is was given up here before a coordinator that was held up granted it.
      if (!known.has_content) continue;
      if (known.excluded != Excluded::kNo || known.is_own || !known.is_in(page.epoch())) continue;
      if (std::ranges::find(page_numbers_, known.number) != page_numbers_.end()) continue;
      report(AuditRule::kLedgerPage, id, &known, page.epoch(),
             "is not in the ledger, although no fact has excluded it");
    }
  }
}

}  // namespace sidestep
