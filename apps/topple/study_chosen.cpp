// What an optimisation has chosen, and how it came there.
#include <algorithm>
#include <cmath>

#include "study_page.h"
#include "svg_figure.h"
#include "topple/structure/formats/json_tree.h"

namespace topple::app {

using namespace structure;

namespace {

/// The best objective so far, of designs that keep to all bounds, over the runs.
std::string history(const Study& study, const OptimiseResult& result) {
  SvgFigure::Points best;
  const bool greatest = study.optimise->greatest;
  double so_far = 0, least = 0, largest = 0;
  for (const StudyDesign& design : result.designs) {
    if (design.violation > 0) continue;
    if (best.empty() || (greatest ? design.objective > so_far : design.objective < so_far)) so_far = design.objective;
    least = best.empty() ? so_far : std::min(least, so_far);
    largest = best.empty() ? so_far : std::max(largest, so_far);
    if (!best.empty()) best.emplace_back(static_cast<double>(design.run), best.back().second);
    best.emplace_back(static_cast<double>(design.run), so_far);
  }
  if (best.size() < 2) return {};
  best.emplace_back(static_cast<double>(result.designs.size()), so_far);
  const double margin = 0.05 * (largest - least);
  SvgFigure figure("designs tried", "best " + study.optimise->objective + " so far",
                   {0, static_cast<double>(result.designs.size())}, {least - margin, largest + margin});
  figure.line(best, "#2b6cb0");
  return "<div class='figures'><figure>" + figure.svg() +
         "<figcaption>The best design that keeps to all bounds, as the search goes on</figcaption></figure></div>\n";
}

std::string chosen_text(const StudyValue& value) {
  if (value.is_number()) return short_text(value.number);
  const JsonTree json = JsonTree::parse(value.json);
  return json.is_text() ? json.text() : value.json;
}

}  // namespace

std::string chosen_section(const Study& study, const StudyTask& task, const OptimiseResult& result) {
  if (result.designs.empty()) return {};
  std::string text = "<h2>Chosen</h2><p>The design with the " +
                     std::string(study.optimise->greatest ? "greatest " : "least ") +
                     escaped(study.optimise->objective) + " of " + std::to_string(result.designs.size()) + " tried (" +
                     result.method + "), run " + std::to_string(result.best.run) + ".";
  if (!result.finalists.empty())
    text += " The best " + std::to_string(result.finalists.size()) + " of the search were tried again on " +
            std::to_string(study.optimise->finalist_repeats) +
            " further samples each, and it is the best of these by all.";
  if (result.best.violation > 0) text += " <strong>It does not keep to all bounds.</strong>";
  if (!result.unseen.empty())
    text += " What follows below is of " + std::to_string(result.unseen.size()) +
            " samples of it that the search has not used.";
  text += "</p>\n<table><tr><th>chosen</th><th>value</th></tr>\n";
  for (std::size_t v = 0; v < result.best.chosen.size(); ++v) {
    const StudyValue& value = result.best.chosen[v];
    text += "<tr><td>" + escaped(result.chosen_names[v]) + "</td><td>" + escaped(chosen_text(value)) + "</td></tr>\n";
  }
  for (std::size_t i = 0; i < result.best.outputs.size(); ++i)
    text += "<tr><td>" + escaped(task.outputs[i]) +
            (result.finalists.empty() ? " in the search</td><td>" : " of all its samples until then</td><td>") +
            short_text(result.best.outputs[i]) + "</td></tr>\n";
  return text + "</table>\n" + history(study, result);
}

}  // namespace topple::app
