// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/quantiser.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace sidestep {
namespace {

void check_horizon(float horizon_s) {
  if (!(horizon_s > 0) || !std::isfinite(horizon_s))
    throw std::invalid_argument("a quantiser's horizon has to be positive and finite");
}

/// A fine histogram of the times between 0 and the horizon. Each bin stores its smallest time, so that the
/// minimum of an interval of complete bins is known exactly.
class FineHistogram {
 public:
  FineHistogram(std::span<const float> times_s, float horizon_s)
      : count_before_(kBins + 1), sum_before_s_(kBins + 1), least_s_(kBins, kNone_s) {
    for (const float time : times_s) {
      if (!(time >= 0)) throw std::invalid_argument("a collision time must not be negative");
      if (time == 0 || time >= horizon_s) continue;
      const auto bin = std::min(static_cast<std::size_t>(time / horizon_s * kBins), kBins - 1);
      count_before_[bin + 1] += 1;
      sum_before_s_[bin + 1] += static_cast<double>(time);
      least_s_[bin] = std::min(least_s_[bin], time);
    }
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      count_before_[bin + 1] += count_before_[bin];
      sum_before_s_[bin + 1] += sum_before_s_[bin];
    }
  }

  double count(std::size_t from, std::size_t to) const { return count_before_[to] - count_before_[from]; }
  double mean_s(std::size_t from, std::size_t to) const {
    return (sum_before_s_[to] - sum_before_s_[from]) / count(from, to);
  }
  float least_s(std::size_t from, std::size_t to) const {
    return *std::min_element(least_s_.begin() + static_cast<std::ptrdiff_t>(from),
                             least_s_.begin() + static_cast<std::ptrdiff_t>(to));
  }
  /// The first bin before which at least `fraction` of the times lie.
  std::size_t quantile(double fraction) const {
    const double wanted = fraction * count_before_.back();
    const auto found = std::lower_bound(count_before_.begin(), count_before_.end(), wanted);
    return static_cast<std::size_t>(found - count_before_.begin());
  }

  static constexpr std::size_t kBins = 8192;
  static constexpr float kNone_s = std::numeric_limits<float>::infinity();

 private:
  std::vector<double> count_before_, sum_before_s_;  // cumulative values over the bins before each bin
  std::vector<float> least_s_;
};

/// The intervals' boundaries in bins, found by Lloyd's iteration starting from intervals with equally many
/// times.
std::vector<std::size_t> lloyd_boundaries(const FineHistogram& histogram, std::size_t intervals,
                                          float horizon_s) {
  constexpr int kMaxIterations = 200;
  std::vector<std::size_t> bounds{0};
  for (std::size_t i = 1; i < intervals; ++i)
    bounds.push_back(histogram.quantile(static_cast<double>(i) / static_cast<double>(intervals)));
  bounds.push_back(FineHistogram::kBins);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    std::vector<double> means_s;
    for (std::size_t i = 0; i + 1 < bounds.size(); ++i) {
      if (histogram.count(bounds[i], bounds[i + 1]) > 0)
        means_s.push_back(histogram.mean_s(bounds[i], bounds[i + 1]));
    }
    std::vector<std::size_t> next{0};
    for (std::size_t i = 0; i + 1 < means_s.size(); ++i) {
      const double middle = (means_s[i] + means_s[i + 1]) / 2 / static_cast<double>(horizon_s);
      next.push_back(static_cast<std::size_t>(std::lround(middle * FineHistogram::kBins)));
    }
    next.push_back(FineHistogram::kBins);
    if (next == bounds) break;
    bounds = std::move(next);
  }
  return bounds;
}

}  // namespace

Quantiser Quantiser::uniform(float horizon_s) {
  check_horizon(horizon_s);
  Quantiser result;
  for (std::size_t i = 0; i < kLevels; ++i)
    result.levels_s_[i] = horizon_s * static_cast<float>(i) / static_cast<float>(kLevels - 1);
  result.size_ = kLevels;
  return result;
}

Quantiser Quantiser::lloyd_max(std::span<const float> times_s, float horizon_s, std::size_t levels) {
  check_horizon(horizon_s);
  if (levels < 3 || levels > kLevels) throw std::invalid_argument("a quantiser has 3 to 256 levels");
  const FineHistogram histogram(times_s, horizon_s);
  const std::vector<std::size_t> bounds = lloyd_boundaries(histogram, levels - 2, horizon_s);
  Quantiser result;
  result.size_ = 1;  // 0 is always a level
  for (std::size_t i = 0; i + 1 < bounds.size(); ++i) {
    if (histogram.count(bounds[i], bounds[i + 1]) > 0)
      result.levels_s_[result.size_++] = histogram.least_s(bounds[i], bounds[i + 1]);
  }
  std::fill(result.levels_s_.begin() + static_cast<std::ptrdiff_t>(result.size_), result.levels_s_.end(),
            horizon_s);
  ++result.size_;
  return result;
}

std::uint8_t Quantiser::encode(float time_s) const {
  const auto end = levels_s_.begin() + static_cast<std::ptrdiff_t>(size_);
  const auto after = std::upper_bound(levels_s_.begin(), end, time_s);
  return static_cast<std::uint8_t>(std::max<std::ptrdiff_t>(after - levels_s_.begin() - 1, 0));
}

}  // namespace sidestep
