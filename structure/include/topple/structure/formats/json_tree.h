#pragma once
// A JSON value that is made piece by piece and written at the end. Values of an object keep the order in which they
// came. To give one up takes no memory, so that a run that is short of memory can still end in good order.
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace topple::structure {
/// A value: null, true or false, a number, a text, a list or an object.
class JsonTree {
 public:
  struct Field;
  class Item;
  /// The values of a list, in their order.
  using List = std::vector<JsonTree>;

  JsonTree() = default;        ///< null
  JsonTree(std::nullptr_t) {}  ///< null
  /// A whole number, or true or false.
  template <std::integral Number>
  JsonTree(Number number) : value_(held(number)) {}
  /// A number that may have a fraction; null where it is not finite.
  template <std::floating_point Number>
  JsonTree(Number number) : value_(static_cast<double>(number)) {}
  /// A text.
  JsonTree(const char* text) : value_(std::string(text)) {}
  /// A text.
  JsonTree(std::string_view text) : value_(std::string(text)) {}
  /// A text.
  JsonTree(std::string text) : value_(std::move(text)) {}
  /// A list of what a value can be made from.
  template <class T>
  JsonTree(const std::vector<T>& items) : value_(List(items.begin(), items.end())) {}
  /// A list of what a value can be made from.
  template <class T, std::size_t count>
  JsonTree(const std::array<T, count>& items) : value_(List(items.begin(), items.end())) {}
  /// An object where every item is a list of two that begins with a text, else a list: {{"name", "x"}, {"mass", 3}}.
  JsonTree(std::initializer_list<Item> items);
  /// A list, whatever its items are.
  [[nodiscard]] static JsonTree array(std::initializer_list<Item> items = {});
  /// An object without fields.
  [[nodiscard]] static JsonTree object();
  /// Throws InputError where the text is no JSON. A number without a fraction is held as a whole one.
  [[nodiscard]] static JsonTree parse(std::string_view text);

  /// Whether it is null.
  [[nodiscard]] bool is_null() const { return std::holds_alternative<std::monostate>(value_); }
  /// Whether it is a number, whole or not.
  [[nodiscard]] bool is_number() const;
  /// Whether it is a text.
  [[nodiscard]] bool is_text() const { return std::holds_alternative<std::string>(value_); }
  /// Whether it is a list.
  [[nodiscard]] bool is_array() const { return std::holds_alternative<List>(value_); }
  /// Whether it is an object.
  [[nodiscard]] bool is_object() const { return std::holds_alternative<Fields>(value_); }
  /// Of a list or an object; 0 of anything else.
  [[nodiscard]] std::size_t size() const;
  /// Whether size() is 0.
  [[nodiscard]] bool empty() const { return size() == 0; }

  /// The number. Throws std::bad_variant_access where another kind of value stands, as the next three do.
  [[nodiscard]] double number() const;
  /// The text.
  [[nodiscard]] const std::string& text() const { return std::get<std::string>(value_); }
  /// The fields of an object, in their order.
  [[nodiscard]] const std::vector<Field>& fields() const { return std::get<Fields>(value_).all; }
  /// The value under a name, null at first. What was null becomes an object.
  JsonTree& operator[](std::string_view name);
  /// The value at a place of a list, from 0; there has to be one.
  JsonTree& operator[](std::size_t index) { return std::get<List>(value_)[index]; }
  /// The value under a name; none where there is none, or no object.
  [[nodiscard]] const JsonTree* find(std::string_view name) const;
  /// Under a name that is known to be new: without a look at the others. What was null becomes an object.
  void add(std::string_view name, JsonTree value);
  /// What was null becomes a list.
  void push_back(JsonTree item);

  /// On one line, or with each value on a line of its own, so many spaces further in. Numbers are as short as reads
  /// back to the same bits, with ".0" where one that may have a fraction has none; NaN and infinities are null. Bytes
  /// that are no UTF-8 become U+FFFD.
  [[nodiscard]] std::string dump(int indent = -1) const;

 private:
  /// Not the vector itself: libstdc++ 12 takes a variant of nothing but vectors, texts and numbers for one that always
  /// has a value, and when the copy of one throws it destroys a value that was never there. Its members are defined
  /// where a field is known: clang asks for them earlier.
  struct Fields {
    Fields();
    Fields(const Fields&);
    Fields(Fields&&) noexcept;
    Fields& operator=(const Fields&);
    Fields& operator=(Fields&&) noexcept;
    ~Fields();
    std::vector<Field> all;
  };
  using Value = std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string, List, Fields>;

  template <std::integral Number>
  static Value held(Number number) {
    if constexpr (std::same_as<Number, bool>)
      return number;
    else if constexpr (std::signed_integral<Number>)
      return static_cast<std::int64_t>(number);
    else
      return static_cast<std::uint64_t>(number);
  }
  void write(std::string& out, int indent, int depth) const;

  Value value_;
};

/// A value of an object under its name.
struct JsonTree::Field {
  std::string name;  ///< once in an object
  JsonTree value;    ///< of any kind
};

inline JsonTree::Fields::Fields() = default;
inline JsonTree::Fields::Fields(const Fields&) = default;
inline JsonTree::Fields::Fields(Fields&&) noexcept = default;
inline JsonTree::Fields& JsonTree::Fields::operator=(const Fields&) = default;
inline JsonTree::Fields& JsonTree::Fields::operator=(Fields&&) noexcept = default;
inline JsonTree::Fields::~Fields() = default;

/// One item between braces: what a value is made from, moved where it can be.
class JsonTree::Item {
 public:
  /// Anything that a value can be made from.
  template <class T>
  requires std::constructible_from<JsonTree, T> Item(T&& value) : value_(std::forward<T>(value)) {}
  /// Braces within braces.
  Item(std::initializer_list<Item> items) : value_(items) {}
  /// The items of braces are constant; each is taken once.
  [[nodiscard]] JsonTree extract() const { return std::move(value_); }
  /// Whether it is a list of two that begins with a text.
  [[nodiscard]] bool is_field() const;

 private:
  mutable JsonTree value_;
};

}  // namespace topple::structure
