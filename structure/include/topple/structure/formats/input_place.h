#pragma once
// Where in a text something is wrong, in parts, for programs that show it: an editor, a table, an exception of another
// language.
#include <string>
#include <utility>

#include "topple/structure/error.h"

namespace topple::structure {

/// A place in a text, in two parts.
struct InputPlace {
  std::string where;  ///< file and line as messages have them: "model.json, line 12"
  std::string path;   ///< in the file: "members.C1.section", a table's column; empty: the line as a whole
};

/// Bad input at a place of a text. what() is the whole line: where, path, problem.
class PlacedInputError : public InputError {
 public:
  /// `problem`: what is wrong, and what is accepted.
  PlacedInputError(InputPlace place, const std::string& problem)
      : InputError(place.where + (place.path.empty() ? "" : ", " + place.path) + ": " + problem),
        place_(std::move(place)),
        problem_(problem) {}
  /// Where it is.
  [[nodiscard]] const InputPlace& place() const { return place_; }
  /// What is wrong, and what is accepted.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  InputPlace place_;
  std::string problem_;
};

}  // namespace topple::structure
