// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/floor_processes.hpp"

#include "tests/catch.hpp"

namespace sidestep::floor_processes_test {

using Words = std::vector<std::string>;

Words vision_arguments(const std::string& driver, const std::string& extra) {
  FloorOptions options;
  options.driver = driver;
  options.vision = extra;
  return vision_process(options).arguments;
}

TEST_CASE("options for vision are added to those of the league's driver") {
  CHECK(vision_arguments("league", "") == Words{"--source", "ssl", "--ssl-vision", "224.5.23.2:10020"});
  CHECK(vision_arguments("league", "--league-cameras 0,1") ==
        Words{"--source", "ssl", "--ssl-vision", "224.5.23.2:10020", "--league-cameras", "0,1"});
  CHECK(vision_arguments("league", "--tracked") ==
        Words{"--source", "ssl", "--ssl-vision", "224.5.23.2:10020", "--tracked"});
}

TEST_CASE("an option for vision replaces the same option of the league's driver") {
  CHECK(vision_arguments("league", "--ssl-vision 224.5.23.2:10006") ==
        Words{"--source", "ssl", "--ssl-vision", "224.5.23.2:10006"});
  CHECK(vision_arguments("league", "--source=ssl --ssl-vision=224.5.23.2:10006") ==
        Words{"--source=ssl", "--ssl-vision=224.5.23.2:10006"});
  CHECK(vision_arguments("league", "--source ssl") ==
        Words{"--ssl-vision", "224.5.23.2:10020", "--source", "ssl"});
  CHECK(vision_arguments("league", "--source dds") == Words{"--source", "dds"});
}

TEST_CASE("other drivers get only the options that are given for vision") {
  CHECK(vision_arguments("velocity", "--tracked") == Words{"--tracked"});
  CHECK(vision_arguments("", "").empty());
}

TEST_CASE("robots are placed by the vision packets that vision receives") {
  FloorOptions options;
  options.driver = "league";
  options.placing_control = "127.0.0.1:10300";
  CHECK(place_options_of(options).vision == "224.5.23.2:10020");
  CHECK(place_options_of(options).interfaces.empty());
  options.vision =
      "--ssl-vision=224.5.23.2:10006 --league-interface 127.0.0.1,10.0.0.2 --league-sender 10.0.0.7";
  const PlaceOptions placing = place_options_of(options);
  CHECK(placing.control == "127.0.0.1:10300");
  CHECK(placing.vision == "224.5.23.2:10006");
  CHECK(placing.interfaces == Words{"127.0.0.1", "10.0.0.2"});
  CHECK(placing.senders == Words{"10.0.0.7"});
}

}  // namespace sidestep::floor_processes_test
