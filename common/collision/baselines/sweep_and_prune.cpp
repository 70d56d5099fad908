// SPDX-License-Identifier: Apache-2.0
#include "common/collision/baselines/sweep_and_prune.hpp"

namespace sidestep::baselines {

SweepAndPrune::SweepAndPrune(const ShapeStore& store) {
  const auto count = static_cast<double>(store.slots().size());
  Vec2 sum(0, 0), sum2(0, 0);
  for (const Slot slot : store.slots()) {
    const Vec2 at = centre_m(store.shape(slot)) - store.origin_m();
    sum += at;
    sum2 += at.cwiseAbs2();
  }
  const Vec2 spread = count * sum2 - sum.cwiseAbs2();
  axis_ = spread.x() >= spread.y() ? 0 : 1;
  std::vector<Slot> sorted = store.slots();
  std::sort(sorted.begin(), sorted.end(), [&](Slot a, Slot b) {
    return bounds(store.shape(a)).min_m[axis_] < bounds(store.shape(b)).min_m[axis_];
  });
  for (const Slot slot : sorted) add(slot, store.shape(slot));
}

void SweepAndPrune::add(Slot slot, const Shape& shape) {
  if (slot >= indices_.size()) indices_.resize(slot + 1);
  lows_m_.emplace_back();
  boxes_.emplace_back();
  slots_.emplace_back();
  put(slots_.size() - 1, bounds(shape), slot);
  restore_order_at(slots_.size() - 1);
}

void SweepAndPrune::replace(Slot slot, const Shape& shape) {
  put(indices_[slot], bounds(shape), slot);
  restore_order_at(indices_[slot]);
}

void SweepAndPrune::remove(Slot slot) {
  for (std::size_t i = indices_[slot]; i + 1 < slots_.size(); ++i) put(i, boxes_[i + 1], slots_[i + 1]);
  lows_m_.pop_back();
  boxes_.pop_back();
  slots_.pop_back();
}

void SweepAndPrune::put(std::size_t i, const Box& box, Slot slot) {
  lows_m_[i] = box.min_m[axis_];
  boxes_[i] = box;
  slots_[i] = slot;
  indices_[slot] = i;
  max_length_m_ = std::max(max_length_m_, box.max_m[axis_] - box.min_m[axis_]);
}

void SweepAndPrune::restore_order_at(std::size_t i) {
  for (; i > 0 && lows_m_[i] < lows_m_[i - 1]; --i) exchange(i, i - 1);
  for (; i + 1 < lows_m_.size() && lows_m_[i + 1] < lows_m_[i]; ++i) exchange(i, i + 1);
}

void SweepAndPrune::exchange(std::size_t i, std::size_t j) {
  std::swap(lows_m_[i], lows_m_[j]);
  std::swap(boxes_[i], boxes_[j]);
  std::swap(slots_[i], slots_[j]);
  std::swap(indices_[slots_[i]], indices_[slots_[j]]);
}

}  // namespace sidestep::baselines
