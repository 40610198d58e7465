#include "formats/frame3dd/frame3dd_tokens.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>

#include "topple/structure/error.h"
#include "topple/structure/formats/input_place.h"
#include "topple/structure/formats/plain_text.h"

namespace topple::structure {

namespace {

constexpr std::string_view separators = " \t\r\v\f,;\"";
constexpr std::string_view comment_signs = "#%?";

std::string shown(std::string_view text) {
  constexpr std::size_t longest = 40;  // of what is repeated in a message
  std::string out;
  for (const char c : text.substr(0, longest)) out += (c >= ' ' && c <= '~') ? c : '?';
  return text.size() > longest ? out + "..." : out;
}

std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

}  // namespace

Frame3ddTokens::Frame3ddTokens(std::string_view text, std::string file) : file_(one_line(file)) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view content = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    last_line_ = line;
    if (line == 1) {
      title_ = std::string(content.substr(0, content.find_last_not_of(" \t\r") + 1));
      if (first_not_utf8(title_) != std::string::npos) fail("the title is not UTF-8; accepted: a title in UTF-8");
      if (first_control(title_) != std::string::npos) fail("a control character in the title; accepted: text");
      continue;
    }
    content = content.substr(0, content.find_first_of(comment_signs));
    if (content.starts_with('_')) break;  // the end of the data, whatever follows
    for (std::size_t at = content.find_first_not_of(separators); at != std::string_view::npos;) {
      const std::size_t stop = std::min(content.find_first_of(separators, at), content.size());
      tokens_.push_back({content.substr(at, stop - at), line});
      at = content.find_first_not_of(separators, stop);
    }
  }
}

const Frame3ddTokens::Token& Frame3ddTokens::next_token(const std::string& what) {
  if (at_end()) fail("the file ends where " + what + " is expected");
  last_line_ = tokens_[next_].line;
  return tokens_[next_++];
}

void Frame3ddTokens::fail(const std::string& problem) const {
  throw PlacedInputError({file_ + ":" + std::to_string(last_line_), {}}, problem);
}

double Frame3ddTokens::number(const std::string& what) {
  std::string_view text = next_token(what).text;
  const std::string_view found = text;
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);  // from_chars takes no plus sign
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size() || !std::isfinite(value))
    fail(what + ": found '" + shown(found) + "', accepted is a finite number");
  return value;
}

double Frame3ddTokens::number_from(const std::string& what, double least) {
  const double value = number(what);
  if (value < least) fail(what + ": found " + shown(value) + ", accepted is a number from " + shown(least));
  return value;
}

double Frame3ddTokens::number_above(const std::string& what, double bound) {
  const double value = number(what);
  if (!(value > bound)) fail(what + ": found " + shown(value) + ", accepted is a number above " + shown(bound));
  return value;
}

int Frame3ddTokens::whole(const std::string& what, int least, int most) {
  const double value = number(what);
  if (value != std::floor(value) || value < least || value > most)
    fail(what + ": found " + shown(value) + ", accepted is a whole number from " + std::to_string(least) + " to " +
         std::to_string(most));
  return static_cast<int>(value);
}

int Frame3ddTokens::count(const std::string& what, int least, int numbers_each) {
  const int value = whole(what, least, std::numeric_limits<int>::max());
  if (static_cast<std::size_t>(value) > (tokens_.size() - next_) / static_cast<std::size_t>(numbers_each))
    fail(what + ": found " + std::to_string(value) + ", more than the rest of the file holds");
  return value;
}

bool Frame3ddTokens::flag(const std::string& what) { return whole(what, 0, 1) == 1; }

}  // namespace topple::structure
