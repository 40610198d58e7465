#pragma once
// A JSON document some of whose values change from sample to sample. Where all of them are numbers that stand in it,
// they are put into the parsed document; else it is parsed again.
#include <optional>
#include <string>
#include <vector>

#include "formats/json/json_document.h"
#include "topple/structure/formats/json_tree.h"
#include "topple/structure/study/study.h"

namespace topple::structure::study {

/// The value that a JSON pointer (RFC 6901) names; none where there is none.
[[nodiscard]] std::optional<formats::JsonValue> value_at(const formats::JsonDocument& document,
                                                         const std::string& pointer);

class VariedDocument {
 public:
  /// `name` stands for the file in messages.
  VariedDocument(std::string text, std::string name);
  VariedDocument(const VariedDocument&) = delete;
  VariedDocument& operator=(const VariedDocument&) = delete;

  /// The value at the variation's pointer is going to change; changes of one document are made in the order of their
  /// targets. Throws InputError that names the study's place.
  std::size_t add_target(const Variation& variation);
  [[nodiscard]] bool varies() const { return !targets_.empty(); }
  /// What is read from it is the same but for numbers.
  [[nodiscard]] bool only_numbers() const { return only_numbers_; }

  /// The document with one value for each target.
  const formats::JsonDocument& with(const std::vector<const StudyValue*>& values);
  [[nodiscard]] const formats::JsonDocument& unchanged() const { return document_; }
  /// Of the targets.
  [[nodiscard]] const std::vector<std::string>& pointers() const { return pointers_; }

 private:
  struct Target {
    Variation::Change change = Variation::Change::replace;
    std::vector<std::string> steps;            ///< of the pointer
    std::optional<formats::JsonValue> number;  ///< in document_, where one stands there
    double base = 0;
  };
  [[nodiscard]] static double changed(const Target& target, double base, double value);

  std::string text_, name_;
  formats::JsonDocument document_, parsed_;
  std::vector<Target> targets_;
  std::vector<std::string> pointers_;
  JsonTree tree_;
  bool only_numbers_ = true;
};

}  // namespace topple::structure::study
