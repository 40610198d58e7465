#pragma once
// Exceptions of the library as Python exceptions that say where.
#include <pybind11/pybind11.h>

#include <string>

#include "topple/structure/analysis.h"
#include "topple/structure/formats/input_place.h"

namespace topple::python {

/// Raises topple.UnstableModel with names and the motion; `partial` is what was computed before, or None.
[[noreturn]] void raise_unstable(const structure::Building& building, const structure::UnstableAnalysis& error,
                                 const pybind11::object& partial);

/// Calls `read`, which reads a text that was made of Python objects under the name `name`: its errors leave out the
/// line, which nobody sees.
template <class Read>
auto read_from_objects(const std::string& name, Read read) {
  try {
    return read();
  } catch (const structure::PlacedInputError& error) {
    if (!error.place().where.starts_with(name + ", line ")) throw;  // of a file that the objects name
    throw structure::PlacedInputError({name, error.place().path}, error.problem());
  }
}

}  // namespace topple::python
