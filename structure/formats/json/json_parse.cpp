// From text to JsonDocument: by a scanner of our own where the text is plain and regular, which all but few are, and
// through the event interface of nlohmann-json for everything else: escapes, characters beyond ASCII, and every error.
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "formats/json/json_document.h"
#include "formats/json/plain_json.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/input_files.h"
#include "topple/structure/formats/input_place.h"
#include "topple/structure/formats/plain_text.h"

namespace topple::structure::formats {

namespace {

/// Characters of a text or a file with their line and column, a buffer at a time.
class Characters {
 public:
  explicit Characters(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}
  explicit Characters(std::istream& stream) : stream_(&stream), buffer_(std::size_t{1} << 16) { refill(); }

  [[nodiscard]] bool done() const { return at_ == end_; }
  /// nlohmann takes a zero byte for the end.
  [[nodiscard]] bool met_zero() const { return zero_; }
  [[nodiscard]] char current() const { return *at_; }
  void advance() {
    const char c = *at_++;
    zero_ = zero_ || c == '\0';
    ++column_;
    ++since_event_;
    if (c == '\n') {
      ++line_;
      column_ = 0;
    } else if (c != ' ' && c != '\t' && c != '\r') {
      token_line_ = line_;
      token_column_ = column_;
    }
    if (at_ == end_ && stream_ != nullptr) refill();
  }
  /// Of the last character that was no space: the end of the token just read.
  [[nodiscard]] std::uint32_t line() const { return token_line_; }
  [[nodiscard]] std::uint32_t column() const { return token_column_; }
  [[nodiscard]] std::size_t since_event() const { return since_event_; }
  void event() { since_event_ = 0; }
  /// For one that reads the text by itself.
  void set_line(std::uint32_t line) { token_line_ = line; }

 private:
  void refill() {
    stream_->read(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    at_ = buffer_.data();
    end_ = at_ + stream_->gcount();
  }

  std::istream* stream_ = nullptr;
  std::vector<char> buffer_;
  const char* at_ = nullptr;
  const char* end_ = nullptr;
  std::uint32_t line_ = 1, column_ = 0, token_line_ = 1, token_column_ = 0;
  std::size_t since_event_ = 0;
  bool zero_ = false;
};

struct TokenTooLong {};

/// What nlohmann reads from. Copies share the characters: it is an input iterator.
class CharacterIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = char;

  CharacterIterator() = default;
  CharacterIterator(Characters& characters, std::size_t token_limit)
      : characters_(&characters), token_limit_(token_limit) {}
  char operator*() const { return characters_->current(); }
  CharacterIterator& operator++() {
    characters_->advance();
    if (characters_->since_event() > token_limit_) throw TokenTooLong{};
    return *this;
  }
  bool operator==(const CharacterIterator& other) const { return done() == other.done(); }
  bool operator!=(const CharacterIterator& other) const { return !(*this == other); }

 private:
  [[nodiscard]] bool done() const { return characters_ == nullptr || characters_->done(); }
  Characters* characters_ = nullptr;
  std::size_t token_limit_ = 0;
};

/// nlohmann's message without its own prefixes: "syntax error while parsing value - unexpected ..."
std::string plain_message(std::string message) {
  if (const auto bracket = message.find("] "); message.starts_with('[') && bracket != std::string::npos)
    message.erase(0, bracket + 2);
  if (const auto colon = message.find(": "); message.starts_with("parse error at line") && colon != std::string::npos)
    message.erase(0, colon + 2);
  std::string printable;
  for (const char c : message) {  // the text read may hold any byte, broken UTF-8 included
    const auto byte = static_cast<unsigned char>(c);
    printable += byte < 0x20 ? ' ' : byte < 0x7f ? c : '?';
  }
  if (printable.size() > 200) printable = printable.substr(0, 200) + "...";
  return printable;
}

}  // namespace

/// Receives the events of the parser and lays the values down.
class JsonBuilder {
 public:
  using number_integer_t = nlohmann::json::number_integer_t;
  using number_unsigned_t = nlohmann::json::number_unsigned_t;
  using number_float_t = nlohmann::json::number_float_t;
  using string_t = nlohmann::json::string_t;
  using binary_t = nlohmann::json::binary_t;

