// Texts from outside: what is UTF-8, what steers a terminal, and what readers do with either.
#include "topple/structure/formats/plain_text.h"

#include <catch2/catch.hpp>

#include "example_model.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/convert.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;
using topple::test::example_model;
using topple::test::replaced;

TEST_CASE("UTF-8 is told from what only looks like it") {
  for (const char* sound : {"", "plain",
                            "Stra\xC3\x9F"
                            "e",
                            "\xE2\x82\xAC", "\xF0\x9F\x8F\x97", "\xED\x9F\xBF", "\xF4\x8F\xBF\xBF"})
    CHECK(first_not_utf8(sound) == std::string_view::npos);
  // Latin-1, a lone continuation, cut short, overlong, a surrogate, beyond the last character, a byte that none has.
  for (const char* broken : {"b\xE4y", "b\x80", "b\xE2\x82", "b\xC0\xAF", "b\xE0\x80\xAF", "b\xED\xA0\x80",
                             "b\xF4\x90\x80\x80", "b\xFF", "b\xF0\x80\x80\xAF"}) {
    CHECK(first_not_utf8(broken) == 1);
    CHECK(first_not_utf8(one_line(broken)) == std::string_view::npos);
  }
}

TEST_CASE("a line shows no character that steers a terminal") {
  for (int code = 0; code < 0x20; ++code) {
    const std::string text = std::string("a") + static_cast<char>(code) + "b";
    CHECK(one_line(text) == (code == '\t' ? text : "a?b"));
  }
  for (const char* steering : {"\x7F", "\xC2\x9B", "\xC2\x80", "\xE2\x80\xA8", "\xE2\x80\xAE", "\xE2\x81\xA6"}) {
    CHECK(first_control(std::string("ab") + steering) == 2);
    CHECK(one_line(steering) == "?");
  }
  CHECK(first_control("Stra\xC3\x9F"
                      "e\t\xE2\x82\xAC") == std::string_view::npos);
}

TEST_CASE("models whose texts are not UTF-8 or steer a terminal are refused, in every format") {
  const auto refused = [](const auto& read) { CHECK_THROWS_AS(read(), InputError); };
  for (const std::string bad : {"b\xE4y", "\\u001b[31m", "two\\nlines", "\\u007f", "\\u0000", "\\u202e"}) {
    refused([&] { (void)parse_model(replaced(example_model, "\"PA\"", "\"P" + bad + "\""), "m.json"); });
    refused([&] {
      (void)parse_model(replaced(example_model, "\"topple\": 1", "\"topple\": 1, \"title\": \"" + bad + "\""),
                        "m.json");
    });
  }
  for (const std::string bad : {"b\xE4y", "b\x1B[31m", "b\x7F"})
    refused([&] { (void)parse_tables({{"nodes.csv", "name,x,y,z\n" + bad + ",0,0,0\n"}}, "t"); });
}

TEST_CASE("nothing may follow a JSON text, a zero byte included") {
  std::string text = example_model;
  CHECK_NOTHROW(parse_model(text, "m.json"));
  CHECK_THROWS_AS(parse_model(text + '\0', "m.json"), InputError);
  CHECK_THROWS_AS(parse_model(text + '\0' + "and more", "m.json"), InputError);
}
