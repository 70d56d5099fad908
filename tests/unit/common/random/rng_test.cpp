// SPDX-License-Identifier: Apache-2.0
#include "common/random/rng.hpp"

#include <array>
#include <map>

#include "tests/catch.hpp"

namespace sidestep::rng_test {

constexpr std::uint64_t kSeed = 11;
constexpr int kSamples = 60'000;
// A count deviates from its expectation by more standard deviations than this once in 16,000 times.
constexpr double kMaxDeviations = 4;

TEST_CASE("a seed gives the same bits on every machine") {
  Rng rng(1);
  // Computed with the published code of xoshiro256++ and splitmix64.
  for (const std::uint64_t expected :
       {0xcfc5d07f6f03c29bU, 0xbf424132963fe08dU, 0x19a37d5757aaf520U, 0xbf08119f05cd56d6U}) {
    CHECK(rng.bits() == expected);
  }
}

TEST_CASE("all permutations of a shuffle are equally frequent") {
  CAPTURE(kSeed);
  Rng rng(kSeed);
  std::map<std::array<int, 4>, int> seen;
  for (int i = 0; i < kSamples; ++i) {
    std::array<int, 4> order{0, 1, 2, 3};
    rng.shuffle(order);
    ++seen[order];
  }
  REQUIRE(seen.size() == 24);
  constexpr double kProbability = 1.0 / 24;
  const double deviation = std::sqrt(kSamples * kProbability * (1 - kProbability));
  for (const auto& [order, count] : seen)
    CHECK(std::abs(count - kSamples * kProbability) < kMaxDeviations * deviation);
}

TEST_CASE("normal samples have mean 0, variance 1 and no skew") {
  CAPTURE(kSeed);
  Rng rng(kSeed);
  double first = 0, second = 0, third = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double value = rng.normal();
    first += value;
    second += value * value;
    third += value * value * value;
  }
  // The variances of x, x^2 and x^3 are 1, 2 and 15.
  const auto bound = [](double variance) { return kMaxDeviations * std::sqrt(variance / kSamples); };
  CHECK(std::abs(first / kSamples) < bound(1));
  CHECK(std::abs(second / kSamples - 1) < bound(2));
  CHECK(std::abs(third / kSamples) < bound(15));
}

TEST_CASE("forked generators share no numbers") {
  Rng first(kSeed);
  Rng second = first.fork(), third = first.fork();
  int same = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::uint64_t a = first.bits(), b = second.bits(), c = third.bits();
    same += (a == b) + (b == c) + (a == c);
  }
  CHECK(same == 0);
}

}  // namespace sidestep::rng_test
