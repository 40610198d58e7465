#include "topple/structure/formats/json_tree.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "formats/json/json_document.h"
#include "topple/structure/formats/plain_text.h"

namespace topple::structure {

namespace {

/// As most writers of JSON have it: no exponent from 1e-4 up to 1e15.
void write_number(std::string& out, double number) {
  if (!std::isfinite(number)) {
    out += "null";
    return;
  }
  const double size = std::abs(number);
  const bool plain = size == 0 || (size >= 1e-4 && size < 1e15);
  char digits[40];
  const auto end = std::to_chars(digits, digits + sizeof digits, number,
                                 plain ? std::chars_format::fixed : std::chars_format::scientific)
                       .ptr;
  out.append(digits, end);
  if (plain && std::find(digits, end, '.') == end) out += ".0";
}

template <class Whole>
void write_whole(std::string& out, Whole number) {
  char digits[24];
  out.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
}

void write_escaped(std::string& out, char c) {
  constexpr std::string_view plain = "\"\\\b\f\n\r\t", letters = "\"\\bfnrt";
  constexpr const char* hex = "0123456789abcdef";
  const std::size_t at = plain.find(c);
  out += '\\';
  if (at != std::string_view::npos) {
    out += letters[at];
    return;
  }
  out += "u00";
  out += hex[static_cast<unsigned char>(c) >> 4];
  out += hex[static_cast<unsigned char>(c) & 15];
}

void write_text(std::string& out, std::string_view text) {
  out += '"';
  for (std::size_t wrong = first_not_utf8(text);; wrong = first_not_utf8(text)) {
    for (const char c : text.substr(0, wrong))
      if (c == '"' || c == '\\' || static_cast<unsigned char>(c) < 0x20)
        write_escaped(out, c);
      else
        out += c;
    if (wrong == std::string_view::npos) break;
    out += "\xEF\xBF\xBD";
    text.remove_prefix(wrong + 1);
  }
  out += '"';
}

JsonTree tree_of(const formats::JsonValue& value) {
  if (value.is_object() || value.is_array()) {
    JsonTree tree = value.is_object() ? JsonTree::object() : JsonTree::array();
    for (const formats::JsonValue item : value)
      value.is_object() ? tree.add(item.key(), tree_of(item)) : tree.push_back(tree_of(item));
    return tree;
  }
  if (value.is_text()) return value.text();
  if (value.is_bool()) return value.boolean();
  if (value.is_null()) return {};
  constexpr double exact = 9007199254740992;  // 2^53: whole numbers up to it are exact
  const double number = value.number();
  if (number == std::floor(number) && std::abs(number) < exact) return static_cast<std::int64_t>(number);
  return number;
}

}  // namespace

bool JsonTree::Item::is_field() const {
  const List* pair = std::get_if<List>(&value_.value_);
  return pair != nullptr && pair->size() == 2 && pair->front().is_text();
}

JsonTree::JsonTree(std::initializer_list<Item> items) {
  if (!std::all_of(items.begin(), items.end(), [](const Item& item) { return item.is_field(); })) {
    *this = array(items);
    return;
  }
  std::vector<Field>& fields = value_.emplace<Fields>().all;
  fields.reserve(items.size());
  for (const Item& item : items) {
    JsonTree pair = item.extract();
    List& both = std::get<List>(pair.value_);
    fields.push_back({std::move(std::get<std::string>(both[0].value_)), std::move(both[1])});
  }
}

JsonTree JsonTree::array(std::initializer_list<Item> items) {
  JsonTree tree;
  List& list = tree.value_.emplace<List>();
  list.reserve(items.size());
  for (const Item& item : items) list.push_back(item.extract());
  return tree;
}

JsonTree JsonTree::object() {
  JsonTree tree;
  tree.value_.emplace<Fields>();
  return tree;
}

JsonTree JsonTree::parse(std::string_view text) {
  return tree_of(formats::JsonDocument::from_text(text, "JSON text").root());
}

bool JsonTree::is_number() const {
  return std::holds_alternative<double>(value_) || std::holds_alternative<std::int64_t>(value_) ||
         std::holds_alternative<std::uint64_t>(value_);
}

std::size_t JsonTree::size() const {
  if (const List* list = std::get_if<List>(&value_)) return list->size();
  if (const Fields* fields = std::get_if<Fields>(&value_)) return fields->all.size();
  return 0;
}

double JsonTree::number() const {
  if (const auto* whole = std::get_if<std::int64_t>(&value_)) return static_cast<double>(*whole);
  if (const auto* whole = std::get_if<std::uint64_t>(&value_)) return static_cast<double>(*whole);
  return std::get<double>(value_);
}

JsonTree& JsonTree::operator[](std::string_view name) {
  if (is_null()) value_.emplace<Fields>();
  std::vector<Field>& fields = std::get<Fields>(value_).all;
  for (Field& field : fields)
    if (field.name == name) return field.value;
  fields.push_back({std::string(name), {}});
  return fields.back().value;
}

const JsonTree* JsonTree::find(std::string_view name) const {
  if (const Fields* fields = std::get_if<Fields>(&value_))
    for (const Field& field : fields->all)
      if (field.name == name) return &field.value;
  return nullptr;
}

void JsonTree::add(std::string_view name, JsonTree value) {
  if (is_null()) value_.emplace<Fields>();
  std::get<Fields>(value_).all.push_back({std::string(name), std::move(value)});
}

void JsonTree::push_back(JsonTree item) {
  if (is_null()) value_.emplace<List>();
  std::get<List>(value_).push_back(std::move(item));
}

void JsonTree::write(std::string& out, int indent, int depth) const {
  const auto line = [&](int further) {
    if (indent < 0) return;
    out += '\n';
    out.append(static_cast<std::size_t>(indent * (depth + further)), ' ');
  };
  const auto all = [&](const auto& items, const char* brackets, const auto& one) {
    out += brackets[0];
    bool first = true;
    for (const auto& item : items) {
      if (!first) out += ',';
      first = false;
      line(1);
      one(item);
    }
    if (!first) line(0);
    out += brackets[1];
  };
  if (const List* list = std::get_if<List>(&value_))
    all(*list, "[]", [&](const JsonTree& item) { item.write(out, indent, depth + 1); });
  else if (const Fields* fields = std::get_if<Fields>(&value_))
    all(fields->all, "{}", [&](const Field& field) {
      write_text(out, field.name);
      out += indent < 0 ? ":" : ": ";
      field.value.write(out, indent, depth + 1);
    });
  else if (const auto* text = std::get_if<std::string>(&value_))
    write_text(out, *text);
  else if (const auto* number = std::get_if<double>(&value_))
    write_number(out, *number);
  else if (const auto* positive = std::get_if<std::uint64_t>(&value_))
    write_whole(out, *positive);
  else if (const auto* whole = std::get_if<std::int64_t>(&value_))
    write_whole(out, *whole);
  else if (const auto* yes = std::get_if<bool>(&value_))
    out += *yes ? "true" : "false";
  else
    out += "null";
}

std::string JsonTree::dump(int indent) const {
  std::string out;
  write(out, indent, 0);
  return out;
}

}  // namespace topple::structure
