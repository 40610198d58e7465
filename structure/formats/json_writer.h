#pragma once
// JSON text as it is made: numbers in the shortest form that reads back to the same bits. Results are mostly numbers,
// many of them twice (a moment at an end is an end force and an extreme): the last ones are kept as text.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace topple::structure {

class JsonWriter {
 public:
  /// Takes the text in pieces, in order.
  using Sink = std::function<void(std::string_view)>;

  JsonWriter() = default;
  /// Hands its text on at the end of lines, so that it never holds much of it. Call finish() at the end.
  explicit JsonWriter(Sink sink) : sink_(std::move(sink)) {}

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
    char* at = room(longest_number);
    // JSON has no infinities; null says that there is no finite value.
    if (!std::isfinite(number)) {
      std::memcpy(at, "null", 4);
      used_ += 4;
      return *this;
    }
    if (number == 0) {
      *at = '0';
      ++used_;
      return *this;
    }
    const auto bits = std::bit_cast<std::uint64_t>(number);
    constexpr std::uint64_t sign = std::uint64_t{1} << 63, golden = 0x9e3779b97f4a7c15;
    if ((bits & sign) != 0) {
      *at++ = '-';
      ++used_;
    }
    Number& kept = numbers_[((bits & ~sign) * golden) >> (64 - kept_bits)];
    if (kept.bits != (bits & ~sign)) {
      kept.bits = bits & ~sign;
      const char* end = std::to_chars(kept.text, kept.text + sizeof kept.text, std::abs(number)).ptr;
      kept.length = static_cast<std::uint8_t>(end - kept.text);
    }
    std::memcpy(at, kept.text, sizeof kept.text);
    used_ += kept.length;
    return *this;
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
  /// Items of a list or an object as another writer made them: they begin with a line's end.
  JsonWriter& item(std::string_view text) {
    separate();
    if (sink_) {
      hand_on();
      sink_(text);
    } else {
      put(text);
    }
    return *this;
  }
  /// A line's end inside the text, for a person's eyes.
  JsonWriter& newline() {
    if (!fresh_ && started_) put(',');
    if (sink_ && used_ >= handed_on_at_once) hand_on();
    put('\n');
    fresh_ = true;
    return *this;
  }
  /// All of the text, of a writer without a sink.
  [[nodiscard]] std::string take() {
    text_.resize(used_);
    used_ = 0;
    return std::move(text_);
  }
  /// Ends the last line and hands on what is left.
  void finish() {
    put('\n');
    hand_on();
  }

 private:
  static constexpr std::size_t longest_number = 32, handed_on_at_once = std::size_t{1} << 19;
  static constexpr int kept_bits = 7;
  struct Number {
    std::uint64_t bits = 0;
    std::uint8_t length = 0;
    char text[24]{};
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
  void hand_on() {
    sink_(std::string_view(text_).substr(0, used_));
    used_ = 0;
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

  Sink sink_;
  std::string text_;  ///< as large as it may become before it grows; the first `used_` characters count
  std::size_t used_ = 0;
  bool fresh_ = true, started_ = false;
  std::array<Number, std::size_t{1} << kept_bits> numbers_{};
};

/// A number by itself, as JsonWriter has it.
[[nodiscard]] inline std::string json_number(double number) {
  if (!std::isfinite(number)) return "null";
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number == 0 ? 0.0 : number).ptr};
}

/// A name as the key of an object, for raw_key().
[[nodiscard]] inline std::string json_key(std::string_view name) {
  JsonWriter writer;
  return writer.key(name).take();
}

}  // namespace topple::structure
