#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "formats/json/json_document.h"
#include "formats/json/json_writer.h"
#include "topple/structure/formats/input_place.h"
#include "topple/structure/formats/plain_text.h"

namespace topple::structure::formats {

std::string in_quotes(std::string_view text) {
  std::size_t longest = 60;
  if (text.size() > longest)  // not in the middle of a UTF-8 character
    while (longest > 0 && (static_cast<unsigned char>(text[longest]) & 0xc0) == 0x80) --longest;
  std::string result = "\"";
  result += one_line(text.substr(0, longest));
  return result + (text.size() > longest ? "...\"" : "\"");
}

std::string quoted_list(const std::vector<std::string_view>& names) {
  constexpr std::size_t most = 24;
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) list += (i > 0 ? ", " : "") + in_quotes(names[i]);
  if (names.size() > most) list += " and " + std::to_string(names.size() - most) + " more";
  return names.empty() ? "none is defined" : list;
}

bool JsonValue::is_null() const { return slot().type == JsonDocument::Type::null; }
bool JsonValue::is_bool() const { return slot().type == JsonDocument::Type::boolean; }
bool JsonValue::is_number() const { return slot().type == JsonDocument::Type::number; }
bool JsonValue::is_text() const { return slot().type == JsonDocument::Type::text; }
bool JsonValue::is_array() const { return slot().type == JsonDocument::Type::array; }
bool JsonValue::is_object() const { return slot().type == JsonDocument::Type::object; }

double JsonValue::number(std::string_view accepted) const {
  if (!is_number()) refuse(accepted);
  // Products and ratios of two numbers are then finite, whatever the file holds.
  if (!ranges::anything.contains(slot().number)) refuse(ranges::anything.text());
  return slot().number;
}

double JsonValue::positive() const {
  const double value = number("a number above 0");
  if (!(value > 0)) refuse("a number above 0");
  if (!ranges::positive.contains(value)) refuse(ranges::positive.text());
  return value;
}

double JsonValue::not_negative() const {
  const double value = number("a number of 0 or above");
  if (!(value >= 0)) refuse("a number of 0 or above");
  return value;
}

double JsonValue::in(const NumberRange& range) const {
  const double value = number(range.text());
  if (!range.contains(value)) refuse(range.text());
  return value;
}

std::int64_t JsonValue::whole(std::int64_t least, std::int64_t most) const {
  const std::string accepted = "a whole number from " + std::to_string(least) + " to " + std::to_string(most);
  const double value = number(accepted);
  if (value != std::floor(value) || value < static_cast<double>(least) || value > static_cast<double>(most))
    refuse(accepted);
  return static_cast<std::int64_t>(value);
}

bool JsonValue::boolean() const {
  if (!is_bool()) refuse("true or false");
  return slot().number != 0;
}

std::string_view JsonValue::text(std::string_view accepted) const {
  if (!is_text()) refuse(accepted);
  return std::string_view(document_->text_).substr(slot().text, slot().text_length);
}

void JsonValue::expect_array(std::size_t least, std::size_t most) const {
  if (is_array() && slot().count >= least && slot().count <= most) return;
  if (least == most) refuse("an array of " + std::to_string(least));
  if (least <= 1) refuse(least == 0 ? "an array" : "an array that is not empty");
  refuse("an array of at least " + std::to_string(least));
}

void JsonValue::expect_object() const {
  if (!is_object()) refuse("an object");
}

void JsonValue::only(std::initializer_list<std::string_view> keys) const {
  expect_object();
  for (const JsonValue value : *this)
    if (std::find(keys.begin(), keys.end(), value.key()) == keys.end())
      value.fail("unknown key; accepted: " + quoted_list(std::vector<std::string_view>(keys)));
}

JsonValue::Iterator& JsonValue::Iterator::operator++() {
  index_ = document_->slots_[index_].next;
  return *this;
}

JsonValue::Iterator JsonValue::begin() const {
  return {*document_, is_array() || is_object() ? index_ + 1 : slot().next};
}
JsonValue::Iterator JsonValue::end() const { return {*document_, slot().next}; }
std::size_t JsonValue::size() const { return slot().count; }

std::optional<JsonValue> JsonValue::find(std::string_view key) const {
  for (const JsonValue value : *this)
    if (value.key() == key) return value;
  return std::nullopt;
}

JsonValue JsonValue::require(std::string_view key) const {
  expect_object();
  const auto value = find(key);
  if (!value) fail("the key " + in_quotes(key) + " is missing");
  return *value;
}

std::string_view JsonValue::key() const {
  return std::string_view(document_->text_).substr(slot().key, slot().key_length);
}

std::string JsonValue::found() const {
  switch (slot().type) {
    case JsonDocument::Type::null:
      return "null";
    case JsonDocument::Type::boolean:
      return slot().number != 0 ? "true" : "false";
    case JsonDocument::Type::text:
      return in_quotes(text());
    case JsonDocument::Type::array:
      return "an array of " + std::to_string(slot().count);
    case JsonDocument::Type::object:
      return "an object";
    case JsonDocument::Type::number:
      break;
  }
  char digits[32];
  const auto written = std::to_chars(digits, digits + sizeof digits, slot().number);
  return {digits, written.ptr};
}

std::string JsonValue::path() const {
  if (index_ == 0) return {};
  const JsonValue parent(*document_, slot().parent);
  const std::string before = parent.path();
  if (parent.is_object()) {
    const std::string_view name = key();
    return (before.empty() ? "" : before + ".") + std::string(name.size() > 80 ? name.substr(0, 80) : name);
  }
  std::size_t position = 0;
  for (std::uint32_t i = slot().parent + 1; i != index_; i = document_->slots_[i].next) ++position;
  return before + "[" + std::to_string(position) + "]";
}

void JsonDocument::replace_number(const JsonValue& at, double number) {
  if (slots_[at.index_].type != Type::number) throw std::invalid_argument("there is no number to replace");
  slots_[at.index_].number = number;
}

std::string JsonDocument::location(std::uint32_t line) const {
  if (line >= 1 && line <= places_.size()) return places_[line - 1];
  return name_ + ", line " + std::to_string(line);
}

void JsonValue::fail(const std::string& what) const {
  throw PlacedInputError({document_->location(slot().line), path()}, what);
}

void JsonValue::refuse(std::string_view accepted) const {
  fail("found " + found() + "; accepted: " + std::string(accepted));
}

namespace {

void write_value(JsonWriter& writer, const JsonValue& value) {
  if (value.is_object() || value.is_array()) {
    writer.open(value.is_object() ? '{' : '[');
    for (const JsonValue item : value) {
      if (value.is_object()) writer.key(item.key());
      write_value(writer, item);
    }
    writer.close(value.is_object() ? '}' : ']');
  } else if (value.is_text()) {
    writer.value(value.text());
  } else if (value.is_bool()) {
    writer.value(value.boolean());
  } else {
    writer.value(value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.number());  // NaN becomes null
  }
}

}  // namespace

std::string text_of(const JsonValue& value) {
  JsonWriter writer;
  write_value(writer, value);
  return writer.release();
}

}  // namespace topple::structure::formats
