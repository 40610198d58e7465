#include "study_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "svg_figure.h"

namespace topple::app {

namespace {

using namespace structure;

constexpr const char* blue = "#2b6cb0";
constexpr const char* red = "#c53030";
constexpr const char* grey = "#718096";

constexpr const char* head = R"(<!doctype html><html lang="en"><head><meta charset="utf-8"><title>)";
constexpr const char* style = R"(</title><style>
body{font:15px/1.45 system-ui,sans-serif;margin:2em auto;max-width:1000px;color:#1a202c;padding:0 1em}
h1{font-size:1.5em;margin-bottom:.2em}h2{font-size:1.15em;margin-top:2em;border-bottom:1px solid #cbd5e0}
table{border-collapse:collapse;font-size:13px}td,th{padding:.2em .7em;text-align:right;border-bottom:1px solid #e2e8f0}
td{white-space:nowrap}td:first-child,th:first-child{text-align:left}.figures{display:grid;grid-template-columns:1fr 1fr;gap:1em}
figure{margin:0;break-inside:avoid}figcaption{font-size:13px;color:#4a5568}svg{width:100%;height:auto;font:11px system-ui,sans-serif}
svg text{fill:#2d3748}.building{max-width:820px}.bar{print-color-adjust:exact;-webkit-print-color-adjust:exact;display:inline-block;height:.7em;background:#2b6cb0}
.bar.negative{background:#c53030}@media print{body{margin:0;max-width:none}h2{break-after:avoid}}
</style></head><body>
)";

std::string interval_text(const std::optional<Interval>& interval) {
  return interval ? short_text((*interval)[0]) + " to " + short_text((*interval)[1]) : "too few samples";
}

std::string percent(double share) { return short_text(100 * share) + " %"; }

std::string outputs_table(const StudyStatistics& statistics) {
  std::string text =
      "<table><tr><th>output</th><th>samples</th><th>mean</th><th>95 % interval of the mean</th><th>deviation</th>"
      "<th>least</th><th>5 %</th><th>median</th><th>95 %</th><th>largest</th></tr>\n";
  for (const OutputStatistics& output : statistics.outputs) {
    text += "<tr><td>" + escaped(output.name) + "</td><td>" + std::to_string(output.count) + "</td>";
    if (output.count == 0) {
      text += "<td colspan='8'>no sample has this number</td></tr>\n";
      continue;
    }
    for (const std::string& cell :
         {short_text(output.mean), interval_text(output.mean_interval), short_text(output.sd), short_text(output.least),
          short_text(output.quantiles[0].value), short_text(output.quantiles[2].value),
          short_text(output.quantiles[4].value), short_text(output.largest)})
      text += "<td>" + cell + "</td>";
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

std::vector<double> values_of(std::span<const Sample> samples, std::size_t output) {
  std::vector<double> values;
  for (const Sample& sample : samples)
    if (sample.failed.empty() && std::isfinite(sample.outputs[output])) values.push_back(sample.outputs[output]);
  return values;
}

/// Classes by Freedman and Diaconis (1981), at most 60.
std::string histogram(const OutputStatistics& output, const std::vector<double>& values) {
  const double spread = output.quantiles[3].value - output.quantiles[1].value, range = output.largest - output.least;
  const double wide = 2 * spread / std::cbrt(static_cast<double>(values.size()));
  const auto classes = static_cast<std::size_t>(std::clamp(wide > 0 ? std::ceil(range / wide) : 11.0, 5.0, 60.0));
  std::vector<double> counts(classes);
  for (const double value : values)
    ++counts[range > 0 ? std::min(classes - 1, static_cast<std::size_t>((value - output.least) / range *
                                                                        static_cast<double>(classes)))
                       : classes / 2];
  const double most = *std::max_element(counts.begin(), counts.end());
  const double half = range > 0 ? 0 : 0.5 * std::max(1.0, 0.1 * std::abs(output.least));
  const double from = output.least - half, step = (range + 2 * half) / static_cast<double>(classes);
  SvgFigure figure(output.name, "samples", {from, from + step * static_cast<double>(classes)}, {0, 1.08 * most});
  for (std::size_t c = 0; c < classes; ++c)
    figure.bar(from + step * static_cast<double>(c), from + step * static_cast<double>(c + 1), counts[c], "#90cdf4");
  figure.vertical(output.mean, blue, false);
  for (const std::size_t q : {0U, 2U, 4U}) figure.vertical(output.quantiles[q].value, grey, true);
  return "<figure>" + figure.svg() + "<figcaption>Distribution of " + escaped(output.name) +
         ": mean (line), 5 %, median and 95 % (dashed)</figcaption></figure>\n";
}

std::string convergence(const OutputStatistics& output) {
  if (output.convergence.size() < 3) return {};
  SvgFigure::Points mean, low, high;
  double least = output.mean, largest = output.mean;
  for (const auto& [count, value, half] : output.convergence) {
    if (count < 0.05 * output.convergence.back()[0]) continue;  // the first intervals would set the scale
    mean.emplace_back(count, value);
    low.emplace_back(count, value - half);
    high.emplace_back(count, value + half);
    least = std::min(least, value - half);
    largest = std::max(largest, value + half);
  }
  SvgFigure figure("samples", "mean of " + output.name, {0, output.convergence.back()[0]}, {least, largest});
  figure.band(low, high, blue);
  figure.line(mean, blue);
  return "<figure>" + figure.svg() +
         "<figcaption>Convergence of the mean, with its 95 % interval</figcaption></figure>\n";
}

/// A share or correlation: three decimals.
std::string share_text(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", share);
  return std::string(text) == "-0.000" ? "0.000" : text;
}

std::string index_text(const std::optional<std::array<double, 2>>& index) {
  return index ? share_text((*index)[0]) + " &plusmn; " + share_text((*index)[1]) : "";
}

std::string influences_table(const OutputInfluences& influences) {
  std::vector<InputInfluence> inputs = influences.inputs;
  std::stable_sort(inputs.begin(), inputs.end(), [](const InputInfluence& a, const InputInfluence& b) {
    return std::abs(a.rank_correlation) > std::abs(b.rank_correlation);
  });
  constexpr std::size_t most = 12;
  const bool total = std::any_of(inputs.begin(), inputs.end(), [](const auto& i) { return i.total.has_value(); });
  std::string text = "<h3>" + escaped(influences.output) + "</h3><table><tr><th>input</th><th>rank correlation</th>" +
                     "<th>95 % interval</th><th></th><th>first-order index</th>" +
                     (total ? "<th>total index</th>" : "") + "</tr>\n";
  for (std::size_t i = 0; i < std::min(most, inputs.size()); ++i) {
    const InputInfluence& one = inputs[i];
    text +=
        "<tr><td>" + escaped(one.input) + "</td><td>" + share_text(one.rank_correlation) + "</td><td>" +
        (one.interval ? share_text((*one.interval)[0]) + " to " + share_text((*one.interval)[1]) : "too few samples") +
        "</td><td style='text-align:left;min-width:130px'><span class='bar" +
        (one.rank_correlation < 0 ? " negative" : "") +
        "' style='width:" + std::to_string(static_cast<int>(120 * std::abs(one.rank_correlation))) +
        "px'></span></td><td>" + index_text(one.first_order) + "</td>" +
        (total ? "<td>" + index_text(one.total) + "</td>" : "") + "</tr>\n";
  }
  text += "</table>\n";
  if (inputs.size() > most) text += "<p>and " + std::to_string(inputs.size() - most) + " inputs of less weight</p>\n";
  return text;
}

std::string fragility_section(const Fragility& fragility) {
  const double from = fragility.classes.front().from, to = fragility.classes.back().to;
  SvgFigure figure(fragility.input, "probability of collapse", {from, to}, {0, 1});
  for (const Fragility::Class& one : fragility.classes) {
    const Interval wilson = one.collapsed.wilson();
    figure.mark(0.5 * (one.from + one.to), one.collapsed.share(), wilson[0], wilson[1], grey);
  }
  std::string told =
      "No curve is fitted: the likelihood has no maximum (every collapse lies on one side), or the input is "
      "not above 0 everywhere.";
  if (fragility.median) {
    SvgFigure::Points curve;
    constexpr int points = 120;
    for (int i = 0; i <= points; ++i) {
      const double x = from + (to - from) * i / points;
      const double z = std::log(x / *fragility.median) / *fragility.dispersion * (fragility.falling ? -1 : 1);
      curve.emplace_back(x, 0.5 * std::erfc(-z / std::sqrt(2.0)));
    }
    figure.line(curve, red);
    told = "Lognormal curve of greatest likelihood: median " + short_text(*fragility.median) + ", dispersion " +
           short_text(*fragility.dispersion) + ".";
  }
  return "<h2>Fragility</h2><div class='figures'><figure>" + figure.svg() +
         "<figcaption>Share of collapses in classes of equal counts, with Wilson intervals. " + told +
         "</figcaption></figure></div>\n";
}

std::string failures_section(std::span<const Sample> samples) {
  std::string text;
  std::size_t count = 0;
  for (const Sample& sample : samples) {
    if (sample.failed.empty()) continue;
    constexpr std::size_t most = 20;
    if (count++ < most)
      text += "<li>sample " + std::to_string(sample.number) + ": " + escaped(sample.failed) + "</li>\n";
  }
  if (count == 0) return {};
  return "<h2>Samples that failed</h2><p>" + std::to_string(count) + " in all.</p><ul>" + text + "</ul>\n";
}

/// The parts with the largest shares, by name: what is printed has no tips.
std::string most_often(const Building& building, const PartShares& shares) {
  std::vector<std::pair<double, std::string>> parts;
  const auto add = [&](const std::vector<double>& of, const auto& named, const char* kind) {
    for (std::size_t i = 0; i < std::min(of.size(), named.size()); ++i)
      if (of[i] > 0) parts.emplace_back(of[i], std::string(kind) + named[i].name);
  };
  add(shares.members, building.members, "member ");
  add(shares.panels, building.panels, "panel ");
  add(shares.joints, building.joints, "joint ");
  if (parts.empty()) return "<p>Nothing fell, broke or was overloaded in any sample.</p>\n";
  std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  constexpr std::size_t most = 10;
  std::string text = "<p>Most often: ";
  for (std::size_t i = 0; i < std::min(most, parts.size()); ++i)
    text += (i > 0 ? ", " : "") + escaped(parts[i].second) + " (" + percent(parts[i].first) + ")";
  return text + (parts.size() > most ? " and " + std::to_string(parts.size() - most) + " more" : "") + ".</p>\n";
}

}  // namespace

std::string study_page(const Study& study, const StudyTask& task, std::span<const Sample> samples,
                       const StudyStatistics& statistics, const Building* building, const std::string& chosen) {
  const std::string title = escaped(study.title.empty() ? "Study" : study.title);
  std::string text = head + title + style + "<h1>" + title + "</h1>\n" + chosen;
  if (chosen.empty() || statistics.done > 0)
    text += "<p>" + std::to_string(statistics.done) + " of " + std::to_string(statistics.planned) +
            (chosen.empty() ? "" : " unseen") + " samples of " + std::to_string(task.sampler.variables().size()) +
            (task.sampler.variables().size() == 1 ? " variable, " : " variables, ") +
            std::to_string(statistics.failed) + " failed. Intervals are of 95 %.</p>\n";
  if (statistics.collapse) {
    const Interval wilson = statistics.collapse->wilson();
    text += "<h2>Probability of collapse</h2><p><strong>" + percent(statistics.collapse->share()) + "</strong> (" +
            std::to_string(statistics.collapse->hits) + " of " + std::to_string(statistics.collapse->of) +
            " samples); Wilson interval " + percent(wilson[0]) + " to " + percent(wilson[1]) + ".</p>\n";
  }
  if (!statistics.outputs.empty()) text += "<h2>Outputs</h2>\n" + outputs_table(statistics) + "<div class='figures'>\n";
  for (std::size_t i = 0; i < statistics.outputs.size(); ++i) {
    const std::vector<double> values = values_of(samples, i);
    if (values.size() > 1) text += histogram(statistics.outputs[i], values) + convergence(statistics.outputs[i]);
  }
  if (!statistics.outputs.empty()) text += "</div>\n";
  if (!statistics.influences.empty()) text += "<h2>What it hangs on</h2>\n";
  for (const OutputInfluences& influences : statistics.influences) text += influences_table(influences);
  if (statistics.fragility && !statistics.fragility->classes.empty()) text += fragility_section(*statistics.fragility);
  if (building && statistics.parts.samples > 0)
    text += "<h2>Where it breaks</h2><figure>" + building_drawing(*building, statistics.parts) +
            "<figcaption>Members and panels by the share of samples in which they fell, joints (dots) by that in which "
            "they "
            "broke or were overloaded</figcaption></figure>\n" +
            most_often(*building, statistics.parts);
  return text + failures_section(samples) + "</body></html>\n";
}

}  // namespace topple::app
