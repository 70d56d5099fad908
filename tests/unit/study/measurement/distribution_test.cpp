// SPDX-License-Identifier: Apache-2.0
#include "tests/study/measurement/distribution.hpp"

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::distribution_test {

TEST_CASE("the quantiles of a distribution do not depend on the order of its values") {
  Rng rng(3);
  Distribution one, parts[2];
  std::vector<double> sorted;
  double sum = 0;
  for (int i = 0; i < 200; ++i) {
    const double value = rng.normal();
    one.add(value);
    parts[i % 2].add(value);
    sorted.push_back(value);
    sum += value;
  }
  parts[0].add(parts[1]);
  std::sort(sorted.begin(), sorted.end());
  for (const Distribution* distribution : {&one, &parts[0]}) {
    CHECK(distribution->size() == 200);
    CHECK(distribution->quantile(0) == sorted.front());
    CHECK(distribution->median() == sorted[100]);
    CHECK(distribution->quantile(0.95) == sorted[190]);
    CHECK(distribution->quantile(1) == sorted.back());
    CHECK(distribution->mean() == Approx(sum / 200));
    CHECK(distribution->shifted(3).median() == sorted[100] + 3);
  }
}

TEST_CASE("the median and mean of an empty distribution are 0") {
  CHECK(Distribution().median() == 0);
  CHECK(Distribution().mean() == 0);
}

}  // namespace sidestep::distribution_test
