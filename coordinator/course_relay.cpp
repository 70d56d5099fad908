// SPDX-License-Identifier: Apache-2.0
#include "coordinator/course_relay.hpp"

#include <chrono>

#include "common/messaging/course_codec.hpp"
#include "coordinator/publish.hpp"

namespace sidestep {
namespace {

constexpr Duration kWindow{100'000'000};
/// Messages of two cycles more may arrive in a window if the network has delayed them.
constexpr std::int64_t kDelayedCycles = 2;
constexpr std::int64_t kOffersPerCycle = 4;

}  // namespace

CourseRelay::CourseRelay(Bus& bus, const CoordinatorIdentity& self, const Coordinator& coordinator,
                         Duration cycle)
    : bus_(bus),
      self_(self),
      coordinator_(coordinator),
      max_courses_(kWindow / cycle + kDelayedCycles),
      course_writer_(bus.advertise(topics::kSharedCourse)),
      offer_writer_(bus.advertise(topics::kSharedCourseOffer)) {
  // Only agents write these topics, so the bus refuses messages of coordinators, which the codec accepts.
  bus_.subscribe(topics::kCourse, [this](const msg::Course& message) { on_course(message); });
  bus_.subscribe(topics::kCourseOffer, [this](const msg::CourseOffer& message) { on_offer(message); });
}

CourseRelay::Sent& CourseRelay::sent_by(RobotId robot) {
  Sent& sent = sent_[robot];
  // A time in the future was recorded before the clock was set back.
  if (std::chrono::abs(bus_.now() - sent.since) >= kWindow) sent = {bus_.now(), 0, 0};
  return sent;
}

void CourseRelay::on_course(const msg::Course& message) {
  if (!coordinator_.is_granting()) return;
  const auto course = decode(message, bus_.now());
  if (!course) return drops_.count(DropReason::kMalformedCourse);
  if (!course->is_empty() && !course->is_about(bus_.now())) return drops_.count(DropReason::kMalformedCourse);
  if (!has_robot(course->robot)) return drops_.count(DropReason::kUnknownRobot);
  if (++sent_by(course->robot).courses > max_courses_) return drops_.count(DropReason::kFrequentCourse);
  msg::Course shared = encode(*course);
  publish(self_, course_writer_, shared, bus_.now());
}

void CourseRelay::on_offer(const msg::CourseOffer& message) {
  if (!coordinator_.is_granting()) return;
  const auto offer = decode(message, bus_.now());
  if (!offer) return drops_.count(DropReason::kMalformedCourseOffer);
  if (!offer->course.is_about(bus_.now())) return drops_.count(DropReason::kMalformedCourseOffer);
  if (!has_robot(offer->by) || !has_robot(offer->course.robot))
    return drops_.count(DropReason::kUnknownRobot);
  if (++sent_by(offer->by).offers > kOffersPerCycle * max_courses_)
    return drops_.count(DropReason::kFrequentCourse);
  msg::CourseOffer shared = encode(*offer);
  publish(self_, offer_writer_, shared, bus_.now());
}

}  // namespace sidestep
