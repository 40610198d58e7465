#pragma once
// A scanner for JSON texts in which nothing is out of the ordinary: ASCII without escapes, well formed, within all
// limits. It gives up at anything else and says nothing about it: another reader then tells what is wrong, if anything
// is.
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <system_error>

#include "formats/json/json_document.h"

namespace topple::structure::formats {

/// Scans a text in which nothing is out of the ordinary: scan() is false, wherever it stands, for anything else.
/// `Events` is told what comes by null(), boolean(), number(), string(), key(), start_object() and so on, each of which
/// returns true to go on. at_line() comes before each, with the line of its last character. full() returns true when no
/// more values are taken.
template <class Events>
class PlainScanner {
 public:
  PlainScanner(std::string_view text, Events& events, const JsonLimits& limits)
      : at_(text.data()), end_(text.data() + text.size()), events_(events), limits_(limits) {}

  bool scan() {
    skip_spaces();
    if (!value()) return false;
    skip_spaces();
    return at_ == end_ && !irregular_;
  }

 private:
  bool value() {
    if (at_ == end_ || irregular_ || events_.full()) return false;
    events_.at_line(line_);
    switch (*at_) {
      case '{':
        return object();
      case '[':
        return array();
      case '"': {
        std::string_view text;
        return string(text) && events_.string(text);
      }
      case 't':
        return word("true") && events_.boolean(true);
      case 'f':
        return word("false") && events_.boolean(false);
      case 'n':
        return word("null") && events_.null();
      default:
        return number();
    }
  }

  bool object() {
    if (++depth_ > limits_.depth) return false;
    ++at_;
    events_.start_object(0);
    skip_spaces();
    if (at_ != end_ && *at_ == '}') return close_object();
    for (;;) {
      std::string_view name;
      if (at_ == end_ || *at_ != '"' || !string(name)) return false;
      events_.key(name);
      skip_spaces();
      if (at_ == end_ || *at_ != ':') return false;
      ++at_;
      skip_spaces();
      if (!value()) return false;
      skip_spaces();
      if (at_ == end_) return false;
      if (*at_ == '}') return close_object();
      if (*at_ != ',') return false;
      ++at_;
      skip_spaces();
    }
  }
  bool close_object() {
    ++at_;
    --depth_;
    events_.at_line(line_);
    return events_.end_object();
  }

  bool array() {
    if (++depth_ > limits_.depth) return false;
    ++at_;
    events_.start_array(0);
    skip_spaces();
    if (at_ != end_ && *at_ == ']') return close_array();
    for (;;) {
      if (!value()) return false;
      skip_spaces();
      if (at_ == end_) return false;
      if (*at_ == ']') return close_array();
      if (*at_ != ',') return false;
      ++at_;
      skip_spaces();
    }
  }
  bool close_array() {
    ++at_;
    --depth_;
    return events_.end_array();
  }

  bool string(std::string_view& text) {
    const char* from = ++at_;
    while (at_ != end_ && *at_ != '"' && *at_ != '\\' && *at_ >= 0x20 && *at_ < 0x7f) ++at_;
    if (at_ == end_ || *at_ != '"') return false;
    text = {from, static_cast<std::size_t>(at_ - from)};
    ++at_;
    return text.size() < limits_.token / 2;
  }

  bool word(std::string_view expected) {
    if (static_cast<std::size_t>(end_ - at_) < expected.size()) return false;
    if (std::memcmp(at_, expected.data(), expected.size()) != 0) return false;
    at_ += expected.size();
    return true;
  }

  bool digits() {
    const char* from = at_;
    while (at_ != end_ && *at_ >= '0' && *at_ <= '9') ++at_;
    return at_ != from;
  }
  bool number() {
    const char* from = at_;
    if (*at_ == '-') ++at_;
    const char* whole = at_;
    if (!digits() || (*whole == '0' && at_ - whole > 1)) return false;
    bool integer = true;
    if (at_ != end_ && *at_ == '.') {
      integer = false;
      ++at_;
      if (!digits()) return false;
    }
    if (at_ != end_ && (*at_ == 'e' || *at_ == 'E')) {
      integer = false;
      ++at_;
      if (at_ != end_ && (*at_ == '+' || *at_ == '-')) ++at_;
      if (!digits()) return false;
    }
    double value = 0;
    const auto [read_to, fault] = std::from_chars(from, at_, value);
    constexpr std::ptrdiff_t longest = 1000;
    if (fault != std::errc() || read_to != at_ || at_ - from > longest) return false;
    return events_.number(integer && value == 0 ? 0.0 : value);
  }

  void skip_spaces() {
    const char* from = at_;
    for (; at_ != end_; ++at_) {
      if (*at_ == '\n') {
        ++line_;
      } else if (*at_ != ' ' && *at_ != '\t' && *at_ != '\r') {
        break;
      }
    }
    if (static_cast<std::size_t>(at_ - from) > limits_.token / 2) irregular_ = true;
  }

  const char* at_;
  const char* end_;
  std::uint32_t line_ = 1;
  std::size_t depth_ = 0;
  bool irregular_ = false;
  Events& events_;
  const JsonLimits& limits_;
};

}  // namespace topple::structure::formats
