// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/collision_peers.hpp"

namespace sidestep::peers {
namespace {

#ifdef __x86_64__
#define SIDESTEP_FOR_THIS_MACHINE __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define SIDESTEP_FOR_THIS_MACHINE
#endif

SIDESTEP_FOR_THIS_MACHINE
bool any_touches(const double* x, const double* y, const double* radius, std::size_t count,
                 const Sweep& sweep) {
  constexpr std::size_t kTogether = 64;
  const double from_x = sweep.from_m.x(), from_y = sweep.from_m.y();
  const double way_x = sweep.way_m.x(), way_y = sweep.way_m.y();
  const double per_length2 = sweep.per_length2, own_radius = sweep.radius_m;
  for (std::size_t begin = 0; begin < count; begin += kTogether) {
    const std::size_t end = begin + kTogether < count ? begin + kTogether : count;
    long touched = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const double dx = x[i] - from_x, dy = y[i] - from_y;
      double along = (dx * way_x + dy * way_y) * per_length2;
      along = along > 0 ? along : 0;
      along = along < 1 ? along : 1;
      const double ex = dx - along * way_x, ey = dy - along * way_y, reach = radius[i] + own_radius;
      touched |= ex * ex + ey * ey <= reach * reach;
    }
    if (touched != 0) return true;
  }
  return false;
}

bool touch_in_fcl(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* found) {
  fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  const bool touches = fcl::collide(a, b, request, result) > 0;
  if (touches) *static_cast<bool*>(found) = true;
  return touches;
}

}  // namespace

PlainArray::PlainArray(const std::vector<Circle>& circles) {
  for (const Circle& circle : circles) {
    x_m_.push_back(circle.centre_m.x());
    y_m_.push_back(circle.centre_m.y());
    radius_m_.push_back(circle.radius_m);
  }
}

bool PlainArray::touches(const Sweep& sweep) const {
  return any_touches(x_m_.data(), y_m_.data(), radius_m_.data(), x_m_.size(), sweep);
}

BoostRTree::BoostRTree(const std::vector<Circle>& circles) {
  std::vector<Entry> entries;
  for (const Circle& circle : circles) {
    const Box box = grown({circle.centre_m, circle.centre_m}, circle.radius_m);
    entries.emplace_back(Bounds({box.min_m.x(), box.min_m.y()}, {box.max_m.x(), box.max_m.y()}), circle);
  }
  tree_ = {entries.begin(), entries.end()};
}

bool BoostRTree::touches(const Sweep& sweep) const {
  namespace index = boost::geometry::index;
  const Vec2 to = sweep.from_m + sweep.way_m;
  const Box box = grown({sweep.from_m.cwiseMin(to), sweep.from_m.cwiseMax(to)}, sweep.radius_m);
  const Bounds query({box.min_m.x(), box.min_m.y()}, {box.max_m.x(), box.max_m.y()});
  const auto touched = [&](const Entry& entry) {
    return sweep.touches(entry.second.centre_m.x(), entry.second.centre_m.y(), entry.second.radius_m);
  };
  return tree_.qbegin(index::intersects(query) && index::satisfies(touched)) != tree_.qend();
}

FclTree::FclTree(const std::vector<Circle>& circles)
    : capsule_(std::make_shared<fcl::Capsuled>(1, 1)), query_(capsule_) {
  std::vector<fcl::CollisionObjectd*> objects;
  for (const Circle& circle : circles) {
    fcl::Transform3d place = fcl::Transform3d::Identity();
    place.translation() << circle.centre_m, 0;
    objects_.push_back(
        std::make_unique<fcl::CollisionObjectd>(std::make_shared<fcl::Sphered>(circle.radius_m), place));
    objects.push_back(objects_.back().get());
  }
  manager_.registerObjects(objects);
  manager_.setup();
}

bool FclTree::touches(const Sweep& sweep) {
  const double length_m = sweep.way_m.norm();
  capsule_->radius = sweep.radius_m;
  capsule_->lz = length_m;
  capsule_->computeLocalAABB();
  fcl::Matrix3d turn = fcl::Matrix3d::Identity();
  if (length_m > 0) {
    const Vec2 along = sweep.way_m / length_m;
    turn << along.y(), 0, along.x(), -along.x(), 0, along.y(), 0, -1, 0;
  }
  const Vec2 middle = sweep.from_m + 0.5 * sweep.way_m;
  query_.setTransform(turn, fcl::Vector3d(middle.x(), middle.y(), 0));
  query_.computeAABB();
  bool found = false;
  manager_.collide(&query_, &found, touch_in_fcl);
  return found;
}

}  // namespace sidestep::peers
