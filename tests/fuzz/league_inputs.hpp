// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sidestep::fuzz {

/// Passes an input to code that reads bytes from the network or from files. The first byte selects the
/// decoder of vision packets, of tracked packets or of the referee's packets, the log reader, or the clock
/// that converts frame times. Aborts the program if one of them accepts an invalid input. Returns whether it
/// was accepted, a log at least in part.
bool try_league_input(std::span<const std::byte> input);

/// Valid inputs of every kind, as initial corpus.
std::vector<std::vector<std::byte>> league_seeds(std::uint64_t seed);

}  // namespace sidestep::fuzz