  JsonBuilder(JsonDocument& document, Characters& characters, const JsonLimits& limits)
      : document_(document), characters_(characters), limits_(limits) {}

  bool null() { return add(JsonDocument::Type::null), true; }
  bool boolean(bool value) { return number_of(JsonDocument::Type::boolean, value ? 1 : 0); }
  bool number_integer(number_integer_t value) {
    return number_of(JsonDocument::Type::number, static_cast<double>(value));
  }
  bool number_unsigned(number_unsigned_t value) {
    return number_of(JsonDocument::Type::number, static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t&) { return number_of(JsonDocument::Type::number, value); }
  bool string(const string_t& value) { return string(plain(value)); }
  bool string(std::string_view value) {
    auto& slot = add(JsonDocument::Type::text);
    slot.text = document_.text_.size();
    slot.text_length = static_cast<std::uint32_t>(value.size());
    document_.text_ += value;
    return true;
  }
  bool binary(binary_t&) { return false; }
  bool start_object(std::size_t) { return open(JsonDocument::Type::object); }
  bool start_array(std::size_t) { return open(JsonDocument::Type::array); }
  bool end_object() {
    if (keys_may_repeat()) refuse_duplicate_keys();
    return close();
  }
  bool end_array() { return close(); }
  bool key(const string_t& value) { return key(plain(value)); }
  bool key(std::string_view value) {
    key_ = document_.text_.size();
    key_length_ = static_cast<std::uint32_t>(value.size());
    document_.text_ += value;
    characters_.event();
    return true;
  }
  bool number(double value) { return number_of(JsonDocument::Type::number, value); }
  void at_line(std::uint32_t line) { characters_.set_line(line); }
  [[nodiscard]] bool full() const { return document_.slots_.size() >= limits_.values; }
  /// Leaves nothing in the document.
  void forget() {
    document_.slots_.clear();
    document_.text_.clear();
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception& error) {
    fail(plain_message(error.what()));
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw PlacedInputError({document_.name_ + ", line " + std::to_string(characters_.line()) + ", column " +
                                std::to_string(characters_.column()),
                            {}},
                           what);
  }

 private:
  /// Names and titles reach terminals, tables and pages: what steers one is refused where it comes in.
  std::string_view plain(const string_t& value) const {
    if (first_control(value) != std::string_view::npos)
      fail("a control character in " + in_quotes(value) + "; accepted: text of one line");
    return value;
  }
  bool number_of(JsonDocument::Type type, double value) {
    add(type).number = value;
    return true;
  }
  JsonDocument::Slot& add(JsonDocument::Type type) {
    characters_.event();
    auto& slots = document_.slots_;
    if (slots.size() >= limits_.values) fail("more than " + std::to_string(limits_.values) + " values in one file");
    const auto index = static_cast<std::uint32_t>(slots.size());
    JsonDocument::Slot& slot = slots.emplace_back();
    slot.type = type;
    slot.line = characters_.line();
    slot.next = index + 1;
    if (!open_.empty()) {
      slot.parent = open_.back();
      ++slots[open_.back()].count;
      slot.key = key_;
      slot.key_length = key_length_;
    }
    key_ = 0;
    key_length_ = 0;
    return slot;
  }
  bool open(JsonDocument::Type type) {
    if (open_.size() >= limits_.depth)
      fail("brackets nested more than " + std::to_string(limits_.depth) + " deep; accepted: a file of this format");
    add(type);
    open_.push_back(static_cast<std::uint32_t>(document_.slots_.size() - 1));
    return true;
  }
  bool close() {
    characters_.event();
    document_.slots_[open_.back()].next = static_cast<std::uint32_t>(document_.slots_.size());
    open_.pop_back();
    return true;
  }
  /// By comparing all in a small object, by their hashes in a large one: equal hashes are looked into by names.
  bool keys_may_repeat() {
    const auto& slots = document_.slots_;
    const std::string_view text = document_.text_;
    const auto name = [&](std::uint32_t i) { return text.substr(slots[i].key, slots[i].key_length); };
    const std::uint32_t first = open_.back() + 1, end = static_cast<std::uint32_t>(slots.size());
    constexpr std::uint32_t few = 12;
    if (slots[open_.back()].count <= few) {
      for (std::uint32_t i = first; i < end; i = slots[i].next)
        for (std::uint32_t j = first; j < i; j = slots[j].next)
          if (name(i) == name(j)) return true;
      return false;
    }
    hashes_.clear();
    for (std::uint32_t i = first; i < end; i = slots[i].next) hashes_.push_back(std::hash<std::string_view>()(name(i)));
    std::sort(hashes_.begin(), hashes_.end());
    return std::adjacent_find(hashes_.begin(), hashes_.end()) != hashes_.end();
  }
  void refuse_duplicate_keys() {
    const auto& slots = document_.slots_;
    keys_.clear();
    const auto end = static_cast<std::uint32_t>(slots.size());
    for (std::uint32_t i = open_.back() + 1; i < end; i = slots[i].next) keys_.push_back(i);
    const auto name = [&](std::uint32_t i) {
      return std::string_view(document_.text_).substr(slots[i].key, slots[i].key_length);
    };
    std::sort(keys_.begin(), keys_.end(),
              [&](std::uint32_t a, std::uint32_t b) { return name(a) != name(b) ? name(a) < name(b) : a < b; });
    const auto twice = std::adjacent_find(keys_.begin(), keys_.end(),
                                          [&](std::uint32_t a, std::uint32_t b) { return name(a) == name(b); });
    if (twice == keys_.end()) return;
    JsonValue(document_, *(twice + 1))
        .fail("this name stands twice, first in line " + std::to_string(slots[*twice].line) +
              "; accepted: each name once");
  }

  JsonDocument& document_;
  Characters& characters_;
  JsonLimits limits_;
  std::vector<std::uint32_t> open_, keys_;
  std::vector<std::size_t> hashes_;
  std::uint64_t key_ = 0;
  std::uint32_t key_length_ = 0;
};

namespace {

/// Whether the text was plain; if not, nothing is left of it in the document.
bool parse_plain(JsonDocument& document, std::string_view text, const JsonLimits& limits) {
  Characters places(text);
  JsonBuilder builder(document, places, limits);
  if (PlainScanner(text, builder, limits).scan()) return true;
  builder.forget();
  return false;
}

void parse(JsonDocument& document, Characters& characters, const JsonLimits& limits) {
  JsonBuilder builder(document, characters, limits);
  try {
    if (!nlohmann::json::sax_parse(CharacterIterator(characters, limits.token), CharacterIterator(), &builder))
      builder.fail("not a JSON text");
  } catch (const TokenTooLong&) {
    builder.fail("a name, number or run of spaces of more than " + std::to_string(limits.token) + " characters");
  }
  if (characters.met_zero()) builder.fail("a zero byte; accepted: nothing after the JSON text");
}

}  // namespace

JsonDocument JsonDocument::from_file(const std::filesystem::path& file, const JsonLimits& limits) {
  JsonDocument document;
  document.name_ = one_line(file.filename().string());
  std::error_code ignored;
  require_readable(file);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file.string() + ": cannot be opened; accepted: a file that exists and can be read");
  constexpr std::uintmax_t held_at_once = std::uintmax_t{1} << 28;
  const std::uintmax_t size = std::filesystem::file_size(file, ignored);
  if (!ignored && size <= held_at_once) {
    std::string text(static_cast<std::size_t>(size), '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (static_cast<std::uintmax_t>(stream.gcount()) == size && parse_plain(document, text, limits)) return document;
    stream.clear();
    stream.seekg(0);
  }
  Characters characters(stream);
  parse(document, characters, limits);
  return document;
}

JsonDocument JsonDocument::from_text(std::string_view text, const std::string& name, const JsonLimits& limits,
                                     std::vector<std::string> places) {
  JsonDocument document;
  document.name_ = one_line(name);
  document.places_ = std::move(places);
  if (parse_plain(document, text, limits)) return document;
  Characters characters(text);
  parse(document, characters, limits);
  return document;
}

}  // namespace topple::structure::formats
