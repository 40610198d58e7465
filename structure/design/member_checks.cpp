#include "topple/structure/member_checks.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "design/alignment_chart.h"
#include "design/bracing.h"
#include "design/mode_lengths.h"
#include "design/turned_section.h"
#include "model/index_of.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

constexpr double sway_factor = 2;  // of a cantilever, fixed at one end and free to move at the other

/// The stretches of the compression flange between the member's restraints, and what lies between the nodes that hold
/// it where it goes on beyond its ends.
std::vector<LateralStretch> stretches(const Member& member, const HeldLength& held) {
  const MemberDesign& given = member.design;
  if (given.restrained_throughout) return {{0, member.length, 0, true}};
  if (given.restraints.empty() && held.free_end) return {{0, member.length, sway_factor * held.length, false}};
  if (given.restraints.empty() && !held.own) return {{0, member.length, held.length, false}};
  std::vector<LateralStretch> all;
  double last = 0;
  for (const double at : given.restraints) {
    if (at > last) all.push_back({last, at, at - last, true});
    last = at;
  }
  if (member.length > last) all.push_back({last, member.length, member.length - last, true});
  return all;
}

struct FoundLength {
  double length = 0;
  LengthSource source = LengthSource::own;
};

/// About y (way 0: sideways along z) or about z (way 1).
FoundLength flexural_length(const Building& building, const Bracing& bracing, EffectiveLengths method, MemberId id,
                            std::size_t way) {
  const Member& member = building[id];
  const MemberDesign& given = member.design;
  const int direction = way == 0 ? 2 : 1;
  if (given.lengths[way]) return {*given.lengths[way], LengthSource::given};
  if (given.factors[way]) return {*given.factors[way] * member.length, LengthSource::given};
  const HeldLength held = bracing.held_length(id, direction);
  if (method == EffectiveLengths::unbraced) return {held.length, LengthSource::own};
  if (held.free_end) return {sway_factor * held.length, LengthSource::cantilever};
  if (member.kind != MemberKind::post) return {held.length, LengthSource::own};
  if (method == EffectiveLengths::assumed) return {sway_factor * held.length, LengthSource::assumed_sway};
  const double ga = bracing.end_stiffness(held, 0, direction), gb = bracing.end_stiffness(held, 1, direction);
  if (bracing.braced(id, direction)) {
    if (std::min(ga, gb) >= released_end) return {held.length, LengthSource::own};
    return {chart_braced(ga, gb) * held.length, LengthSource::chart_braced};
  }
  if (std::min(ga, gb) >= released_end) return {held.length, LengthSource::leaning};
  return {chart_sway(ga, gb) * held.length, LengthSource::chart_sway};
}

DesignMember prepared(const Building& building, const Bracing& bracing, EffectiveLengths method, MemberId id) {
  const Member& member = building[id];
  const MemberDesign& given = member.design;
  DesignMember checked;
  checked.section = &building[member.section];
  checked.material = &building[member.material];
  for (std::size_t way = 0; way < 2; ++way) {
    const FoundLength found = flexural_length(building, bracing, method, id, way);
    (way == 0 ? checked.lengths.y : checked.lengths.z) = found.length;
    checked.length_source[way] = found.source;
  }
  // The compressed edge moves sideways in the direction in which the section is weaker.
  const HeldLength held = bracing.held_length(id, stronger_about_z(*checked.section) ? 2 : 1);
  checked.lengths.torsion =
      given.lengths[2] ? *given.lengths[2] : (given.factors[2] ? *given.factors[2] * member.length : held.length);
  checked.stretches = stretches(member, held);
  for (const LateralStretch& stretch : checked.stretches)
    checked.lengths.lateral = std::max(checked.lengths.lateral, stretch.length);
  // A factor of 1 is what a member has that says nothing of it: it is then found from the moments.
  const double factor = given.moment_factor == 1 ? 0 : given.moment_factor;
  checked.factors = {factor, given.equivalent_moment_y, given.equivalent_moment_z};
  return checked;
}

/// Codes' formulas are for factored loads: a combination whose factors are all 1 or less looks as if it had none.
void warn_of_unfactored(const Building& building, AnalysisResult& result) {
  std::string names;
  for (const CombinationResult& c : result.combinations) {
    const auto& factors = building[c.combination].factors;
    const bool factored = std::any_of(factors.begin(), factors.end(), [](const auto& f) { return f.second > 1; });
    if (!factored) names += (names.empty() ? "" : ", ") + building[c.combination].name;
  }
  if (!names.empty())
    result.warnings.push_back("design: no load has a factor above 1 in " + names +
                              "; the code's checks are for factored loads (EN 1990, LRFD)");
}

