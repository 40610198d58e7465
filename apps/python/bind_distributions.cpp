// Distribution: how a variable of a study is spread.
#include "distributions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "arrays.h"
#include "bindings.h"
#include "model.h"

namespace topple::python {

using namespace structure;

StudyValue value_of(const py::handle& given) {
  StudyValue value;
  if (py::isinstance<py::bool_>(given) ||
      !(py::isinstance<py::int_>(given) || py::isinstance<py::float_>(given) || py::hasattr(given, "__float__")))
    value.json = json_text(given);
  else
    value.number = py::float_(py::reinterpret_borrow<py::object>(given));
  if (value.is_number() && !std::isfinite(value.number))
    throw py::value_error("found " + std::string(std::isnan(value.number) ? "nan" : "inf") +
                          "; accepted: a number that is finite");
  return value;
}

py::object object_of(const StudyValue& value) {
  return value.is_number() ? py::object(py::float_(value.number)) : json_object(value.json);
}

std::string text_of(const Distribution& d) {
  std::ostringstream text;
  text.precision(17);
  text << static_cast<int>(d.kind) << ' ' << d.low << ' ' << d.high << ' ' << d.mean << ' ' << d.sd;
  for (const StudyValue& value : d.values) {
    text << ' ';
    value.is_number() ? text << value.number : text << value.json;
  }
  for (const double weight : d.weights) text << " w" << weight;
  return text.str();
}

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

Distribution uniform(double low, double high) {
  if (!std::isfinite(low) || !std::isfinite(high) || !(high > low))
    throw py::value_error("uniform: accepted: low below high, both finite");
  Distribution d;
  d.kind = Distribution::Kind::uniform;
  d.low = low;
  d.high = high;
  return d;
}

Distribution normal_of(Distribution::Kind kind, double mean, double sd, double low, double high) {
  const bool lognormal = kind == Distribution::Kind::lognormal;
  const char* const name = lognormal ? "lognormal" : "normal";
  if (!std::isfinite(mean) || !std::isfinite(sd) || !(sd > 0) || (lognormal && !(mean > 0)))
    throw py::value_error(std::string(name) + ": accepted: a finite mean" + (lognormal ? " above 0" : "") +
                          ", sd above 0");
  constexpr double reach = 8;  // sd: beyond, what is left of the distribution is below what doubles tell apart
  if (!(high > low) || (lognormal && !(high > 0)) ||
      (!lognormal && (low > mean + reach * sd || high < mean - reach * sd)))
    throw py::value_error(std::string(name) + ": accepted: low below high, within 8 sd of the mean");
  Distribution d;
  d.kind = kind;
  d.mean = mean;
  d.sd = sd;
  d.low = low;
  d.high = high;
  return d;
}

Distribution listed(Distribution::Kind kind, const py::iterable& values,
                    const std::optional<std::vector<double>>& weights) {
  Distribution d;
  d.kind = kind;
  constexpr std::size_t most = 1'000'000;
  for (const py::handle value : values) {
    if (d.values.size() == most) throw py::value_error("accepted: at most " + std::to_string(most) + " values");
    d.values.push_back(value_of(value));
  }
  if (d.values.empty()) throw py::value_error("accepted: at least one value");
  if (!weights) return d;
  const auto sound = [](double w) { return std::isfinite(w) && w >= 0; };
  if (weights->size() != d.values.size() || !std::all_of(weights->begin(), weights->end(), sound) ||
      std::all_of(weights->begin(), weights->end(), [](double w) { return w == 0; }))
    throw py::value_error("weights: accepted: a number of 0 or above for each value, one above 0 at least");
  d.weights = *weights;
  return d;
}

}  // namespace

void bind_distributions(py::module_& module) {
  py::class_<Distribution>(module, "Distribution", "How a variable of a Study is spread.")
      .def(
          "quantile",
          [](const Distribution& d, double share) {
            if (!(share > 0 && share < 1)) throw py::value_error("quantile: accepted: a share above 0 and below 1");
            return object_of(d.quantile(share));
          },
          py::arg("share"), "The value below which a share of it lies, 0 < share < 1.");
  module.def("uniform", &uniform, py::arg("low"), py::arg("high"),
             "Evenly spread from low to high. Raises ValueError.");
  module.def(
      "normal",
      [](double mean, double sd, double low, double high) {
        return normal_of(Distribution::Kind::normal, mean, sd, low, high);
      },
      py::arg("mean"), py::arg("sd"), py::kw_only(), py::arg("low") = -infinite, py::arg("high") = infinite,
      "Normal, cut off at low and high, with mean and standard deviation of the whole. Raises ValueError.");
  module.def(
      "lognormal",
      [](double mean, double sd, double low, double high) {
        return normal_of(Distribution::Kind::lognormal, mean, sd, low, high);
      },
      py::arg("mean"), py::arg("sd"), py::kw_only(), py::arg("low") = -infinite, py::arg("high") = infinite,
      "Lognormal, with mean and standard deviation of the variable itself, not of its logarithm; cut off as normal(). "
      "Raises ValueError.");
  module.def(
      "choice",
      [](const py::iterable& values, const std::optional<std::vector<double>>& weights) {
        return listed(Distribution::Kind::choice, values, weights);
      },
      py::arg("values"), py::arg("weights") = py::none(),
      "One of a list, numbers or anything that JSON can hold, by weights. Raises ValueError.");
  module.def(
      "grid", [](const py::iterable& values) { return listed(Distribution::Kind::grid, values, std::nullopt); },
      py::arg("values"), "Each of a list in turn, in all combinations with other grids. Raises ValueError.");
}

}  // namespace topple::python
