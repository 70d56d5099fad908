// SPDX-License-Identifier: Apache-2.0
#include "common/time/histogram.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::histogram_test {

TEST_CASE("a quantile is at most one bucket above the quantile of the sorted durations") {
  const std::uint64_t seed = GENERATE(1, 2, 3, 4, 5, 6, 7, 8);
  CAPTURE(seed);
  Rng rng(seed);
  DurationHistogram histogram;
  std::vector<Duration> all;
  for (std::uint64_t i = 0, n = 1 + rng.below(3000); i < n; ++i) {
    const Duration duration{static_cast<std::int64_t>(std::exp(rng.uniform(0, std::log(2e9))))};
    histogram.add(duration);
    all.push_back(duration);
  }
  std::sort(all.begin(), all.end());
  REQUIRE(histogram.count() == all.size());
  CHECK(histogram.max() == all.back());
  for (const double q : {0.0, 0.01, 0.25, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    CAPTURE(q);
    const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(all.size())));
    const Duration exact = all[std::max<std::size_t>(rank, 1) - 1];
    const Duration got = histogram.quantile(q);
    CHECK(got >= exact);
    CHECK(to_seconds(got) <= std::max(to_seconds(exact) * std::exp2(1.0 / 6), 1e-6) + 2e-9);
    CHECK(got <= all.back());
  }
}

TEST_CASE("a duration on an edge belongs to the bucket below the edge") {
  for (std::size_t i = 0; i + 1 < DurationHistogram::kBuckets; ++i) {
    DurationHistogram histogram;
    const Duration edge = DurationHistogram::upper_edge(i);
    histogram.add(edge);
    histogram.add(edge + Duration{1});
    CHECK(histogram.quantile(0.5) == edge);
    CHECK(histogram.quantile(1) == edge + Duration{1});
    CHECK(histogram.buckets()[i] == 1);
    CHECK(histogram.buckets()[i + 1] == 1);
  }
}

TEST_CASE("an empty histogram has zero quantiles, and a negative duration counts as zero") {
  DurationHistogram histogram;
  CHECK(histogram.quantile(0.5) == Duration{0});
  histogram.add(Duration{-5});
  CHECK(histogram.count() == 1);
  CHECK(histogram.quantile(1) == Duration{0});
}

TEST_CASE("durations beyond the last edge count in the last bucket, whose quantile is the maximum") {
  DurationHistogram histogram;
  for (int i = 0; i < 10; ++i) histogram.add(std::chrono::hours(i + 1));
  CHECK(histogram.quantile(0.1) == std::chrono::hours(10));
}

TEST_CASE("merging two histograms equals adding all durations to one histogram") {
  const std::uint64_t seed = 9;
  CAPTURE(seed);
  Rng rng(seed);
  DurationHistogram first, second, both;
  for (int i = 0; i < 2000; ++i) {
    const Duration duration{static_cast<std::int64_t>(rng.below(3'000'000'000))};
    (rng.chance(0.3) ? first : second).add(duration);
    both.add(duration);
  }
  DurationHistogram merged = first;
  merged.merge(second);
  CHECK(merged.count() == both.count());
  CHECK(merged.max() == both.max());
  for (double q = 0; q <= 1; q += 0.01) CHECK(merged.quantile(q) == both.quantile(q));
}

}  // namespace sidestep::histogram_test
