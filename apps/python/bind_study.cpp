// Study: many samples of a function of Python, or of a study's file, each a function of the study and its number.
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "arrays.h"
#include "bindings.h"
#include "distributions.h"
#include "host_blas.h"
#include "model.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/output_files.h"
#include "topple/structure/formats/plain_text.h"
#include "topple/structure/study/study.h"

namespace topple::python {

using namespace structure;

namespace {

/// A study of a file runs what the file says; one of variables runs a function that is given with run().
struct StudyHost {
  std::string title, file;
  StudyTask task;
  std::string described;  ///< for the fingerprint of a study over a function
  [[nodiscard]] bool of_file() const { return !file.empty(); }
};

// ---- Studies ----

Sampling sampling_named(const std::string& name) {
  for (const auto& [known, sampling] : {std::pair{"random", Sampling::random},
                                        {"latin", Sampling::latin},
                                        {"sobol", Sampling::sobol},
                                        {"saltelli", Sampling::saltelli}})
    if (name == known) return sampling;
  throw py::value_error("sampling: found \"" + name + R"("; accepted: "random", "latin", "sobol", "saltelli")");
}

using Correlation = std::pair<std::vector<std::string>, std::vector<std::vector<double>>>;

CorrelatedGroup group_of(const Correlation& given, const std::vector<StudyVariable>& variables) {
  CorrelatedGroup group;
  for (const std::string& name : given.first) {
    const auto at = std::find_if(variables.begin(), variables.end(), [&](const auto& one) { return one.name == name; });
    if (at == variables.end()) throw py::value_error("correlated: there is no variable \"" + name + "\"");
    group.variables.push_back(static_cast<std::size_t>(at - variables.begin()));
  }
  for (const std::vector<double>& row : given.second) {
    if (row.size() != given.first.size() || given.second.size() != given.first.size())
      throw py::value_error("correlated: accepted: a square matrix with a row for each variable");
    group.correlation.insert(group.correlation.end(), row.begin(), row.end());
  }
  return group;
}

std::shared_ptr<StudyHost> of_variables(const py::dict& variables, std::uint64_t samples, std::uint64_t seed,
                                        const std::string& sampling, const std::vector<Correlation>& correlated) {
  auto host = std::make_shared<StudyHost>();
  std::vector<StudyVariable> spread;
  std::ostringstream described;
  for (const auto& [name, distribution] : variables) {
    if (!py::isinstance<Distribution>(distribution))
      throw py::type_error("variables: accepted: a dict of uniform(), normal(), lognormal(), choice() or grid()");
    spread.push_back({py::str(name), distribution.cast<Distribution>()});
    described << spread.back().name << ": " << text_of(spread.back().distribution) << '\n';
  }
  if (spread.empty()) throw py::value_error("variables: accepted: at least one");
  std::vector<CorrelatedGroup> groups;
  for (const Correlation& one : correlated) {
    groups.push_back(group_of(one, spread));
    for (const double value : groups.back().correlation) described << value << ' ';
  }
  try {
    host->task.sampler = StudySampler(spread, groups, sampling_named(sampling), samples, seed);
  } catch (const std::invalid_argument& error) {
    throw py::value_error(error.what());
  }
  described << sampling << ' ' << host->task.sampler.samples() << ' ' << seed;
  host->described = described.str();
  return host;
}

std::shared_ptr<StudyHost> of_source(const py::object& source) {
  const auto path = path_of(source);
  if (!path) throw py::type_error("Study: accepted: a dict of variables, or a study's file or shipped name");
  const py::gil_scoped_release others_run;
  auto host = std::make_shared<StudyHost>();
  const Study study = read_study(find_study(*path));
  host->title = study.title;
  host->file = study.file;
  host->task = study_task(study);
  return host;
}

/// 64 bits of a text (FNV-1a, G. Fowler, L. C. Noll, K.-P. Vo).
std::uint64_t bits_of(const std::string& text) {
  std::uint64_t bits = 0xcbf29ce484222325ULL;
  for (const char c : text) bits = (bits ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return bits;
}

// ---- Runs ----

/// Ctrl-C, or sys.exit() in a function: it ends the run, and the sample is not recorded as failed. Thrown past what
/// records failures, hence no std::exception.
struct Ended {
  py::error_already_set error;
};

/// Calls a function of Python with the inputs by their names.
class FunctionEvaluator : public SampleEvaluator {
 public:
  FunctionEvaluator(const StudyTask& task, py::object function) : task_(task), function_(std::move(function)) {}
  ~FunctionEvaluator() override {
    const py::gil_scoped_acquire held;
    function_ = py::object();
  }
  void evaluate(Sample& sample) override {
    const py::gil_scoped_acquire held;
    py::dict inputs;
    for (std::size_t i = 0; i < sample.inputs.size(); ++i)
      inputs[py::str(task_.sampler.variables()[i].name)] = object_of(sample.inputs[i]);
    try {
      append_outputs(function_(**inputs), sample);
    } catch (py::error_already_set& error) {
      if (!error.matches(PyExc_Exception)) throw Ended{error};
      const std::string said = py::str(error.value());
      throw std::runtime_error(std::string(py::str(error.type().attr("__name__"))) + (said.empty() ? "" : ": " + said));
    } catch (const py::cast_error&) {
      throw std::runtime_error("the function returned what is no number; accepted: a number for each output");
    }
  }

 private:
  void append_outputs(const py::object& returned, Sample& sample) const {
    const std::vector<std::string>& names = task_.outputs;
    if (py::isinstance<py::dict>(returned)) {
      const py::dict numbers = returned;
      for (const std::string& name : names) {
        if (!numbers.contains(py::str(name))) throw std::runtime_error("the function returned no \"" + name + "\"");
        sample.outputs.push_back(number(numbers[py::str(name)]));
      }
      return;
    }
    const bool many = py::isinstance<py::sequence>(returned) || py::hasattr(returned, "__len__");
    if (many)
      for (const py::handle one : py::iter(returned)) sample.outputs.push_back(number(one));
    else
      sample.outputs.push_back(number(returned));
    if (sample.outputs.size() != names.size())
      throw std::runtime_error("the function returned " + std::to_string(sample.outputs.size()) +
                               " numbers; accepted: " + std::to_string(names.size()));
  }
  static double number(const py::handle& value) {
    if (value.is_none()) return std::numeric_limits<double>::quiet_NaN();
    return py::float_(py::reinterpret_borrow<py::object>(value));
  }

  const StudyTask& task_;
  py::object function_;
};

struct StudyResult {
  StudyTask task;
  std::vector<Sample> samples;
};

Doubles table(const std::vector<Sample>& samples, std::size_t columns, bool inputs) {
  Doubles array({samples.size(), columns});
  double* out = array.mutable_data();
  for (const Sample& sample : samples)
    for (std::size_t c = 0; c < columns; ++c)
      if (inputs)
        *out++ = sample.inputs[c].number;
      else
        *out++ = c < sample.outputs.size() ? sample.outputs[c] : std::numeric_limits<double>::quiet_NaN();
  return array;
}

/// Without the interpreter. All that the journal in the folder has by then, in order of number.
std::vector<Sample> run_in_folder(const StudyTask& task, const StudyRun& asked, const py::object& folder,
                                  StudyJournal::Found how) {
  std::filesystem::path into;
  {
    const py::gil_scoped_acquire held;
    into = path_of(folder).value_or(std::string());
  }
  const OutputFolder claimed(into, {}, {"journal.jsonl", "times.csv", "samples.csv"});
  {
    StudyJournal journal(task, into, how);
    run_samples(task, asked, journal);
  }
  const StudyJournal journal(task, into, StudyJournal::Found::resume);
  std::vector<Sample> samples = journal.found();
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.number < b.number; });
  write_files(into, {{"samples.csv", samples_csv(task, samples)}});
  return samples;
}

std::shared_ptr<StudyResult> run(const StudyHost& host, const py::object& function, const py::object& outputs,
                                 const py::object& folder, bool resume, bool retry_failed,
                                 const std::optional<std::pair<std::uint64_t, std::uint64_t>>& samples, int threads,
                                 const std::string& version, const py::object& progress) {
  if (host.of_file() != function.is_none())
    throw py::type_error(host.of_file() ? "run: a study of a file has no function" : "run: function is missing");
  StudyTask task = host.task;
  if (!host.of_file()) {
    task.outputs =
        py::isinstance<py::str>(outputs) ? std::vector{utf8_of(outputs)} : outputs.cast<std::vector<std::string>>();
    if (task.outputs.empty()) throw py::value_error("run: outputs: accepted: names of what the function returns");
    std::string all = host.described + "\n" + version;
    for (const std::string& name : task.outputs) all += "\n" + name;
    task.fingerprint = bits_of(all);
    task.make_evaluator = [&task, &function]() -> std::unique_ptr<SampleEvaluator> {
      const py::gil_scoped_acquire held;
      return std::make_unique<FunctionEvaluator>(task, function);
    };
  }
  StudyRun asked;
  if (samples) {
    if (samples->first >= samples->second || samples->second > task.sampler.samples())
      throw py::value_error("run: samples: accepted: (first, past the last), of 0 to " +
                            std::to_string(task.sampler.samples()));
    std::tie(asked.from, asked.to) = *samples;
  }
  asked.threads = threads;
  std::optional<py::error_already_set> raised;
  asked.stopped = [&] {
    const py::gil_scoped_acquire held;
    if (!raised && PyErr_CheckSignals() != 0) raised.emplace();
    return raised.has_value();
  };
  if (!progress.is_none())
    asked.progress = [&](std::uint64_t done, std::uint64_t all) {
      const py::gil_scoped_acquire held;
      try {
        progress(done, all);
      } catch (py::error_already_set& error) {
        if (!raised) raised.emplace(error);
      }
    };
  using Found = StudyJournal::Found;
  const Found how = retry_failed ? Found::retry_failed : resume ? Found::resume : Found::refuse;
  auto result = std::make_shared<StudyResult>();
  try {
    const py::gil_scoped_release others_run;
    const HostBlas blas;
    result->samples = folder.is_none() ? run_samples(task, asked) : run_in_folder(task, asked, folder, how);
  } catch (Ended& ended) {
    throw py::error_already_set(ended.error);
  }
  if (raised) throw py::error_already_set(*raised);
  task.make_evaluator = nullptr;
  result->task = std::move(task);
  return result;
}

void bind_results_of_studies(py::module_& module) {
  using Result = StudyResult;
  py::class_<Result, std::shared_ptr<Result>>(module, "StudyResult", "The samples of a Study that were computed.")
      .def_property_readonly(
          "input_names", [](const Result& r) { return names_of(r.task.sampler.variables()); },
          "Names of the variables, columns of inputs.")
      .def_property_readonly(
          "output_names", [](const Result& r) { return r.task.outputs; }, "Names of the outputs, columns of outputs.")
      .def_property_readonly(
          "numbers",
          [](const Result& r) {
            std::vector<std::uint64_t> numbers;
            for (const Sample& sample : r.samples) numbers.push_back(sample.number);
            return copied<std::int64_t>(numbers);
          },
          "Numbers of the samples, shape (samples,), ascending. A new array.")
      .def_property_readonly(
          "inputs", [](const Result& r) { return table(r.samples, r.task.sampler.variables().size(), true); },
          "What each sample was fed, shape (samples, inputs); nan where it is no number (Study.values has it). A new "
          "array.")
      .def_property_readonly(
          "outputs", [](const Result& r) { return table(r.samples, r.task.outputs.size(), false); },
          "What came of it, shape (samples, outputs); nan for a sample that failed, and for None. A new array.")
      .def_property_readonly(
          "failed",
          [](const Result& r) {
            py::dict failed;
            for (const Sample& sample : r.samples)
              if (!sample.failed.empty()) failed[py::int_(sample.number)] = sample.failed;
            return failed;
          },
          "Reasons of samples that failed, by number.")
      .def(
          "csv", [](const Result& r) { return samples_csv(r.task, r.samples); }, "The samples as a table.");
}

}  // namespace