/// Of what clauses say, the part that effective lengths of compression have a hand in.
bool governed_by_buckling(const DesignResult& design) {
  constexpr std::string_view clauses[] = {"6.3.1", "6.3.3", "360 E", "360 H"};
  return std::any_of(std::begin(clauses), std::end(clauses),
                     [&](std::string_view clause) { return design.governing.find(clause) != std::string::npos; });
}

/// Members that fail by lengths which nobody has found for this structure: charts are of a storey whose posts all sway
/// at once, a given K = 2 of none at all.
void warn_of_lengths(const Building& building, EffectiveLengths method, AnalysisResult& result) {
  std::size_t worst = 0;
  double most = 1;
  LengthSource source = LengthSource::own;
  std::set<std::size_t> members;
  for (const CombinationResult& c : result.combinations) {
    if (!c.buckling.empty()) return;
    for (std::size_t m = 0; m < c.designs.size(); ++m) {
      const DesignResult& design = c.designs[m];
      if (!(design.utilisation > 1) || !governed_by_buckling(design)) continue;
      const auto assumed = std::find_if(design.length_source.begin(), design.length_source.end(), [](LengthSource s) {
        return s == LengthSource::chart_sway || s == LengthSource::assumed_sway;
      });
      if (assumed == design.length_source.end()) continue;
      members.insert(m);
      if (!(design.utilisation > most)) continue;
      worst = m;
      most = design.utilisation;
      source = *assumed;
    }
  }
  if (members.empty()) return;
  const std::string count = members.size() == 1 ? "" : " and " + std::to_string(members.size() - 1) + " more";
  std::string way = "the whole frame's buckling modes give them where members take part (--buckling N)";
  if (method == EffectiveLengths::assumed)
    way += ", alignment charts by the stiffness at the ends (without this option)";
  if (method == EffectiveLengths::charts) way += " without --effective-lengths charts";
  result.warnings.push_back("design: effective lengths are assumed where members are above 100 % by buckling (" +
                            building.members[worst].name + count + ": " + std::string(length_source_name(source)) +
                            "); " + way + ", `length_y`, `factor_y` ... in a member's \"design\" set them");
}

DesignResult checked(DesignCode code, const DesignMember& member, const Building& building, std::size_t m,
                     const MemberResult& forces, std::vector<DesignStep>* steps) {
  if (forces.stations.size() < 2 || forces.critical.empty())
    throw std::invalid_argument("check_design: the analysis was made without stations or critical sections");
  PlacedForces placed = forces_along(building.members[m], forces);
  DesignMember with_places = member;
  with_places.at = std::move(placed.at);
  try {
    if (steps == nullptr) return check_member(code, with_places, placed.forces);
    DesignAudit audit = audit_member(code, with_places, placed.forces);
    *steps = std::move(audit.steps);
    return audit.result;
  } catch (const InputError& error) {
    throw InputError(building.file + ": members." + building.members[m].name + ": " + error.what() +
                     "; or \"design\": \"none\" for a member that is not to be checked");
  }
}

}  // namespace

PlacedForces forces_along(const Member& member, const MemberResult& result) {
  struct Place {
    double at = 0;
    const std::array<double, 8>* values = nullptr;
  };
  std::vector<Place> places;
  constexpr double same = 1e-9;
  const auto is_critical = [&](double at) {
    return std::any_of(result.critical_at.begin(), result.critical_at.end(),
                       [&](double place) { return std::abs(place - at) <= same * member.length; });
  };
  const double steps = static_cast<double>(result.stations.size()) - 1;
  for (std::size_t s = 0; s < result.stations.size(); ++s)
    if (const double at = member.length * static_cast<double>(s) / steps; !is_critical(at))
      places.push_back({at, &result.stations[s]});
  for (std::size_t s = 0; s < result.critical.size(); ++s)
    places.push_back({result.critical_at[s], &result.critical[s]});
  // Both sides of a place keep their order.
  std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.at < b.at; });
  PlacedForces placed;
  for (const Place& place : places) {
    placed.at.push_back(place.at);
    SectionForces& forces = placed.forces.emplace_back();
    std::copy_n(place.values->begin(), forces.size(), forces.begin());
  }
  return placed;
}

