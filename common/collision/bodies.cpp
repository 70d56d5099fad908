// SPDX-License-Identifier: Apache-2.0
#include "common/collision/bodies.hpp"

#include <limits>

namespace sidestep {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr collision::CircleRecord kNoCircle{1e18f, 1e18f, 0, 0};

bool touches_exactly(const void* bodies, Slot slot, const double* from_m, const double* to_m,
                     double radius_m) {
  return static_cast<const Bodies*>(bodies)->touches(
      slot, Sweep(Vec2(from_m[0], from_m[1]), Vec2(to_m[0], to_m[1]), radius_m));
}

}  // namespace

float rounded_down(double value) { return std::nextafter(static_cast<float>(value), -kInfinite); }
float rounded_up(double value) { return std::nextafter(static_cast<float>(value), kInfinite); }

Bodies::Bodies(std::vector<Shape> shapes) : circles_{kNoCircle} {
  if (shapes.empty()) return;
  Box box = bounds(shapes.front());
  for (const Shape& shape : shapes) box = around(box, bounds(shape));
  origin_m_ = 0.5 * box.min_m + 0.5 * box.max_m;
  for (Shape& shape : shapes) add(std::move(shape));
}

Slot Bodies::add(Shape shape) {
  Slot slot = end();
  if (free_.empty()) {
    shapes_.push_back(std::move(shape));
    places_.push_back(kNowhere);
    circles_.push_back(kNoCircle);
  } else {
    slot = free_.back();
    free_.pop_back();
    shapes_[slot] = std::move(shape);
  }
  places_[slot] = static_cast<std::uint32_t>(slots_.size());
  slots_.push_back(slot);
  record(slot);
  return slot;
}

void Bodies::replace(Slot slot, Shape shape) {
  shapes_[slot] = std::move(shape);
  record(slot);
}

void Bodies::remove(Slot slot) {
  places_[slots_.back()] = places_[slot];
  slots_[places_[slot]] = slots_.back();
  slots_.pop_back();
  places_[slot] = kNowhere;
  shapes_[slot] = Circle{};
  circles_[slot] = kNoCircle;
  free_.push_back(slot);
}

void Bodies::record(Slot slot) {
  const auto* circle = std::get_if<Circle>(&shapes_[slot]);
  if (circle == nullptr) {
    circles_[slot] = {0, 0, kNan, 0};
    return;
  }
  const Vec2 centre = circle->centre_m - origin_m_;
  circles_[slot] = {static_cast<float>(centre.x()), static_cast<float>(centre.y()),
                    static_cast<float>(circle->radius_m), 0};
  farthest_m_ = std::max(farthest_m_, rounded_up(centre.cwiseAbs().maxCoeff()));
  largest_radius_m_ = std::max(largest_radius_m_, rounded_up(circle->radius_m));
}

bool Bodies::touches(Slot slot, const Sweep& sweep) const {
  if (const auto* circle = std::get_if<Circle>(&shapes_[slot])) return sweep.touches(*circle);
  return squared_distance(sweep.segment(), shapes_[slot]) <= sweep.radius_m * sweep.radius_m;
}

collision::BodiesView Bodies::view() const {
  return {origin_m_.x(),   origin_m_.y(), farthest_m_,     largest_radius_m_,
          circles_.data(), end(),         touches_exactly, this};
}

}  // namespace sidestep
