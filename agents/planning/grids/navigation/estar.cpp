// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/estar.hpp"

#include <array>
#include <stdexcept>
#include <string>

#include "agents/planning/grids/navigation/kernels.hpp"

namespace sidestep {
namespace {

constexpr std::uint32_t kEverywhere = 0xffffffff;

// An entry of the queue is a cell whose value was lowered, and whose neighbours do not use the new value yet.
// With this flag, it is a cell that waits to be raised. The key of an entry is the cell's value, or its
// former value if it waits to be raised.
constexpr std::uint32_t kRaise = BucketQueue::kSecondLane;

}  // namespace

EStar::EStar(const CostGrid& grid, const EStarSettings& settings)
    : layout_(grid.layout()), settings_(settings), stride_(layout_.columns + 2) {
  if (settings.exact_radius_cells < 0 || settings.exact_radius_cells > 20)
    throw std::invalid_argument("the radius of exact distances must be 0 to 20 cells, not " +
                                std::to_string(settings.exact_radius_cells));
  if (!is_euclidean()) settings_.exact_radius_cells = 0;
  if (settings.kernel == GridKernel::kLineOfSight) line_of_sight_.emplace_back(layout_);
  costs_.assign(std::size_t{stride_} * (layout_.rows + 4), kBlocked);
  values_.assign(costs_.size(), kBlocked);
  raised_from_.assign(costs_.size(), kBlocked);
  for (GridCell cell = 0; cell < layout_.size(); ++cell) costs_[padded(cell)] = grid.cost(cell);
}

void EStar::check_cell(GridCell cell) const {
  if (cell >= layout_.size()) throw std::invalid_argument("no such cell: " + std::to_string(cell));
}

void EStar::set_cost(GridCell cell, float cost) {
  check_cell(cell);
  check_cost(cost);
  float& stored = costs_[padded(cell)];
  if (stored == cost) return;
  stored = cost;
  if (exact_.empty()) return;
  changed_.push_back(padded(cell));
  if (is_in_disc(cell)) exact_is_stale_ = true;
}

/// The key of an entry; infinite if the entry has become obsolete.
float EStar::key_of(Entry entry) const {
  return (entry & kRaise) ? raised_from_[entry & ~kRaise] : values_[entry];
}

/// Withdraws a cell's value; its neighbours do not use the value until the cell is raised.
void EStar::mark_unsupported(std::uint32_t at) {
  raised_from_[at] = values_[at];
  values_[at] = kBlocked;
  ++unsupported_;
  queue_.push(raised_from_[at], at | kRaise);
}

/// The cells that may depend on a cell.
template <typename Kernel>
auto EStar::neighbours_of(std::uint32_t at) const {
  if constexpr (Kernel::kReach == 1)
    return std::array{at - 1, at + 1, at - stride_, at + stride_};
  else
    return std::array{at - 1, at + 1, at - stride_,     at + stride_,
                      at - 2, at + 2, at - 2 * stride_, at + 2 * stride_};
}

template <typename Kernel, typename ValueOf>
float EStar::value_from(std::uint32_t at, const ValueOf& value_of) const {
  float value = kBlocked;
  if constexpr (Kernel::kReach == 1) {
    const float x = std::min(value_of(at - 1), value_of(at + 1));
    const float y = std::min(value_of(at - stride_), value_of(at + stride_));
    value = Kernel::value(std::min(x, y), std::max(x, y), costs_[at]);
  } else {
    const auto side = [&](std::uint32_t step) {
      return Kernel::side(value_of(at + step), value_of(at + 2 * step));
    };
    value = Kernel::value(Kernel::axis(side(~0u), side(1)), Kernel::axis(side(0u - stride_), side(stride_)),
                          costs_[at]);
  }
  const std::uint32_t i = at - exact_begin_;
  return i < exact_.size() ? std::min(exact_[i], value) : value;
}

template <typename Kernel>
float EStar::value_from_neighbours(std::uint32_t at) const {
  return value_from<Kernel>(at, [this](std::uint32_t neighbour) { return values_[neighbour]; });
}

template <typename Kernel>
float EStar::value_from_lower(std::uint32_t at, float limit) const {
  return value_from<Kernel>(at, [&](std::uint32_t neighbour) {
    const float value = values_[neighbour];
    return value < limit ? value : kBlocked;
  });
}

/// Updates a cell whose value a neighbour may lower, while no cell waits to be raised.
template <typename Kernel>
void EStar::lower(std::uint32_t at) {
  if (Kernel::kReach > 1 && costs_[at] == kBlocked) return;  // beyond the border there are no neighbours
  const float value = value_from_neighbours<Kernel>(at);
  if (value < values_[at]) {
    values_[at] = value;
    queue_.push(value, at);
  } else if (value > values_[at]) [[unlikely]] {  // due to rounding
    mark_unsupported(at);
  }
}

template <typename Kernel>
void EStar::lower_neighbours(std::uint32_t at) {
  const float value = values_[at];
  for (const std::uint32_t neighbour : neighbours_of<Kernel>(at))
    if (values_[neighbour] > value) lower<Kernel>(neighbour);
}

/// Updates a cell whose neighbours, cost or exact value have changed.
template <typename Kernel>
void EStar::update(std::uint32_t at) {
  const float before = known_value(at);
  if (costs_[at] == kBlocked && before == kBlocked) return;
  const float value = value_from_neighbours<Kernel>(at);
  const bool is_unsupported = raised_from_[at] < kBlocked;
  if (value > before) {
    if (!is_unsupported) mark_unsupported(at);
    return;
  }
  if (value == before && !is_unsupported) return;
  // The neighbours must be updated even if the value is unchanged, because they have stopped using the cell.
  unsupported_ -= is_unsupported;
  raised_from_[at] = kBlocked;
  values_[at] = value;
  queue_.push(value, at);
}

template <typename Kernel>
void EStar::update_neighbours(std::uint32_t at) {
  for (const std::uint32_t neighbour : neighbours_of<Kernel>(at))
    if (known_value(neighbour) > values_[at]) update<Kernel>(neighbour);
}

/// Raises an unsupported cell to the value supported by lower cells, whose values are final. Higher cells
/// support it when their turn comes, unless they have been raised before.
template <typename Kernel>
void EStar::raise(std::uint32_t at) {
  const float before = raised_from_[at], value = value_from_lower<Kernel>(at, before);
  // Neighbours that are lower than this do not depend on the cell. The new value is lower than the old value
  // if a neighbour has been lowered since, but has not been expanded yet.
  const float lowest = std::min(before, value);
  values_[at] = value;
  raised_from_[at] = kBlocked;
  --unsupported_;
  for (const std::uint32_t neighbour : neighbours_of<Kernel>(at)) {
    if (values_[neighbour] < lowest) continue;
    if (std::min(values_[neighbour], value) == kBlocked) continue;
    update<Kernel>(neighbour);
    if (values_[neighbour] < value) queue_.push(values_[neighbour], neighbour);
  }
}

template <typename Kernel>
void EStar::apply_changes() {
  float lowest = kBlocked;
  for (const std::uint32_t at : changed_)
    lowest = std::min({lowest, known_value(at), value_from_neighbours<Kernel>(at)});
  if (lowest < kBlocked) queue_.rewind(lowest, [this](Entry entry) { return key_of(entry); });
  for (const std::uint32_t at : changed_) update<Kernel>(at);
  changed_.clear();
}

/// Expands cells in the order of their keys, until this cell, all lower cells, and all cells up to `beyond`
/// higher are final.
template <typename Kernel>
void EStar::run(std::uint32_t until, float beyond) {
  apply_changes<Kernel>();
  while (queue_.advance([this](Entry entry) { return key_of(entry); })) {
    if (until != kEverywhere && queue_.is_before_current(values_[until] + beyond)) return;
    expand_bucket<Kernel>();
  }
}

/// Raises cells before it lowers others. Cells whose value has changed since they were added have been added
/// a second time.
template <typename Kernel>
void EStar::expand_bucket() {
  auto &lowered = queue_.first_lane(), &unsupported = queue_.second_lane();
  for (std::size_t i = 0, k = 0; i < lowered.size() || k < unsupported.size();) {
    if (k < unsupported.size()) {
      const std::uint32_t at = unsupported[k++] & ~kRaise;
      if (!queue_.is_in_current(raised_from_[at])) continue;
      raise<Kernel>(at);
    } else {
      const std::uint32_t at = lowered[i++];
      if (!queue_.is_in_current(values_[at])) continue;
      if (unsupported_ == 0)
        lower_neighbours<Kernel>(at);
      else
        update_neighbours<Kernel>(at);
    }
    ++expansions_;
  }
  lowered.clear();
  unsupported.clear();
}

void EStar::run_kernel(std::uint32_t until, float beyond) {
  if (exact_.empty()) throw std::invalid_argument("a navigation function needs a goal");
  if (exact_is_stale_) compute_exact_values();
  switch (settings_.kernel) {
    case GridKernel::kNf1:
      return run<Nf1Kernel>(until, beyond);
    case GridKernel::kAlpha:
      return run<AlphaKernel>(until, beyond);
    case GridKernel::kLineOfSight:
      if (has_uniform_cost_) return run<NoKernel>(until, beyond);
      return run<LsmKernel>(until, beyond);
    case GridKernel::kLsm:
      return run<LsmKernel>(until, beyond);
    case GridKernel::kSecondOrderLsm:
      return run<SecondOrderLsmKernel>(until, beyond);
  }
}

void EStar::propagate() { run_kernel(kEverywhere, 0); }

void EStar::propagate_until(GridCell cell, float beyond) {
  check_cell(cell);
  run_kernel(padded(cell), beyond);
}

}  // namespace sidestep
