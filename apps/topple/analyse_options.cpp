#include "analyse_options.h"

#include <algorithm>
#include <thread>

#include "support/command_line.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/input_files.h"
#include "topple/structure/formats/parse_cuts.h"
#include "topple/structure/modelling_checks.h"

namespace topple::app {

using namespace structure;

namespace {

std::vector<CombinationId> chosen(const Building& building, const std::vector<std::string>& names) {
  std::vector<CombinationId> ids;
  for (const std::string& name : names) {
    std::string known;
    std::vector<std::string> names_known;
    bool found = false;
    for (std::size_t i = 0; i < building.combinations.size(); ++i) {
      known += (known.empty() ? "" : ", ") + building.combinations[i].name;
      names_known.push_back(building.combinations[i].name);
      if (!matches_pattern(name, building.combinations[i].name)) continue;
      if (std::find(ids.begin(), ids.end(), CombinationId(i)) == ids.end()) ids.emplace_back(i);
      found = true;
    }
    if (!found)
      throw InputError(building.file + ": --combination " + name + ": no such combination" +
                       did_you_mean(name, names_known) + "; accepted: " + known);
  }
  return ids;
}

/// Members by name or pattern, and all members of groups.
LossRequest losses(const AnalyseOptions& options, const Building& building) {
  LossRequest request;
  if (options.sudden) request.sudden = *options.sudden;
  if (options.lose.empty() && options.lose_each.empty()) return request;
  const NameIndex names(building);
  std::vector<std::string> members;
  for (const Member& member : building.members) members.push_back(member.name);
  for (const std::string& name : options.lose) {
    const std::vector<MemberId> found = names.members_matching(name);
    if (found.empty())
      throw InputError(building.file + ": --lose " + name + ": no such member" + did_you_mean(name, members) +
                       "; accepted: a member's name, in which * stands for any run of characters");
    request.named.insert(request.named.end(), found.begin(), found.end());
  }
  for (const std::string& name : options.lose_each) {
    const NameIndex::Group* group = names.group(name);
    if (group == nullptr || group->members.empty())
      throw InputError(building.file + ": --lose-each " + name +
                       ": no such group of members; accepted: posts, beams, braces and the groups of the model");
    request.each.insert(request.each.end(), group->members.begin(), group->members.end());
  }
  return request;
}

/// Those of the model, then those of the command line's file.
std::vector<SectionCut> cuts(const AnalyseOptions& options, const std::filesystem::path& model,
                             const Building& building) {
  std::vector<SectionCut> all = read_model_cuts(model, building);
  if (options.cuts.empty()) return all;
  for (SectionCut& cut : read_section_cuts(options.cuts, building)) {
    for (const SectionCut& known : all)
      if (known.name == cut.name)
        throw InputError(options.cuts + ", cuts." + cut.name +
                         ": the model has a cut of that name; accepted: another name");
    all.push_back(std::move(cut));
  }
  return all;
}

/// What the command line asks for, else what the file asks for itself.
solver::SecondOrder second_order(const std::string& asked, const Building& building) {
  if (asked == "exact") return solver::SecondOrder::exact;
  if (asked == "cubic") return solver::SecondOrder::cubic;
  if (building.requested.cubic_p_delta) return solver::SecondOrder::frame3dd;
  return solver::SecondOrder::none;
}

int processors() { return static_cast<int>(std::thread::hardware_concurrency()); }

/// Options come before what the file asks for itself.
void request_modes(const AnalyseOptions& options, const RequestedAnalyses& requested, AnalysisRequest& request) {
  request.modes = options.modes > 0 ? options.modes : requested.modes;
  request.divide = options.divide;
  for (const auto& [asked, name] : {std::pair{!options.mass.empty(), "--mass"},
                                    {!options.torsional_mass.empty(), "--torsional-mass"},
                                    {options.rotary_inertia, "--rotary-inertia"}})
    if (asked && request.modes == 0)
      throw InputError(std::string(name) + ": no frequencies are asked for; accepted: with --modes");
  const bool lumped = options.mass.empty() ? requested.lumped_mass : options.mass == "lumped";
  // Only a Frame3DD file asks for modes itself: its elements spin with density x J and have rotary inertia.
  const bool frame3dd = requested.modes > 0;
  const bool by_j = options.torsional_mass.empty() ? frame3dd : options.torsional_mass == "j";
  if (lumped) request.mass = solver::MassDistribution::lumped;
  if (by_j) request.torsional_mass = solver::TorsionalMass::torsion_constant;
  request.rotary_inertia = options.rotary_inertia || frame3dd;
}

}  // namespace

void require_sound(const AnalyseOptions& options) {
  for (const auto& [asked, name] : {std::pair{options.html, "--html"},
                                    {options.csv, "--csv"},
                                    {options.vtu, "--vtu"},
                                    {options.diagnose, "--diagnose"}})
    if (asked && options.output.empty()) throw InputError(std::string(name) + ": name the folder for it with -o");
  if (options.drift_limit && options.code.empty())
    throw InputError("--drift-limit: nothing is checked; accepted: with --code");
  for (const auto& [asked, name] : {std::pair{!options.effective_lengths.empty(), "--effective-lengths"},
                                    {!options.warping.empty(), "--warping"},
                                    {!options.stiffeners.empty(), "--stiffeners"},
                                    {options.rigid_end_posts, "--rigid-end-posts"}})
    if (asked && options.code.empty())
      throw InputError(std::string(name) + ": nothing is checked; accepted: with --code");
  if (!options.direct_analysis.empty() && !options.effective_lengths.empty())
    throw InputError(
        "--effective-lengths: those of a direct analysis are the unbraced ones; accepted: no "
        "--direct-analysis");
  if (!options.direct_analysis.empty() && (options.code != "aisc360" || options.p_delta.empty()))
    throw InputError("--direct-analysis: the method of AISC 360 chapter C; accepted: with --code aisc360 --p-delta");
  if (options.divide > 1 && options.modes == 0)
    throw InputError("--divide: it is for natural modes; accepted: with --modes");
  if (options.sudden && options.lose.empty() && options.lose_each.empty())
    throw InputError("--sudden: nothing is lost; accepted: with --lose or --lose-each");
  check_motion_options(options.motion, !options.lose.empty() || !options.lose_each.empty(), !options.output.empty());
}

std::vector<CombinationId> combinations_of(const Building& building, const AnalyseOptions& options) {
  std::vector<CombinationId> ids = chosen(building, options.combinations);
  if (options.combinations.empty())
    for (std::size_t i = 0; i < building.combinations.size(); ++i) ids.emplace_back(i);
  return ids;
}

AnalysisRequest analysis_request(const AnalyseOptions& options, const std::filesystem::path& model,
                                 const Building& building) {
  AnalysisRequest request;
  if (options.direct_analysis.empty()) request.combinations = chosen(building, options.combinations);
  request.stations = options.stations;
  request.workers = options.threads;
  request.solver.threads = options.threads > 0 ? options.threads : std::max(1, processors());
  if (options.factor == "cholmod") request.solver.factorisation = solver::Factorisation::supernodal;
  request.second_order = second_order(options.p_delta, building);
  request.buckling = options.buckling;
  request.losses = losses(options, building);
  request_motion(options.motion, building, request);
  request.cuts = cuts(options, model, building);
  request_modes(options, building.requested, request);
  return request;
}

DesignInput design_input(const AnalyseOptions& options, const Building& building) {
  DesignInput input;
  if (options.effective_lengths == "charts") input.lengths = EffectiveLengths::charts;
  if (options.effective_lengths == "assumed") input.lengths = EffectiveLengths::assumed;
  if (!options.direct_analysis.empty()) input.lengths = EffectiveLengths::unbraced;
  input.rigid_end_posts = options.rigid_end_posts;
  if (!options.warping.empty()) input.warping_held = {options.warping == "held", options.warping == "held"};
  for (const std::string& given : options.stiffeners) {
    const std::size_t at = given.rfind('=');
    double spacing = 0;
    if (at == std::string::npos || !CLI::detail::lexical_cast(given.substr(at + 1), spacing) || !(spacing > 0))
      throw InputError("--stiffeners " + given + ": accepted: NAME=SPACING, a number above 0 in the model's length");
    input.stiffeners.emplace_back(given.substr(0, at), spacing * building.units.length);
  }
  return input;
}

}  // namespace topple::app
