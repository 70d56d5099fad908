// SPDX-License-Identifier: Apache-2.0
#include "common/keys/signed_document.hpp"

#include "tests/catch.hpp"

namespace sidestep::signed_document_test {

TEST_CASE("a document covers the domains that it lists, alone or as ranges") {
  const std::string document =
      "<domains><id>3</id><id_range><min>10</min><max>12</max></id_range>"
      "<id_range><min>20</min></id_range></domains>"
      "<domains><id_range><max>1</max></id_range><id> 40 </id></domains>";
  for (int domain = 0; domain < 50; ++domain) {
    CAPTURE(domain);
    const bool is_listed =
        domain <= 1 || domain == 3 || (domain >= 10 && domain <= 12) || domain == 20 || domain == 40;
    CHECK(covers_domain(document, domain) == is_listed);
  }
}

TEST_CASE("a document without domains or with nonsense as domains covers no domain") {
  for (const char* document :
       {"", "<domains></domains>", "<id>5", "<id>five</id>", "<id></id>", "<id>5x</id>",
        "<id_range></id_range>", "<id_range><min>9</min><max>1</max></id_range>"}) {
    CAPTURE(document);
    CHECK_FALSE(covers_domain(document, 5));
  }
}

}  // namespace sidestep::signed_document_test
