// SPDX-License-Identifier: Apache-2.0
#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/fuzz/league_inputs.hpp"

namespace sidestep::fuzz_test {

using Bytes = std::vector<std::byte>;

/// Overwrites bytes with a huge number.
void put_huge_number(Bytes& bytes, std::size_t at, Rng& rng) {
  for (std::size_t i = at; i < std::min(bytes.size(), at + 4); ++i) {
    bytes[i] = rng.chance(0.8) ? std::byte{0xff} : std::byte{0x7f};
  }
}

Bytes mutated(Bytes bytes, const Bytes& other, Rng& rng) {
  for (std::uint64_t changes = 1 + rng.below(6); changes > 0 && !bytes.empty(); --changes) {
    // The first byte selects the reader.
    const std::size_t at = 1 + rng.below(bytes.size());
    if (at >= bytes.size()) continue;
    switch (rng.below(6)) {
      case 0:
        bytes[at] ^= static_cast<std::byte>(1 << rng.below(8));
        break;
      case 1:
        bytes[at] = static_cast<std::byte>(rng.bits());
        break;
      case 2:
        bytes.resize(at);
        break;
      case 3:
        put_huge_number(bytes, at, rng);
        break;
      case 4:
        bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      default:
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), other.begin(),
                     other.begin() + static_cast<std::ptrdiff_t>(rng.below(other.size())));
    }
  }
  return bytes;
}

TEST_CASE("randomly mutated inputs do not break the readers of packets and logs") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u, 5u);
  CAPTURE(seed);
  Rng rng(seed);
  const auto seeds = fuzz::league_seeds(seed);
  // What each reader accepts is checked there, and aborts the program.
  for (const Bytes& valid : seeds) {
    CAPTURE(static_cast<int>(valid.front()));
    const bool is_accepted = fuzz::try_league_input(valid);
    // The clock's inputs are arbitrary times.
    if (valid.front() != std::byte{6}) CHECK(is_accepted);
  }
  int accepted = 0;
  constexpr int kInputs = 10'000;
  for (int i = 0; i < kInputs; ++i) {
    const Bytes& valid = seeds[rng.below(seeds.size())];
    accepted += fuzz::try_league_input(mutated(valid, seeds[rng.below(seeds.size())], rng));
  }
  // Enough of both kinds: neither do the readers refuse everything, nor accept it.
  CAPTURE(accepted);
  CHECK(accepted > kInputs / 20);
  CHECK(accepted < kInputs * 19 / 20);
}

}  // namespace sidestep::fuzz_test
