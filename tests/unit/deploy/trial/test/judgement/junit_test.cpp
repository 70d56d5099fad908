// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/judgement/junit.hpp"

#include "tests/catch.hpp"

namespace sidestep::junit_test {

TestResult passed_result() {
  TestResult result;
  result.file = "a.yaml";
  result.bus = "SimBus";
  result.wall_s = 0.25;
  result.expectations.push_back({"no contact of all robots", 7, {}});
  return result;
}

TEST_CASE("a run over DDS names its report and log, whether it passed or not") {
  TestResult result = passed_result();
  result.run_s = 12;
  result.wall_s = 1.5;
  CHECK(summary(result) == "passed, 1 expectations, 12.0 s in 1.5 s\n");
  result.report_file = "reports/a.json";
  result.log_file = "reports/a.log";
  CHECK(summary(result) ==
        "passed, 1 expectations, 12.0 s in 1.5 s\n  report: reports/a.json\n  log: reports/a.log\n");
  result.expectations[0].judgement = Judgement::failed(2.25, "robot 1 touched robot 2");
  CHECK(summary(result) ==
        "FAILED, 1 expectations, 12.0 s in 1.5 s\n"
        "  at 2.250 s: line 7 expects no contact of all robots, but robot 1 touched robot 2\n"
        "  report: reports/a.json\n  log: reports/a.log\n");
}

TEST_CASE("each result becomes one test case, with counts and times") {
  TestResult failed = passed_result(), broken = passed_result();
  failed.file = "b \"quoted\" & <odd>.yaml";
  failed.seed = 3;
  failed.wall_s = 1;
  failed.problems.push_back({1.5, "kill agent 1: agent 1 does not run"});
  failed.expectations[0].judgement = Judgement::failed(2.25, "robot 1 touched robot 2");
  failed.expectations.push_back({"robot 1 moving", 8, Judgement::not_judged(3, "the run ended")});
  broken.error = "creating network namespaces needs root";
  CHECK(junit_xml({passed_result(), failed, broken}) ==
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<testsuite name=\"sidestep test\" tests=\"3\" failures=\"1\" errors=\"1\" time=\"1.500\">\n"
        "  <testcase classname=\"sidestep.SimBus\" name=\"a.yaml, seed 1\" time=\"0.250\"/>\n"
        "  <testcase classname=\"sidestep.SimBus\" name=\"b &quot;quoted&quot; &amp; &lt;odd&gt;.yaml, seed "
        "3\" "
        "time=\"1.000\">\n"
        "    <failure message=\"at 1.500 s: could not kill agent 1: agent 1 does not run\">"
        "at 1.500 s: could not kill agent 1: agent 1 does not run&#10;"
        "at 2.250 s: line 7 expects no contact of all robots, but robot 1 touched robot 2&#10;"
        "at 3.000 s: not judged: line 8 expects robot 1 moving, but the run ended</failure>\n"
        "  </testcase>\n"
        "  <testcase classname=\"sidestep.SimBus\" name=\"a.yaml, seed 1\" time=\"0.250\">\n"
        "    <error message=\"could not run: creating network namespaces needs root\">"
        "could not run: creating network namespaces needs root</error>\n"
        "  </testcase>\n"
        "</testsuite>\n");
}

TEST_CASE("texts of a test cannot leave their place in its results") {
  TestResult broken = passed_result();
  broken.error = "it's\x1b[31m <\"bad\">\n";
  CHECK_THAT(junit_xml({broken}),
             ContainsSubstring("it&#39;s\xEF\xBF\xBD[31m &lt;&quot;bad&quot;&gt;&#10;</error>"));
}

}  // namespace sidestep::junit_test
