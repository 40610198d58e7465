#pragma once
// JSON text as it is made: numbers in the shortest form that reads back to the same bits. Results are mostly numbers,
// many of them twice (a moment at an end is an end force and an extreme): the last ones are kept as text.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "formats/json/shortest_number.h"

namespace topple::structure {

class JsonWriter {
 public:
  JsonWriter() = default;
  /// Writes over the storage of an earlier text.
  explicit JsonWriter(std::string storage) : text_(std::move(storage)) {}

  JsonWriter& open(char bracket) {
    separate();
    put(bracket);
    fresh_ = true;
    return *this;
  }
  JsonWriter& close(char bracket) {
    put(bracket);
    fresh_ = false;
    return *this;
  }
  JsonWriter& key(std::string_view name) {
    separate();
    quote(name);
    put(':');
    fresh_ = true;
    return *this;
  }
  JsonWriter& value(std::string_view text) {
    separate();
    quote(text);
    return *this;
  }
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  JsonWriter& value(bool yes) {
    separate();
    put(yes ? std::string_view("true") : std::string_view("false"));
    return *this;
  }
  JsonWriter& value(double number) {
    separate();
    return compose(number_room, [&](char* at) { return write(number, at); });
  }
  JsonWriter& value(std::size_t number) {
    separate();
    put(std::to_string(number));
    return *this;
  }
  /// Text that is JSON already and ends where a value or the first of a list is to follow: in the place of key().
  JsonWriter& raw_key(std::string_view text) {
    separate();
    put(text);
    fresh_ = true;
    return *this;
  }
  /// The same as it stands, with no comma before it. Behind what closes a list or an object a comma is to follow.
  JsonWriter& raw_value(std::string_view text) {
    put(text);
    fresh_ = text.back() != ']' && text.back() != '}';
    return *this;
  }
  /// What compose(at) writes from `at` on, at most so many characters; it returns their end. As it stands, with no
  /// comma before it, and nothing is put between it and what follows but after newline().
  template <class Compose>
  JsonWriter& compose(std::size_t most, Compose compose) {
    char* at = room(most);
    used_ += static_cast<std::size_t>(compose(at) - at);
    return *this;
  }
  /// For compose(): writes a number and returns its end. Needs number_room characters to write on.
  char* write(double number, char* at) {
    const auto bits = std::bit_cast<std::uint64_t>(number);
    constexpr std::uint64_t sign = std::uint64_t{1} << 63, infinite = std::uint64_t{0x7ff} << 52,
                            golden = 0x9e3779b97f4a7c15;
    const std::uint64_t size = bits & ~sign;
    if (size == 0) {
      *at = '0';
      return at + 1;
    }
    // JSON has no infinities; null says that there is no finite value.
    if (size >= infinite) [[unlikely]]
      return static_cast<char*>(std::memcpy(at, "null", 4)) + 4;
    *at = '-';
    at += bits >> 63;
    Number& kept = numbers_[(size * golden) >> (64 - kept_bits)];
    if (kept.bits != size) {
      kept.bits = size;
      kept.length = static_cast<std::uint8_t>(write_shortest(std::abs(number), at) - at);
      std::memcpy(kept.text, at, sizeof kept.text);
    } else {
      std::memcpy(at, kept.text, sizeof kept.text);
    }
    return at + kept.length;
  }
  /// What comes next follows an item of the same list or object, which another writer wrote.
  JsonWriter& follow() {
    fresh_ = false;
    started_ = true;
    return *this;
  }
  /// A line's end inside the text, for a person's eyes.
  JsonWriter& newline() {
    if (!fresh_ && started_) put(',');
    put('\n');
    fresh_ = true;
    return *this;
  }
  /// All of the text.
  [[nodiscard]] std::string release() {
    text_.resize(used_);
    used_ = 0;
    return std::move(text_);
  }

 private:
  static constexpr int kept_bits = 7;
  struct Number {
    std::uint64_t bits = 0;
    std::uint8_t length = 0;
    char text[longest_number]{};
  };

  /// Space for so many characters behind what is there.
  char* room(std::size_t count) {
    if (used_ + count > text_.size())
      text_.resize(std::max({text_.size() + text_.size() / 2, used_ + count, std::size_t{64}}));
    started_ = true;
    return text_.data() + used_;
  }
  void put(char c) {
    *room(1) = c;
    ++used_;
  }
  void put(std::string_view text) {
    std::memcpy(room(text.size()), text.data(), text.size());
    used_ += text.size();
  }
  void separate() {
    if (!fresh_) put(',');
    fresh_ = false;
  }
  void quote(std::string_view text) {
    put('"');
    const auto plain = [](char c) { return c != '"' && c != '\\' && static_cast<unsigned char>(c) >= 0x20; };
    if (std::all_of(text.begin(), text.end(), plain)) {
      put(text);
      put('"');
      return;
    }
    for (const char c : text) {
      if (c == '"' || c == '\\') {
        put('\\');
        put(c);
      } else if (static_cast<unsigned char>(c) < 0x20) {
        constexpr const char* hex = "0123456789abcdef";
        put("\\u00");
        put(hex[static_cast<unsigned char>(c) >> 4]);
        put(hex[c & 15]);
      } else {
        put(c);
      }
    }
    put('"');
  }

  std::string text_;  ///< as large as it may become before it grows; the first `used_` characters count
  std::size_t used_ = 0;
  bool fresh_ = true, started_ = false;
  std::array<Number, std::size_t{1} << kept_bits> numbers_{};
};

/// A number by itself, as JsonWriter has it.
[[nodiscard]] inline std::string json_number(double number) {
  if (!std::isfinite(number)) return "null";
  if (number == 0) return "0";
  char text[number_room + 1] = {'-'};
  const char *begin = number < 0 ? text : text + 1, *end = write_shortest(std::abs(number), text + 1);
  return {begin, end};
}

/// A name as the key of an object, for raw_key().
[[nodiscard]] inline std::string json_key(std::string_view name) {
  JsonWriter writer;
  return writer.key(name).release();
}

}  // namespace topple::structure
