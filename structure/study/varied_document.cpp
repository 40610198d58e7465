#include "study/varied_document.h"

#include <algorithm>

#include "topple/structure/error.h"

namespace topple::structure::study {

using formats::JsonDocument;
using formats::JsonValue;

namespace {

/// The steps of a pointer, unescaped.
std::vector<std::string> steps_of(const std::string& pointer) {
  std::vector<std::string> steps;
  for (std::size_t at = 0; at < pointer.size();) {
    const std::size_t end = std::min(pointer.find('/', at + 1), pointer.size());
    std::string step;
    for (std::size_t i = at + 1; i < end; ++i) {
      const bool escape = pointer[i] == '~' && i + 1 < end && (pointer[i + 1] == '0' || pointer[i + 1] == '1');
      step += escape ? (pointer[i + 1] == '0' ? '~' : '/') : pointer[i];
      i += escape ? 1 : 0;
    }
    steps.push_back(std::move(step));
    at = end;
  }
  return steps;
}

/// RFC 6901: nothing, or steps behind strokes, in which ~ is followed by 0 or 1.
bool is_pointer(const std::string& text) {
  if (!text.empty() && text[0] != '/') return false;
  for (std::size_t i = text.find('~'); i != std::string::npos; i = text.find('~', i + 1))
    if (i + 1 == text.size() || (text[i + 1] != '0' && text[i + 1] != '1')) return false;
  return true;
}

std::optional<JsonValue> child(const JsonValue& value, const std::string& step) {
  if (value.is_object()) return value.find(step);
  if (!value.is_array() || step.empty() || step.find_first_not_of("0123456789") != std::string::npos) return {};
  std::size_t index = 0;
  for (const JsonValue item : value)
    if (std::to_string(index++) == step) return item;
  return {};
}

/// What there is in the place of a step that leads nowhere.
std::string accepted_in(const JsonValue& value) {
  if (value.is_array()) return "0 to " + std::to_string(value.size()) + " (without it)";
  if (!value.is_object()) return "a pointer that ends before it";
  std::vector<std::string_view> keys;
  for (const JsonValue item : value) keys.push_back(item.key());
  return formats::quoted_list(keys);
}

}  // namespace

std::optional<JsonValue> value_at(const JsonDocument& document, const std::string& pointer) {
  JsonValue value = document.root();
  for (const std::string& step : steps_of(pointer)) {
    const auto next = child(value, step);
    if (!next) return std::nullopt;
    value = *next;
  }
  return value;
}

VariedDocument::VariedDocument(std::string text, std::string name)
    : text_(std::move(text)), name_(std::move(name)), document_(JsonDocument::from_text(text_, name_)) {}

std::size_t VariedDocument::add_target(const Variation& variation) {
  JsonValue value = document_.root();
  const std::vector<std::string> steps = steps_of(variation.pointer);
  Target target;
  target.change = variation.change;
  target.steps = steps;
  if (!is_pointer(variation.pointer))
    throw InputError(variation.place + ".at: found " + formats::in_quotes(variation.pointer) +
                     "; accepted: a JSON pointer, in which ~ is written ~0 and / in a name ~1");
  bool there = true;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto next = child(value, steps[i]);
    // A key that has its default may be left out of the file.
    const bool added =
        !next && i + 1 == steps.size() && value.is_object() && target.change == Variation::Change::replace;
    if (!next && !added)
      throw InputError(variation.place + ".at: " + name_ + " has no " + formats::in_quotes(steps[i]) + " in " +
                       formats::in_quotes(variation.pointer) + "; accepted there: " + accepted_in(value));
    if (next) value = *next;
    there = there && next;
  }
  const bool a_number = there && value.is_number();
  if (target.change != Variation::Change::replace && !a_number)
    throw InputError(variation.place + ".at: " + (there ? value.found() : "nothing") + " stands there in " + name_ +
                     "; accepted for \"add\" and \"times\": a number");
  if (a_number) {
    target.number = value;
    target.base = value.number();
  }
  const auto& values = variation.distribution.values;
  if (!a_number || std::any_of(values.begin(), values.end(), [](const StudyValue& v) { return !v.is_number(); }))
    only_numbers_ = false;
  targets_.push_back(std::move(target));
  pointers_.push_back(variation.pointer);
  return targets_.size() - 1;
}

double VariedDocument::changed(const Target& target, double base, double value) {
  if (target.change == Variation::Change::add) return base + value;
  if (target.change == Variation::Change::times) return base * value;
  return value;
}

const JsonDocument& VariedDocument::with(const std::vector<const StudyValue*>& values) {
  if (only_numbers_) {
    for (const Target& target : targets_) document_.replace_number(*target.number, target.base);
    for (std::size_t t = 0; t < targets_.size(); ++t)
      document_.replace_number(*targets_[t].number,
                               changed(targets_[t], targets_[t].number->number(), values[t]->number));
    return document_;
  }
  if (tree_.is_null()) tree_ = JsonTree::parse(text_);
  JsonTree tree = tree_;
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    JsonTree* place = &tree;
    for (const std::string& step : targets_[t].steps)
      place = place->is_array() ? &(*place)[std::stoul(step)] : &(*place)[step];
    *place = values[t]->is_number()
                 ? JsonTree(changed(targets_[t], place->is_number() ? place->number() : 0, values[t]->number))
                 : JsonTree::parse(values[t]->json);
  }
  parsed_ = JsonDocument::from_text(tree.dump(), name_);
  return parsed_;
}

}  // namespace topple::structure::study
