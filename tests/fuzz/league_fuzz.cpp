// SPDX-License-Identifier: Apache-2.0
// The entry points of libFuzzer. With SIDESTEP_SEEDS=FOLDER the program writes the initial inputs there and
// exits.
#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/fuzz/league_inputs.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sidestep::fuzz::try_league_input(std::as_bytes(std::span(data, size)));
  return 0;
}

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* const folder = std::getenv("SIDESTEP_SEEDS");
  if (!folder) return 0;
  int number = 0;
  for (const auto& seed : sidestep::fuzz::league_seeds(1)) {
    std::ofstream file(std::string(folder) + "/seed-" + std::to_string(number++), std::ios::binary);
    file.write(reinterpret_cast<const char*>(seed.data()), static_cast<std::streamsize>(seed.size()));
  }
  std::exit(0);
}
