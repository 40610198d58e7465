// Python's exceptions: InputError and UnstableModel, with what they carry as attributes.
#include "errors.h"

#include "arrays.h"
#include "bindings.h"
#include "model.h"
#include "topple/structure/error.h"

namespace topple::python {

using namespace structure;

namespace {

// They live as long as the interpreter does.
PyObject* input_error = nullptr;
PyObject* unstable_model = nullptr;

constexpr const char* input_error_doc =
    "Bad input. str() is one line that names the file, the place in it, what is wrong and what is accepted.\n\n"
    "Attributes (each None where it is not known):\n"
    "    where (str): the file and line (\"model.json, line 12\"), or \"model\" for a dict.\n"
    "    path (str): the place in it (\"members.C1.section\"), or a table's column.\n"
    "    problem (str): what is wrong, and what is accepted.";
constexpr const char* unstable_model_doc =
    "A model that can move without strain, or loads beyond what it bears before it buckles.\n\n"
    "Attributes (each None where it is not known):\n"
    "    kind (str): \"mechanism\" or \"buckling\".\n"
    "    combination (str): the first in which it was found.\n"
    "    nodes (list[str]): nodes that move, most first.\n"
    "    members (list[str]): members that move.\n"
    "    shape (numpy.ndarray): the motion, shape (nodes, 6): x y z rx ry rz, global, largest translation 1.\n"
    "    partial (Analysis): what was computed before, where some combinations could be.";

PyObject* new_exception(const char* name, const char* doc, PyObject* base, std::initializer_list<const char*> fields) {
  py::dict attributes;
  for (const char* field : fields) attributes[field] = py::none();
  return PyErr_NewExceptionWithDoc(name, doc, base, attributes.ptr());
}

py::object new_error(PyObject* type, const std::string& message) {
  return py::reinterpret_borrow<py::object>(type)(message);
}

void raise_input_error(const InputError& error) {
  const py::object raised = new_error(input_error, error.what());
  if (const auto* placed = dynamic_cast<const PlacedInputError*>(&error)) {
    raised.attr("where") = placed->place().where;
    raised.attr("path") = placed->place().path.empty() ? py::object(py::none()) : py::str(placed->place().path);
    raised.attr("problem") = placed->problem();
  }
  PyErr_SetObject(input_error, raised.ptr());
}

}  // namespace

void raise_unstable(const Building& building, const UnstableAnalysis& error, const py::object& partial) {
  const Diagnosis& found = error.diagnosis;
  const py::object raised = new_error(unstable_model, error.what());
  raised.attr("kind") = found.kind;
  if (found.combination.valid()) raised.attr("combination") = building[found.combination].name;
  raised.attr("nodes") = names_of(building, found.nodes);
  raised.attr("members") = names_of(building, found.members);
  const auto shape = std::make_shared<const std::vector<Vec6>>(found.shape);
  raised.attr("shape") = rows_of(*shape, shape);
  raised.attr("partial") = partial;
  PyErr_SetObject(unstable_model, raised.ptr());
  throw py::error_already_set();
}

void bind_errors(py::module_& module) {
  input_error = new_exception("topple.InputError", input_error_doc, PyExc_ValueError, {"where", "path", "problem"});
  unstable_model = new_exception("topple.UnstableModel", unstable_model_doc, PyExc_RuntimeError,
                                 {"kind", "combination", "nodes", "members", "shape", "partial"});
  module.attr("InputError") = py::handle(input_error);
  module.attr("UnstableModel") = py::handle(unstable_model);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      raise_input_error(error);
    } catch (const UnstableModel& error) {
      PyErr_SetObject(unstable_model, new_error(unstable_model, error.what()).ptr());
    }
  });
}

}  // namespace topple::python
