// study.json.
#include <cmath>

#include "topple/structure/formats/json_tree.h"
#include "topple/structure/study/study_statistics.h"

namespace topple::structure {

namespace {

using Json = JsonTree;

Json interval_json(const std::optional<Interval>& interval) {
  return interval ? Json{(*interval)[0], (*interval)[1]} : Json(nullptr);
}

Json output_json(const OutputStatistics& output) {
  Json json = {{"count", output.count}, {"missing", output.missing}};
  if (output.count == 0) return json;
  json["mean"] = output.mean;
  json["mean_interval"] = interval_json(output.mean_interval);
  json["sd"] = output.sd;
  json["least"] = output.least;
  json["largest"] = output.largest;
  Json quantiles = Json::array();
  for (const StudyQuantile& q : output.quantiles)
    quantiles.push_back({{"share", q.share}, {"value", q.value}, {"interval", interval_json(q.interval)}});
  json["quantiles"] = std::move(quantiles);
  Json convergence = Json::array();
  for (const auto& [count, mean, half] : output.convergence) convergence.push_back({count, mean, half});
  json["convergence"] = std::move(convergence);
  return json;
}

Json proportion_json(const Proportion& proportion) {
  const Interval wilson = proportion.wilson();
  return {{"probability", proportion.share()},
          {"interval", {wilson[0], wilson[1]}},
          {"collapsed", proportion.hits},
          {"of", proportion.of}};
}

Json influences_json(const std::vector<OutputInfluences>& all) {
  Json json = Json::object();
  for (const OutputInfluences& influences : all) {
    Json& of_output = json[influences.output];
    for (const InputInfluence& one : influences.inputs) {
      Json& entry = of_output[one.input];
      entry = {{"rank_correlation", one.rank_correlation}, {"interval", interval_json(one.interval)}};
      const auto index = [](const std::array<double, 2>& i) { return Json{{"index", i[0]}, {"error", i[1]}}; };
      if (one.first_order) entry["first_order"] = index(*one.first_order);
      if (one.total) entry["total"] = index(*one.total);
    }
  }
  return json;
}

Json fragility_json(const Fragility& fragility) {
  Json classes = Json::array();
  for (const Fragility::Class& one : fragility.classes) {
    Json entry = proportion_json(one.collapsed);
    entry["from"] = one.from;
    entry["to"] = one.to;
    classes.push_back(std::move(entry));
  }
  Json json = {
      {"over", fragility.input}, {"classes", std::move(classes)}, {"median", nullptr}, {"dispersion", nullptr}};
  if (fragility.median) {
    json["median"] = *fragility.median;
    json["dispersion"] = *fragility.dispersion;
    json["falling"] = fragility.falling;
  }
  return json;
}

template <class Parts>
Json shares_json(const Parts& parts, const std::vector<double>& shares) {
  Json json = Json::object();
  for (std::size_t i = 0; i < shares.size(); ++i)
    if (shares[i] > 0) json.add(parts[i].name, shares[i]);
  return json;
}

}  // namespace

std::string study_json(const Study& study, const StudyTask&, std::span<const Sample> samples,
                       const StudyStatistics& statistics, const Building* building, const JsonTree& optimise) {
  Json json = {
      {"topple", TOPPLE_VERSION},
      {"study", {{"title", study.title}, {"file", std::filesystem::path(study.file).filename().string()}}},
      {"samples", {{"planned", statistics.planned}, {"done", statistics.done}, {"failed", statistics.failed}}}};
  Json outputs = Json::object();
  for (const OutputStatistics& output : statistics.outputs) outputs[output.name] = output_json(output);
  json["outputs"] = std::move(outputs);
  if (statistics.collapse) json["collapse"] = proportion_json(*statistics.collapse);
  json["influences"] = influences_json(statistics.influences);
  if (statistics.fragility) json["fragility"] = fragility_json(*statistics.fragility);
  if (building && statistics.parts.samples > 0)
    json["parts"] = {{"samples", statistics.parts.samples},
                     {"members_down", shares_json(building->members, statistics.parts.members)},
                     {"panels_down", shares_json(building->panels, statistics.parts.panels)},
                     {"joints_broken", shares_json(building->joints, statistics.parts.joints)}};
  Json failures = Json::array();
  constexpr std::size_t most = 100;
  for (const Sample& sample : samples)
    if (!sample.failed.empty() && failures.size() < most)
      failures.push_back({{"sample", sample.number}, {"reason", sample.failed}});
  json["failures"] = std::move(failures);
  if (!optimise.is_null()) json["optimise"] = optimise;
  return json.dump(1) + "\n";
}

}  // namespace topple::structure
