#pragma once
// The Python classes that hand out an analysis. Each keeps the whole result alive.
#include <map>
#include <memory>
#include <string>

#include "arrays.h"
#include "model.h"
#include "topple/structure/analysis.h"

namespace topple::python {

/// What an analysis found, and what it was asked for.
struct Analysis {
  std::shared_ptr<Model> model;
  std::shared_ptr<const structure::AnalysisResult> result;
  structure::AnalysisRequest request;
  std::map<std::string, double> seconds;
  [[nodiscard]] const structure::Building& building() const { return model->building(); }
};

/// One combination of it.
struct CombinationView {
  std::shared_ptr<const Analysis> analysis;
  std::size_t index = 0;
  [[nodiscard]] const structure::CombinationResult& get() const { return analysis->result->combinations[index]; }
  [[nodiscard]] const structure::Building& building() const { return analysis->building(); }
  [[nodiscard]] Owner owner() const { return analysis; }
};

/// A mode of vibration or buckling, a loss, a motion: a thing that lies in the result.
template <class Thing>
struct Part {
  std::shared_ptr<const Analysis> analysis;
  const Thing* thing = nullptr;
  [[nodiscard]] const Thing& get() const { return *thing; }
  [[nodiscard]] const structure::Building& building() const { return analysis->building(); }
  [[nodiscard]] Owner owner() const { return analysis; }
};
using ModeView = Part<solver::VibrationMode>;
using BucklingView = Part<solver::BucklingMode>;
using LossView = Part<structure::MemberLoss>;
using LossStateView = Part<structure::LossState>;
using MotionView = Part<structure::MotionResult>;

/// Handles for all things of a list.
template <class Thing>
[[nodiscard]] std::vector<Part<Thing>> parts_of(const std::shared_ptr<const Analysis>& analysis,
                                                const std::vector<Thing>& things) {
  std::vector<Part<Thing>> parts;
  parts.reserve(things.size());
  for (const Thing& thing : things) parts.push_back({analysis, &thing});
  return parts;
}

/// By utilisations: a field of a list of structure::Utilisation.
template <class T, class Get>
[[nodiscard]] py::array_t<T> use_field(const std::vector<structure::Utilisation>& uses, Get get, const Owner& owner) {
  return field_of<structure::Utilisation, T>(uses, get, owner);
}

void bind_combination(py::module_& module);

}  // namespace topple::python
