#pragma once
// Values of a study's variables as objects of Python, and how they are spread.
#include <pybind11/pybind11.h>

#include <string>

#include "topple/structure/study/study.h"

namespace topple::python {

/// A number, or anything that JSON can hold. Raises ValueError for a number that is not finite.
[[nodiscard]] structure::StudyValue value_of(const pybind11::handle& given);
[[nodiscard]] pybind11::object object_of(const structure::StudyValue& value);

/// All that the distribution is made of, to the bit: studies that differ in it are other studies.
[[nodiscard]] std::string text_of(const structure::Distribution& distribution);

void bind_distributions(pybind11::module_& module);

}  // namespace topple::python
