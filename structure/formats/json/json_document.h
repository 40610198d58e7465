#pragma once
// A JSON text as a compact tree whose every value knows its place, so that whoever reads a format from it can say where
// something is wrong: file, line and path ("members.C1.section").
//
// The text is read as a stream with bounds on depth, on the length of one token and on the number of values: a hostile
// file is refused early and without growing memory. A key that stands twice in one object is an error.
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "topple/structure/number_range.h"

namespace topple::structure::formats {

class JsonValue;

struct JsonLimits {
  std::size_t depth = 32;                      ///< of nested arrays and objects; the formats need 8
  std::size_t token = std::size_t{1} << 20;    ///< characters of one name, number or run of spaces
  std::size_t values = std::size_t{50} << 20;  ///< in the whole text
};

class JsonDocument {
 public:
  /// Both throw InputError. `name` stands for the file in messages.
  static JsonDocument from_file(const std::filesystem::path& file, const JsonLimits& limits = {});
  /// `places`: for a text that was made from something else, where its lines come from ("nodes.csv, line 5"), for
  /// messages.
  static JsonDocument from_text(std::string_view text, const std::string& name, const JsonLimits& limits = {},
                                std::vector<std::string> places = {});

  [[nodiscard]] JsonValue root() const;
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Puts another number in the place of one.
  void replace_number(const JsonValue& at, double number);
  /// "model.json, line 12", or what stands for that line.
  [[nodiscard]] std::string location(std::uint32_t line) const;

 private:
  friend class JsonValue;
  friend class JsonBuilder;
  enum class Type : std::uint8_t { null, boolean, number, text, array, object };
  /// Values lie in the order of the text, each before what it holds.
  struct Slot {
    double number = 0;
    std::uint64_t text = 0, key = 0;  ///< where they begin in text_
    std::uint32_t text_length = 0, key_length = 0;
    std::uint32_t parent = 0, next = 0;  ///< next: first slot after this value and all that it holds
    std::uint32_t count = 0, line = 0;
    Type type = Type::null;
  };
  std::string name_, text_;
  std::vector<std::string> places_;
  std::vector<Slot> slots_;
};

/// One value of a document: a light handle, valid as long as its document.
class JsonValue {
 public:
  JsonValue(const JsonDocument& document, std::uint32_t index) : document_(&document), index_(index) {}

  [[nodiscard]] bool is_null() const;
  [[nodiscard]] bool is_bool() const;
  [[nodiscard]] bool is_number() const;
  [[nodiscard]] bool is_text() const;
  [[nodiscard]] bool is_array() const;
  [[nodiscard]] bool is_object() const;

  // Typed access; a wrong type throws with what was found and `accepted` (a default is made from the type).
  [[nodiscard]] double number(std::string_view accepted = "a number") const;
  [[nodiscard]] double positive() const;      ///< above 0
  [[nodiscard]] double not_negative() const;  ///< 0 or above
  [[nodiscard]] double in(const NumberRange& range) const;
  /// A whole number from `least` to `most`.
  [[nodiscard]] std::int64_t whole(std::int64_t least, std::int64_t most) const;
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] std::string_view text(std::string_view accepted = "a string") const;
  /// An array of exactly N numbers.
  template <class Vector>
  [[nodiscard]] Vector numbers() const {
    Vector result;
    const auto n = static_cast<std::size_t>(result.size());
    expect_array(n, n);
    std::size_t i = 0;
    for (const JsonValue item : *this) result[i++] = item.number();
    return result;
  }

  /// Throws unless this is an array with `least` to `most` items / an object.
  void expect_array(std::size_t least, std::size_t most) const;
  void expect_object() const;
  /// Throws at the first key of this object that is not among those.
  void only(std::initializer_list<std::string_view> keys) const;

  /// Items of an array or values of an object, in the order of the text.
  class Iterator {
   public:
    Iterator(const JsonDocument& document, std::uint32_t index) : document_(&document), index_(index) {}
    JsonValue operator*() const { return {*document_, index_}; }
    Iterator& operator++();
    bool operator!=(const Iterator& other) const { return index_ != other.index_; }

   private:
    const JsonDocument* document_;
    std::uint32_t index_;
  };
  [[nodiscard]] Iterator begin() const;
  [[nodiscard]] Iterator end() const;
  [[nodiscard]] std::size_t size() const;

  /// Value of a key of this object.
  [[nodiscard]] std::optional<JsonValue> find(std::string_view key) const;
  [[nodiscard]] JsonValue require(std::string_view key) const;
  /// The key under which this value stands in its object; empty in an array.
  [[nodiscard]] std::string_view key() const;

  /// What stands here, for messages: `"text"`, `-3`, `an object`.
  [[nodiscard]] std::string found() const;
  [[nodiscard]] std::string path() const;
  /// Throws InputError: file, line, path, and `what`.
  [[noreturn]] void fail(const std::string& what) const;
  /// fail("found ...; accepted: ...")
  [[noreturn]] void refuse(std::string_view accepted) const;

 private:
  friend class JsonDocument;
  [[nodiscard]] const JsonDocument::Slot& slot() const { return document_->slots_[index_]; }

  const JsonDocument* document_;
  std::uint32_t index_;
};

inline JsonValue JsonDocument::root() const { return {*this, 0}; }

/// The value as JSON text, on one line.
[[nodiscard]] std::string text_of(const JsonValue& value);

/// `"a", "b", "c"` for messages; long lists are cut.
[[nodiscard]] std::string quoted_list(const std::vector<std::string_view>& names);
/// The text in quotation marks, cut and made printable: what a person typed may hold anything.
[[nodiscard]] std::string in_quotes(std::string_view text);

}  // namespace topple::structure::formats
