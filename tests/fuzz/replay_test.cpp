// SPDX-License-Identifier: Apache-2.0
// Runs a fuzzer without libFuzzer, on its seeds and on random changes of
// them.
#include <algorithm>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace sidestep::fuzz_test {

using fuzz::Bytes;

/// Overwrites bytes with a huge number.
void put_huge_number(Bytes& bytes, std::size_t at, Rng& rng) {
  for (std::size_t i = at; i < std::min(bytes.size(), at + 4); ++i) bytes[i] = rng.chance(0.8) ? 0xff : 0x7f;
}

/// Inserts a copy of a part of `other` at `at`.
void insert_part(Bytes& bytes, std::size_t at, const Bytes& other, Rng& rng) {
  const std::uint64_t begin = rng.below(other.size()),
                      size = rng.below(std::min<std::uint64_t>(other.size() - begin, 256) + 1);
  const auto first = other.begin() + static_cast<std::ptrdiff_t>(begin);
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), first,
               first + static_cast<std::ptrdiff_t>(size));
}

Bytes mutated(Bytes bytes, const Bytes& other, Rng& rng) {
  for (std::uint64_t changes = 1 + rng.below(6); changes > 0 && bytes.size() > 1; --changes) {
    // The first byte often selects the reader.
    const std::size_t at = 1 + rng.below(bytes.size() - 1);
    switch (rng.below(6)) {
      case 0:
        bytes[at] ^= static_cast<std::uint8_t>(1 << rng.below(8));
        break;
      case 1:
        bytes[at] = static_cast<std::uint8_t>(rng.bits());
        break;
      case 2:
        if (rng.chance(0.2)) bytes.resize(at);
        break;
      case 3:
        put_huge_number(bytes, at, rng);
        break;
      case 4:
        bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      default:
        if (!other.empty()) insert_part(bytes, at, other, rng);
    }
  }
  return bytes;
}

TEST_CASE("seed inputs are accepted, and random mutations of them are read without failure") {
  const std::vector<Bytes> seeds = fuzz::seeds();
  REQUIRE(!seeds.empty());
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    CAPTURE(i);
    CHECK(fuzz::try_input(seeds[i]));
  }
  const std::uint64_t seed = 1;
  CAPTURE(seed);
  Rng rng(seed);
  int accepted = 0;
  for (int i = 0; i < SIDESTEP_REPLAYED_INPUTS; ++i) {
    // A wrongly accepted input ends the program.
    const std::size_t begin = rng.below(seeds.size()), part = rng.below(seeds.size());
    accepted += fuzz::try_input(mutated(seeds[begin], seeds[part], rng));
  }
  // Enough inputs must be accepted and enough refused.
  CAPTURE(accepted);
  CHECK(accepted > SIDESTEP_REPLAYED_INPUTS / 100);
  CHECK(accepted < SIDESTEP_REPLAYED_INPUTS * 19 / 20);
}

}  // namespace sidestep::fuzz_test
