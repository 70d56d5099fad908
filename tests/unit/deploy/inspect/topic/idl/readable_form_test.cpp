// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/idl/readable_form.hpp"

#include "deploy/inspect/topic/idl/idl_parser.hpp"
#include "tests/catch.hpp"

namespace sidestep::readable_form_test {

using Json = nlohmann::ordered_json;

/// The readable form of a value of the struct T.
Json readable(const std::string& idl, Json value, const Rewrites& rewrites = {}) {
  ReadableForm(*parse_idl(idl, "test.idl").at("T"), rewrites).apply(value);
  return value;
}

TEST_CASE("enumerators become words without their common prefix") {
  const std::string idl =
      "enum E { ROAD_SIGN_ONE, ROAD_SIGN_TWO_WAY }; enum F { ALPHA, ALSO }; enum G { G_MIXED_a }; "
      "@final struct T { E e; F f; G g; sequence<E> list; };";
  CHECK(
      readable(
          idl,
          {{"e", "ROAD_SIGN_TWO_WAY"}, {"f", "ALSO"}, {"g", "G_MIXED_a"}, {"list", {"ROAD_SIGN_ONE", 2}}}) ==
      Json{{"e", "two way"}, {"f", "also"}, {"g", "a"}, {"list", {"one", "unknown 2"}}});
}

TEST_CASE("an array is cut to the length that its count member states") {
  const std::string idl =
      "@final struct P { double x; }; @final struct T { octet part_count; P parts[3]; P spares[3]; "
      "sequence<P> orphans; unsigned long orphan_count; string leg_count; octet legs[2]; };";
  const Json all = {{{"x", 1.0}}, {{"x", 2.0}}, {{"x", 3.0}}};
  const auto message = [&](int count, const Json& parts) {
    return Json{{"part_count", count}, {"parts", parts},     {"spares", all}, {"orphans", all},
                {"orphan_count", 1},   {"leg_count", "two"}, {"legs", {1, 2}}};
  };
  CHECK(readable(idl, message(0, all)) == message(0, Json::array()));
  CHECK(readable(idl, message(2, all)) == message(2, {{{"x", 1.0}}, {{"x", 2.0}}}));
  CHECK(readable(idl, message(255, all)) == message(255, all));
}

TEST_CASE("values can be rewritten by struct type or by member") {
  const Rewrites rewrites{{"m::P", [](const Json& p) { return Json(p["x"].get<int>() + 1); }},
                          {"m::T.code", [](const Json&) { return Json("secret"); }}};
  const std::string idl =
      "module m { @final struct P { long x; }; @final struct T { P p; P list[2]; long code; }; };";
  Json value{{"p", {{"x", 1}}}, {"list", {{{"x", 2}}, {{"x", 3}}}}, {"code", 7}};
  const ReadableForm form(*parse_idl(idl, "test.idl").at("m::T"), rewrites);
  form.apply(value);
  CHECK(value == Json{{"p", 2}, {"list", {3, 4}}, {"code", "secret"}});
}

TEST_CASE("values that are already readable are not changed") {
  const std::string idl =
      "@final struct P { double x; }; @final struct T { P p; sequence<P> list; string s; boolean b; };";
  CHECK(ReadableForm(*parse_idl(idl, "test.idl").at("T"), {}).is_exact());
}

}  // namespace sidestep::readable_form_test
