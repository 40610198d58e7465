// events.jsonl, summary.json and standing.json.
#include <algorithm>
#include <cstdio>

#include "topple/structure/collapse_report.h"
#include "topple/structure/formats/json_tree.h"
#include "topple/structure/formats/output_files.h"

namespace topple::structure {

namespace {

using Json = JsonTree;

constexpr std::array<const char*, 11> kind_names{
    "tool",  "impact",  "joint_yielded", "joint_broke", "panel_fractured", "mechanism", "detached",
    "split", "at_rest", "limited",       "done"};
constexpr std::array<const char*, 5> cause_names{"impact", "overload", "buckling", "bracing", "tool"};

Json array(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Json array(const Vec6& v) { return {v[0], v[1], v[2], v[3], v[4], v[5]}; }

const std::string& material_of(const Building& building, JointId id) {
  const Joint& joint = building[id];
  const MaterialId material = joint.member.valid() ? building[joint.member].material : building[joint.panel].material;
  return building[material].name;
}

void add_joint(Json& line, const Building& building, const SimulationEvent& event) {
  const JointBreak& broken = event.joint;
  line["cause"] = cause_names[static_cast<std::size_t>(broken.cause)];
  line["sense"] = sense_names[static_cast<std::size_t>(broken.sense)];
  line["demand"] = broken.demand;
  line["capacity"] = std::isfinite(broken.capacity) ? Json(broken.capacity) : Json(nullptr);
  line["generation"] = broken.generation;
  if (broken.inside) line["inside"] = *broken.inside;
  line["position"] = array(event.position);
  line["energy"] = broken.energy;
  line["material"] = material_of(building, broken.joint);
}

void add_parts(Json& line, const Building& building, const SimulationEvent& event) {
  Json members = Json::array(), panels = Json::array();
  for (const MemberId id : event.members) members.push_back(building[id].name);
  for (const PanelId id : event.panels) panels.push_back(building[id].name);
  line["members"] = std::move(members);
  line["panels"] = std::move(panels);
  line["mass"] = event.mass;
  line["position"] = array(event.position);
}

Json percentiles(const StepTimes::Percentiles& p) {
  return {{"mean", p.mean}, {"p50", p.p50}, {"p95", p.p95}, {"p99", p.p99}, {"max", p.max}};
}

Json ledger_json(const Ledger& ledger) {
  Json energy = Json::object();
  for (const auto& [name, value] : ledger_entries(ledger)) energy[name] = value;
  return {{"energy", std::move(energy)}, {"momentum_error", ledger.momentum_error}};
}

Json overlaps_json(const BodyOverlaps& overlaps) {
  Json json = {{"deep", overlaps.deep}, {"depth", overlaps.depth}};
  if (overlaps.depth == 0) return json;
  json["thickness"] = overlaps.thickness;
  json["time"] = overlaps.time;
  json["parts"] = {overlaps.body, overlaps.with};
  return json;
}

Json times_json(const StepTimes& times) {
  Json all = percentiles(times.whole());
  Json stages = Json::object();
  const std::array<double, 6> mean = times.mean_by_stage();
  for (std::size_t i = 0; i < mean.size(); ++i) stages[stage_names[i]] = mean[i];
  all["by_stage"] = std::move(stages);
  all["collision_engine"] = times.mean_collision_engine();
  all["without_collision_engine"] = percentiles(times.without_collision_engine());
  return all;
}

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

}  // namespace

CollapseCounts collapse_counts(const Simulation& simulation) {
  const Building& building = simulation.building();
  const StandingFrame& frame = simulation.frame();
  CollapseCounts counts;
  for (const SimulationEvent& event : simulation.events())
    counts.joints_broken += event.kind == SimulationEvent::Kind::joint_broke;
  for (std::size_t i = 0; i < building.members.size(); ++i) counts.members_down += !frame.stands(MemberId(i));
  for (std::size_t i = 0; i < building.panels.size(); ++i) counts.panels_down += !frame.stands(PanelId(i));
  counts.bodies = simulation.bodies().size();
  counts.standing_segments = static_cast<std::size_t>(frame.standing_segments());
  return counts;
}

std::string event_line(const Building& building, const SimulationEvent& event) {
  using Kind = SimulationEvent::Kind;
  Json line = {{"time", event.time}, {"step", event.step}, {"kind", kind_names[static_cast<std::size_t>(event.kind)]}};
  if (!event.name.empty()) line["name"] = event.name;
  switch (event.kind) {
    case Kind::joint_broke:
    case Kind::joint_yielded:
      add_joint(line, building, event);
      break;
    case Kind::detached:
    case Kind::mechanism:
    case Kind::split:
    case Kind::limited:
      add_parts(line, building, event);
      break;
    case Kind::impact:
      line["bodies"] = {event.body_name};
      line["mass"] = event.mass;
      line["peak_force"] = event.peak_force;
      line["speed_in"] = event.speed_in;
      line["speed_out"] = event.speed_out;
      line["position"] = array(event.position);
      break;
    case Kind::panel_fractured:
      line["position"] = array(event.position);
      break;
    case Kind::tool:
    case Kind::at_rest:
    case Kind::done:
      break;
  }
  return line.dump();
}

std::string summary_json(const Simulation& simulation, const StepTimes& times, double roof_sag) {
  const CollapseCounts counts = collapse_counts(simulation);
  const SimulationCounters& work = simulation.counters();
  Json summary = {{"topple", TOPPLE_VERSION},
                  {"scenario", std::filesystem::path(simulation.scenario().file).filename().string()},
                  {"hash", hex(simulation.hash())},
                  {"simulated_seconds", simulation.time()},
                  {"steps", simulation.steps()},
                  {"at_rest", simulation.at_rest()},
                  {"counts",
                   {{"joints_broken", counts.joints_broken},
                    {"members_down", counts.members_down},
                    {"panels_down", counts.panels_down},
                    {"bodies", counts.bodies},
                    {"standing_segments", counts.standing_segments}}},
                  {"work",
                   {{"steps_idle", work.steps_idle},
                    {"solves", work.solves},
                    {"low_rank", work.low_rank},
                    {"refactorisations", work.refactorisations},
                    {"segmentations", work.segmentations},
                    {"collision_steps", work.collision_steps},
                    {"contacts_ignored", work.contacts_ignored},
                    {"impacts_bounded", work.impacts_bounded},
                    {"impacts_together", work.impacts_together},
                    {"restricted", work.selective},
                    {"background_factors", work.background_factors},
                    {"late_factors", work.late_factors}}},
                  {"step_milliseconds", times_json(times)},
                  {"ledger", ledger_json(simulation.ledger())},
                  {"overlaps", overlaps_json(simulation.overlaps())},
                  {"roof_sag_at_start", roof_sag}};
  return summary.dump(2) + "\n";
}

namespace {

Json standing_reactions(const Building& building, const StandingFrame& frame) {
  Json reactions = Json::object();
  for (const NodeSupport& support : building.supports)
    if (frame.stands(support.node)) reactions.add(building[support.node].name, array(frame.reaction(support.node)));
  return reactions;
}

/// Those that stand; a member's utilisation is that of its joint nearer to its capacity.
Json standing_members(const Building& building, const StandingFrame& frame) {
  Json members = Json::object();
  for (std::size_t i = 0; i < building.members.size(); ++i) {
    const MemberId id(i);
    if (!frame.stands(id)) continue;
    Json forces = Json::array();
    const auto end_forces = frame.end_forces(id);
    for (int f = 0; f < 12; ++f) forces.push_back(end_forces(f));
    const double used =
        std::max(frame.utilisation(building.joint(id, 0)).value, frame.utilisation(building.joint(id, 1)).value);
    members.add(building[id].name, {{"end_forces", std::move(forces)}, {"utilisation", used}});
  }
  return members;
}

}  // namespace

std::string standing_json(const Simulation& simulation) {
  const Building& building = simulation.building();
  const StandingFrame& frame = simulation.frame();
  Json displacements = Json::object(), joints = Json::object();
  for (std::size_t i = 0; i < building.nodes.size(); ++i)
    if (frame.stands(NodeId(i))) displacements.add(building.nodes[i].name, array(frame.displacement(NodeId(i))));
  for (std::size_t i = 0; i < building.joints.size(); ++i) {
    const JointId id(i);
    const Joint& joint = building.joints[i];
    const bool stands = joint.member.valid() ? frame.stands(joint.member) : frame.stands(joint.panel);
    const bool holds = stands && frame.intact(id);
    Json entry = Json::object();
    if (holds) {
      const Utilisation used = frame.utilisation(id);
      entry["demand"] = array(frame.demand(id));
      entry["utilisation"] = used.value;
      if (joint.capacity.breakable) entry["governing"] = sense_names[static_cast<std::size_t>(used.sense)];
    }
    entry["holds"] = holds;
    entry["largest_utilisation"] = frame.largest_utilisation_so_far(id);
    joints.add(joint.name, std::move(entry));
  }
  Json standing = {{"topple", TOPPLE_VERSION},
                   {"scenario", std::filesystem::path(simulation.scenario().file).filename().string()},
                   {"units", {{"length", "m"}, {"force", "N"}, {"mass", "kg"}, {"angle", "rad"}}},
                   {"time", simulation.time()},
                   {"displacements", std::move(displacements)},
                   {"reactions", standing_reactions(building, frame)},
                   {"members", standing_members(building, frame)},
                   {"joints", std::move(joints)}};
  return standing.dump() + "\n";
}

void write_collapse(const std::filesystem::path& folder, const Simulation& simulation, const StepTimes& times,
                    double roof_sag) {
  std::string lines;
  for (const SimulationEvent& event : simulation.events()) lines += event_line(simulation.building(), event) + "\n";
  write_files(folder, {{"events.jsonl", lines},
                       {"standing.json", standing_json(simulation)},
                       {"summary.json", summary_json(simulation, times, roof_sag)}});
}

}  // namespace topple::structure
