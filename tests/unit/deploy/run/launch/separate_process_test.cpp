// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/separate_process.hpp"

#include <csignal>
#include <thread>

#include "tests/catch.hpp"

namespace sidestep::separate_process_test {

TEST_CASE("work in a separate process returns its exit code, or the reason of its death") {
  CHECK(run_separately([] { return 0; }) == 0);
  CHECK(run_separately([] {
          int code = 0;
          std::thread([&code] { code = 7; }).join();
          return code;
        }) == 7);
  CHECK_THROWS_WITH(run_separately([] { return raise(SIGKILL); }), "a process died: signal 9 (SIGKILL)");
}

}  // namespace sidestep::separate_process_test
