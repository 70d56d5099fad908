// SPDX-License-Identifier: Apache-2.0
// The entry points of libFuzzer. With SIDESTEP_SEEDS=FOLDER a fuzzer
// writes its seeds there and exits.
#include <cstdlib>
#include <fstream>

#include "tests/fuzz/fuzz_target.hpp"

namespace {

void write_seeds(const std::string& folder) {
  int number = 0;
  for (const sidestep::fuzz::Bytes& seed : sidestep::fuzz::seeds()) {
    std::ofstream file(folder + "/seed-" + std::to_string(number++), std::ios::binary);
    file.write(reinterpret_cast<const char*>(seed.data()), static_cast<std::streamsize>(seed.size()));
    SIDESTEP_REQUIRE(file.good());
  }
}

}  // namespace

// The functions must be visible to libFuzzer's own main function.
extern "C" __attribute__((visibility("default"))) int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                                                             std::size_t size) {
  sidestep::fuzz::try_input({data, size});
  return 0;
}

extern "C" __attribute__((visibility("default"))) int LLVMFuzzerInitialize(int*, char***) {
  const char* const folder = std::getenv("SIDESTEP_SEEDS");
  if (!folder) return 0;
  write_seeds(folder);
  std::_Exit(0);
}