DesignMembers::DesignMembers(const Building& building, const DesignInput& input)
    : building_(building), method_(input.lengths), members_(building.members.size()) {
  const Bracing bracing(building);
  for (std::size_t m = 0; m < members_.size(); ++m) {
    if (!building.members[m].design.checked) continue;
    members_[m] = prepared(building, bracing, method_, MemberId(m));
    members_[m].stiffener_spacing = building.members[m].design.stiffener_spacing;
    members_[m].rigid_end_post = input.rigid_end_posts;
    members_[m].warping_held = input.warping_held;
    if (!input.yielded.empty()) members_[m].yielded = input.yielded[m];
  }
  if (input.stiffeners.empty()) return;
  const NameIndex names(building);
  for (const auto& [name, spacing] : input.stiffeners) {
    std::vector<MemberId> stiffened = names.members_matching(name);
    if (const NameIndex::Group* group = names.group(name))
      stiffened.insert(stiffened.end(), group->members.begin(), group->members.end());
    if (stiffened.empty())
      throw InputError(building.file + ": stiffeners of " + name +
                       ": no such member; accepted: members' names, patterns with *, and groups");
    for (const MemberId id : stiffened) members_[index_of(id)].stiffener_spacing = spacing;
  }
}

/// sqrt(all compression of a storey/that of its posts that hold it up), as AISC 360 commentary C-A-7-8 has it for a
/// storey whose posts have the same critical force for their load.
DesignMembers::State DesignMembers::state(const CombinationResult& combination) const {
  State found;
  found.bends = largest_bends(building_, combination);
  std::map<StoreyLevels, std::array<double, 4>> sums;  // all and holding, about y and about z
  for (std::size_t m = 0; m < members_.size(); ++m) {
    if (building_.members[m].kind != MemberKind::post || members_[m].section == nullptr) continue;
    const solver::Vec12& forces = combination.members[m].end_forces;
    const double compression = std::max(0.0, (forces(0) - forces(6)) / 2);
    auto& sum = sums[storey_levels(building_, building_.members[m])];
    for (std::size_t way = 0; way < 2; ++way) {
      sum[2 * way] += compression;
      if (members_[m].length_source[way] != LengthSource::leaning) sum[2 * way + 1] += compression;
    }
  }
  for (const auto& [levels, sum] : sums)
    for (std::size_t way = 0; way < 2; ++way)
      found.leaning[levels][way] = sum[2 * way + 1] > 0 ? std::sqrt(sum[2 * way] / sum[2 * way + 1]) : 1;
  return found;
}

DesignMember DesignMembers::member(MemberId id, const CombinationResult& combination, const State& state) const {
  DesignMember checked = members_[index_of(id)];
  if (checked.section == nullptr) return checked;
  const auto length = [&](std::size_t way) -> double& { return way == 0 ? checked.lengths.y : checked.lengths.z; };
  for (std::size_t way = 0; way < 2; ++way)
    if (checked.length_source[way] == LengthSource::chart_sway)
      length(way) *= state.leaning.at(storey_levels(building_, building_[id]))[way];
  if (method_ != EffectiveLengths::automatic || combination.buckling.empty()) return checked;
  const auto from_modes = lengths_from_modes(building_, id, combination, state.bends);
  const auto longest = longest_by_modes(building_, id, combination);
  for (std::size_t way = 0; way < 2; ++way) {
    if (checked.length_source[way] == LengthSource::given) continue;
    checked.mode_part[way] = from_modes[way].part;
    if (from_modes[way].part == ModePart::takes_part) {
      length(way) = from_modes[way].length;
      checked.length_source[way] = LengthSource::buckling_analysis;
    } else if (longest[way] && *longest[way] < length(way)) {
      length(way) = *longest[way];
      checked.length_source[way] = LengthSource::lowest_factor;
    }
  }
  return checked;
}

void check_design(const Building& building, DesignCode code, double drift_limit, AnalysisResult& result,
                  const DesignInput& input) {
  if (building.units.consistent)
    throw InputError(building.file +
                     ": the units are \"consistent\", and a design check has units in its formulas; accepted: a model "
                     "that names its units");
  const DesignMembers members(building, input);
  for (CombinationResult& combination : result.combinations) {
    combination.designs.assign(building.members.size(), {});
    const DesignMembers::State state = members.state(combination);
    for (std::size_t m = 0; m < building.members.size(); ++m) {
      const DesignMember member = members.member(MemberId(m), combination, state);
      if (member.section != nullptr)
        combination.designs[m] = checked(code, member, building, m, combination.members[m], nullptr);
    }
  }
  warn_of_unfactored(building, result);
  warn_of_lengths(building, input.lengths, result);
  result.design_code = code;
  result.drift_limit = drift_limit;
}

DesignAudit audit_design(const DesignMembers& members, DesignCode code, MemberId member, const Building& building,
                         const CombinationResult& combination) {
  const auto m = index_of(member);
  const DesignMember taken = members.member(member, combination, members.state(combination));
  DesignAudit audit;
  if (taken.section != nullptr) audit.result = checked(code, taken, building, m, combination.members[m], &audit.steps);
  return audit;
}

}  // namespace topple::structure
