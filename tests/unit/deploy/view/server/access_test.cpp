// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/server/access.hpp"

#include <set>

#include "tests/catch.hpp"

namespace sidestep::access_test {

AccessSettings settings() { return {"127.0.0.1", 8080, {"https://example.org"}, "abc"}; }

TEST_CASE("requests must name this server as their host") {
  for (const char* host : {"127.0.0.1:8080", "localhost:8080", "[::1]:8080"})
    CHECK(refusal(settings(), {host, "", ""}).empty());
  for (const char* host :
       {"", "evil.example:8080", "localhost", "localhost:80", "127.0.0.1:80801", "localhost:8080.evil"})
    CHECK_FALSE(refusal(settings(), {host, "", ""}).empty());
}

TEST_CASE("pages of other servers are refused unless their origin is allowed") {
  CHECK(refusal(settings(), {"localhost:8080", "http://localhost:8080", ""}).empty());
  CHECK(refusal(settings(), {"localhost:8080", "https://example.org", ""}).empty());
  for (const char* origin : {"http://evil.example", "null", "http://localhost:8081", "https://localhost:8080",
                             "http://127.0.0.1:8080", "https://example.org.evil", "http://example.org"})
    CHECK_FALSE(refusal(settings(), {"localhost:8080", origin, ""}).empty());
}

TEST_CASE("only requests with the token may command") {
  CHECK(command_refusal(settings(), {"", "", "Bearer abc"}).empty());
  for (const char* authorization :
       {"", "Bearer ", "Bearer abd", "Bearer abcd", "abc", "bearer abc", "Basic abc"})
    CHECK_FALSE(command_refusal(settings(), {"", "", authorization}).empty());
  AccessSettings without = settings();
  without.token.clear();
  CHECK_FALSE(command_refusal(without, {"", "", "Bearer "}).empty());
}

TEST_CASE("every token is different") {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) tokens.insert(random_token());
  CHECK(tokens.size() == 100);
  CHECK(tokens.begin()->size() == 32);
}

}  // namespace sidestep::access_test
