// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/quantiser.hpp"

#include <cmath>
#include <set>
#include <vector>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::quantiser_test {

constexpr float kHorizon_s = 1;

/// Times clustered around two values, and some beyond the horizon.
std::vector<float> random_times(Rng& rng, int count) {
  std::vector<float> times;
  for (int i = 0; i < count; ++i) {
    const double centre = rng.chance(0.6) ? 0.2 : 0.7, time = centre + 0.05 * rng.normal();
    times.push_back(rng.chance(0.1) ? kHorizon_s : static_cast<float>(std::max(0.0, time)));
  }
  return times;
}

double mean_error_s(const Quantiser& quantiser, const std::vector<float>& times) {
  double sum = 0;
  for (const float time : times)
    sum += static_cast<double>(std::min(time, kHorizon_s)) -
           static_cast<double>(quantiser.decode(quantiser.encode(time)));
  return sum / static_cast<double>(times.size());
}

TEST_CASE("quantised times are never later than true ones") {
  const std::uint64_t seed = GENERATE(range(1, 20));
  CAPTURE(seed);
  Rng rng(seed);
  const std::vector<float> times = random_times(rng, 5000);
  const std::size_t levels = 3 + rng.below(254);
  const Quantiser quantisers[] = {Quantiser::uniform(kHorizon_s),
                                  Quantiser::lloyd_max(times, kHorizon_s, levels)};
  for (const Quantiser& quantiser : quantisers) {
    for (const float time : times) {
      const float stored = quantiser.decode(quantiser.encode(time));
      REQUIRE(stored <= time);
      // Quantising a quantised time does not change it.
      REQUIRE(quantiser.decode(quantiser.encode(stored)) == stored);
    }
    CHECK(quantiser.decode(quantiser.encode(2 * kHorizon_s)) == kHorizon_s);
  }
}

TEST_CASE("quantiser levels are ordered like the times that they represent") {
  Rng rng(3);
  const std::vector<float> times = random_times(rng, 2000);
  const Quantiser quantiser = Quantiser::lloyd_max(times, kHorizon_s);
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i - 1] <= times[i]) REQUIRE(quantiser.encode(times[i - 1]) <= quantiser.encode(times[i]));
  }
}

TEST_CASE("uniform quantiser levels differ from the true times by at most one step") {
  Rng rng(4);
  const Quantiser quantiser = Quantiser::uniform(kHorizon_s);
  for (int i = 0; i < 10'000; ++i) {
    const auto time = static_cast<float>(rng.uniform(0, 1));
    REQUIRE(time - quantiser.decode(quantiser.encode(time)) <= kHorizon_s / 255 * 1.001F);
  }
}

TEST_CASE("the Lloyd-Max levels separate two clusters of times") {
  Rng rng(5);
  const std::vector<float> times = random_times(rng, 20'000);
  const Quantiser fitted = Quantiser::lloyd_max(times, kHorizon_s, 4);
  CHECK(fitted.size() == 4);
  // The clusters around 0.2 and 0.7 have one interval each.
  CHECK(fitted.encode(0.1F) == fitted.encode(0.35F));
  CHECK(fitted.encode(0.55F) == fitted.encode(0.9F));
  CHECK(fitted.encode(0.2F) != fitted.encode(0.7F));
}

TEST_CASE("more levels give smaller errors, and a few fitted levels give smaller errors than uniform steps") {
  Rng rng(6);
  const std::vector<float> times = random_times(rng, 20'000);
  const double coarse_s = mean_error_s(Quantiser::lloyd_max(times, kHorizon_s, 16), times);
  const double fine_s = mean_error_s(Quantiser::lloyd_max(times, kHorizon_s), times);
  CHECK(fine_s < coarse_s / 4);
  CHECK(fine_s < mean_error_s(Quantiser::uniform(kHorizon_s), times));
}

TEST_CASE("a quantiser refuses invalid horizons, level counts and times") {
  const std::vector<float> times{0.1F, 0.2F}, negative{-0.1F};
  CHECK_THROWS_AS(Quantiser::uniform(0), std::invalid_argument);
  CHECK_THROWS_AS(Quantiser::lloyd_max(times, kHorizon_s, 2), std::invalid_argument);
  CHECK_THROWS_AS(Quantiser::lloyd_max(times, kHorizon_s, 257), std::invalid_argument);
  CHECK_THROWS_AS(Quantiser::lloyd_max(negative, kHorizon_s), std::invalid_argument);
}

}  // namespace sidestep::quantiser_test
