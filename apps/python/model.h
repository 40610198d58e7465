#pragma once
// The Python class Model: a building that was read, with its names.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <vector>

#include "topple/structure/analysis.h"
#include "topple/structure/building.h"

namespace topple::python {

namespace py = pybind11;

class Model {
 public:
  explicit Model(structure::Building building, std::vector<structure::SectionCut> cuts = {})
      : building_(std::make_shared<const structure::Building>(std::move(building))),
        names_(*building_),
        cuts_(std::move(cuts)) {}
  /// Those that the model asks for itself.
  [[nodiscard]] const std::vector<structure::SectionCut>& cuts() const { return cuts_; }
  [[nodiscard]] const structure::Building& building() const { return *building_; }
  [[nodiscard]] const std::shared_ptr<const structure::Building>& shared() const { return building_; }
  [[nodiscard]] const structure::NameIndex& names() const { return names_; }

 private:
  std::shared_ptr<const structure::Building> building_;
  structure::NameIndex names_;
  std::vector<structure::SectionCut> cuts_;
};

/// The names of a list of things.
template <class Items>
[[nodiscard]] std::vector<std::string> names_of(const Items& items) {
  std::vector<std::string> names;
  names.reserve(items.size());
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

/// Those that ids name.
template <class Id>
[[nodiscard]] std::vector<std::string> names_of(const structure::Building& building, const std::vector<Id>& ids) {
  std::vector<std::string> names;
  names.reserve(ids.size());
  for (const Id id : ids) names.push_back(building[id].name);
  return names;
}

/// A str as UTF-8. Throws Python's UnicodeEncodeError for one that has none (half a surrogate pair), TypeError for what
/// is no str.
[[nodiscard]] std::string utf8_of(const py::handle& text);
/// A dict (or anything that json can write, numpy numbers and arrays included) as JSON text.
[[nodiscard]] std::string json_text(const py::handle& value);
/// JSON text as Python objects.
[[nodiscard]] py::object json_object(const std::string& text);
/// A str or a path as a path; nothing for anything else.
[[nodiscard]] std::optional<std::string> path_of(const py::handle& value);

/// A Model itself, or what Model() takes.
[[nodiscard]] std::shared_ptr<Model> model_of(const py::object& source);

}  // namespace topple::python
