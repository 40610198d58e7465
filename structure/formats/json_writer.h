#pragma once
// JSON text as it is made: numbers in the shortest form that reads back to the same bits.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

namespace topple::structure {

class JsonWriter {
 public:
  JsonWriter& open(char bracket) {
    separate();
    text_ += bracket;
    fresh_ = true;
    return *this;
  }
  JsonWriter& close(char bracket) {
    text_ += bracket;
    fresh_ = false;
    return *this;
  }
  JsonWriter& key(std::string_view name) {
    separate();
    quote(name);
    text_ += ':';
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
    text_ += yes ? "true" : "false";
    return *this;
  }
  JsonWriter& value(double number) {
    separate();
    // JSON has no infinities; null says that there is no finite value.
    if (!std::isfinite(number)) {
      text_ += "null";
      return *this;
    }
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, number == 0 ? 0.0 : number).ptr;
    text_.append(buffer, end);
    return *this;
  }
  JsonWriter& value(std::size_t number) {
    separate();
    text_ += std::to_string(number);
    return *this;
  }
  /// A line's end inside the text, for a person's eyes.
  JsonWriter& newline() {
    if (!fresh_ && !text_.empty()) text_ += ',';
    text_ += '\n';
    fresh_ = true;
    return *this;
  }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  void separate() {
    if (!fresh_) text_ += ',';
    fresh_ = false;
  }
  void quote(std::string_view text) {
    text_ += '"';
    const auto plain = [](char c) { return c != '"' && c != '\\' && static_cast<unsigned char>(c) >= 0x20; };
    if (std::all_of(text.begin(), text.end(), plain)) {
      text_ += text;
      text_ += '"';
      return;
    }
    for (const char c : text) {
      if (c == '"' || c == '\\') {
        text_ += '\\';
        text_ += c;
      } else if (static_cast<unsigned char>(c) < 0x20) {
        constexpr const char* hex = "0123456789abcdef";
        text_ += "\\u00";
        text_ += hex[static_cast<unsigned char>(c) >> 4];
        text_ += hex[c & 15];
      } else {
        text_ += c;
      }
    }
    text_ += '"';
  }

  std::string text_;
  bool fresh_ = true;
};

}  // namespace topple::structure
