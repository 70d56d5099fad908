// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sidestep::fuzz {

/// Gives an input to what reads bytes from the network or from files: its first byte says to whom, a vision
/// packet's reader, a tracked packet's, a log's, or the clock that dates frames. Ends the program when one of
/// them accepts what it must not.
void try_league_input(std::span<const std::byte> input);

/// Sound inputs of every kind, to begin with.
std::vector<std::vector<std::byte>> league_seeds(std::uint64_t seed);

}  // namespace sidestep::fuzz