void bind_study(py::module_& module) {
  bind_distributions(module);
  bind_results_of_studies(module);
  py::class_<StudyHost, std::shared_ptr<StudyHost>>(module, "Study",
                                                    "Many samples under changed inputs. What sample k is fed is a "
                                                    "function of the study and k alone, to the bit, whatever "
                                                    "the order, the threads, the restarts (docs/studies.md).")
      .def(py::init(&of_variables), py::arg("variables"), py::arg("samples") = 0, py::kw_only(), py::arg("seed") = 1,
           py::arg("sampling") = "random", py::arg("correlated") = std::vector<Correlation>{},
           "A study over a function that is given to run().\n\n"
           "variables: dict of distributions by name. samples: how many; 0: one for each combination of the grids. "
           "sampling: "
           "\"random\", \"latin\" (Latin hypercube), \"sobol\" or \"saltelli\". correlated: list of (names, matrix), "
           "the "
           "correlation of the normal numbers that the variables are made of. Raises ValueError.")
      .def(py::init(&of_source), py::arg("file"),
           "A study of a model or scenario, by a shipped one's name or a file. Raises InputError.")
      .def_property_readonly(
          "samples", [](const StudyHost& h) { return h.task.sampler.samples(); }, "How many there are.")
      .def_property_readonly(
          "variables", [](const StudyHost& h) { return names_of(h.task.sampler.variables()); },
          "Names of the variables.")
      .def(
          "values",
          [](const StudyHost& h, std::uint64_t sample) {
            if (sample >= h.task.sampler.samples())
              throw py::index_error("there are " + std::to_string(h.task.sampler.samples()) + " samples");
            py::dict values;
            const std::vector<StudyValue> of_sample = h.task.sampler.values(sample);
            for (std::size_t i = 0; i < of_sample.size(); ++i)
              values[py::str(h.task.sampler.variables()[i].name)] = object_of(of_sample[i]);
            return values;
          },
          py::arg("sample"), "What a sample is fed, by name. Raises IndexError.")
      .def("run", &run, py::arg("function") = py::none(), py::kw_only(), py::arg("outputs") = "value",
           py::arg("folder") = py::none(), py::arg("resume") = false, py::arg("retry_failed") = false,
           py::arg("samples") = py::none(), py::arg("threads") = 1, py::arg("version") = "",
           py::arg("progress") = py::none(),
           "Computes samples.\n\n"
           "function: called with the variables by their names; returns a number, a sequence of them, or a dict, as "
           "outputs "
           "names them. What it raises makes the sample fail, with the reason, and the study goes on. (A study of a "
           "file has "
           "none.)\n"
           "folder: where the journal goes, a line for each sample as it ends; resume=True takes in what is there and "
           "computes "
           "only what is missing; retry_failed=True does the same, and computes samples that failed once more. "
           "version: of the function; the journal of another version, or of another study, is "
           "refused.\n"
           "samples: (first, past the last). threads: samples at once; worth it where the function analyses or "
           "simulates, "
           "which lets go of the interpreter. progress: called with (done, all).\n\n"
           "Returns a StudyResult with what the journal has, or all that was computed. Ctrl-C ends it between two "
           "samples, and "
           "leaves a journal to resume. Raises InputError, TypeError, ValueError.");
}

}  // namespace topple::python
