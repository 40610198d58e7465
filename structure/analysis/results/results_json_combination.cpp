// What results.json says of one combination: displacements, reactions, members, panels with their meshes, joints, cuts.
#include <algorithm>

#include "analysis/results/results_writer.h"

namespace topple::structure {

void ResultsWriter::node_displacement(std::size_t node, const Vec6& displacement) {
  w_.newline().raw_key(names_->nodes[node]);
  list(displacement, movement_, 6);
}

/// And what stands between them and the members.
void ResultsWriter::reactions(const CombinationResult& c) {
  w_.close('}').newline().key("reactions").open('{');
  for (std::size_t i = 0; i < b_.supports.size(); ++i) {
    w_.newline().key(b_[b_.supports[i].node].name);
    list(c.reactions[i], force_, 6);
  }
  for (std::size_t i = 0; i < b_.edge_supports.size(); ++i) {
    w_.newline().key(b_[b_.joint(b_.edge_supports[i].panel, b_.edge_supports[i].edge)].name);
    list(c.edge_reactions[i], force_, 6);
  }
  w_.close('}').newline().key("members").open('{');
}

void ResultsWriter::behind_members(const CombinationResult& c) {
  w_.close('}').newline().key("panels").open('{');
  for (std::size_t i = 0; i < b_.panels.size(); ++i) panel(b_.panels[i], c.panels[i], c);
  w_.close('}').newline().key("joints").open('{');
  for (const std::size_t j : names_->breakable) joint(b_.joints[j], c.joints[j]);
  w_.close('}').newline().key("storeys").open('{');
  for (std::size_t i = 0; i < c.storeys.size(); ++i) {
    w_.key(std::to_string(i + 1)).open('{').key("drift").value(c.storeys[i].drift).key("shear").open('[');
    w_.value(c.storeys[i].shear[0] / b_.units.force).value(c.storeys[i].shear[1] / b_.units.force).close(']');
    if (result_.design_code) w_.key("utilisation").value(c.storeys[i].drift / result_.drift_limit);
    w_.close('}');
  }
  w_.close('}');
  if (!c.cuts.empty()) {
    w_.newline().key("cuts").open('{');
    for (std::size_t i = 0; i < c.cuts.size(); ++i) cut(result_.cuts[i], c.cuts[i]);
    w_.close('}');
  }
  w_.newline().key("equilibrium_error").value(c.equilibrium_error);
  w_.key("backward_error").value(c.quality.backward_error).key("condition").value(c.quality.condition);
  w_.key("error_bound").value(c.quality.error_bound);
  w_.key("discretisation_error").value(c.discretisation_error);
  largest_displacement(c.largest);
  w_.close('}');
}

/// Where it lies, all that passes it, and what each part has of it: six components in its axes about its point.
void ResultsWriter::cut(const SectionCut& cut, const CutResult& r) {
  const std::array<double, 1> length{b_.units.length}, one{1};
  w_.newline().key(cut.name).open('{').key("at");
  list(cut.at, length, 3);
  w_.key("axes").open('[');
  for (Eigen::Index row = 0; row < 3; ++row) list(Vec3(cut.axes.row(row)), one, 3);
  w_.close(']').key("resultant");
  list(r.force, force_, 6);
  w_.key("members").open('{');
  for (const auto& [id, force] : r.members) {
    w_.key(b_[id].name);
    list(force, force_, 6);
  }
  w_.close('}').key("panels").open('{');
  for (const auto& [id, force] : r.panels) {
    w_.key(b_[id].name);
    list(force, force_, 6);
  }
  w_.close('}').key("diaphragms").open('{');
  for (const auto& [d, force] : r.diaphragms) {
    w_.key(b_.diaphragms[d].name);
    list(force, force_, 6);
  }
  w_.close('}').close('}');
}

void ResultsWriter::largest_displacement(const LargestDisplacement& largest) {
  w_.key("largest_displacement").open('{').key("value").value(largest.value / b_.units.length).key("moved").open('[');
  for (const double component : largest.moved) w_.value(component / b_.units.length);
  w_.close(']');
  if (largest.member.valid())
    w_.key("member").value(b_[largest.member].name).key("at").value(largest.at / b_.units.length);
  else if (largest.mesh_node < 0 && largest.node.valid())
    w_.key("node").value(b_[largest.node].name);
  w_.close('}');
}

void ResultsWriter::design(const DesignResult& used) {
  if (used.governing.empty()) return;
  w_.key("utilisation").value(used.utilisation).key("governing").value(used.governing).key("clauses").open('{');
  for (const DesignClause& clause : used.clauses) w_.key(clause.clause).value(clause.utilisation);
  w_.close('}').key("lengths").open('{');
  const double unit = b_.units.length;
  w_.key("y").value(used.lengths.y / unit).key("y_from").value(std::string(length_source_name(used.length_source[0])));
  w_.key("z").value(used.lengths.z / unit).key("z_from").value(std::string(length_source_name(used.length_source[1])));
  for (const auto& [key, way] : {std::pair("y_not_from_modes", 0U), std::pair("z_not_from_modes", 1U)})
    if (const std::string_view why = mode_part_reason(used.mode_part[way]); !why.empty())
      w_.key(key).value(std::string(why));
  w_.key("torsion").value(used.lengths.torsion / unit).key("lateral").value(used.lengths.lateral / unit).close('}');
  if (used.yielded) w_.key("tau_b").value(used.yielded->tau_b);
  if (!used.refusal.empty()) w_.key("not_verified").value(used.refusal);
}

/// Written in two strokes without a look at what is between them: by far the most of the text is made here.
void ResultsWriter::member(std::size_t m, const MemberResult& r, const DesignResult* used) {
  constexpr std::size_t enough = 2048;  // for 32 numbers and what stands between them
  const std::string& key = names_->members[m];
  w_.newline().compose(key.size() + enough, [&](char* at) {
    at = put(key, at);
    at = put(R"({"end_forces":[)", at);
    for (std::size_t i = 0; i < 12; ++i) {
      if (i > 0) *at++ = ',';
      at = w_.write(in_units(r.end_forces(static_cast<Eigen::Index>(i)), force_[i % 6]), at);
    }
    *at++ = ']';
    return at;
  });
  w_.follow();
  if (used != nullptr) design(*used);
  w_.raw_key(r.active ? R"("active":true,"extremes":{)" : R"("active":false,"extremes":{)");
  w_.compose(enough, [&](char* at) {
    for (std::size_t q = 0; q < 8; ++q) {
      at = w_.write(in_units(r.min[q].value, diagram_[q]), names_->diagrams[q].put(at));
      *at++ = ',';
      at = put(R"(],"max":[)", w_.write(in_units(r.min[q].at, b_.units.length), at));
      at = w_.write(in_units(r.max[q].value, diagram_[q]), at);
      *at++ = ',';
      at = put("]}", w_.write(in_units(r.max[q].at, b_.units.length), at));
    }
    *at++ = '}';
    return at;
  });
  w_.follow();
  if (request_.stations > 0) stations(b_.members[m], r);
  w_.close('}');
}

void ResultsWriter::stations(const Member& member, const MemberResult& r) {
  // The analysis may have been asked for a multiple of the stations that are wanted here.
  const auto spaces = static_cast<std::size_t>(request_.stations);
  const std::size_t every = (r.stations.size() - 1) / spaces;
  w_.key("stations").open('{').key("at").open('[');
  for (std::size_t s = 0; s <= spaces; ++s)
    w_.value(member.length * static_cast<double>(s) / request_.stations / b_.units.length);
  w_.close(']');
  for (std::size_t q = 0; q < 8; ++q) {
    w_.key(diagram_names[q]).open('[');
    for (std::size_t s = 0; s <= spaces; ++s) w_.value(r.stations[s * every][q] / diagram_[q]);
    w_.close(']');
  }
  w_.close('}');
}

void ResultsWriter::panel(const Panel& panel, const PanelResult& r, const CombinationResult& c) {
  w_.newline().key(panel.name).open('{');
  resultants(r);
  w_.key("corner_forces").open('[');
  for (const Vec6& corner : r.corner_forces) list(corner, force_, 6);
  w_.close(']').key("elements").open('[');
  std::vector<int> nodes;
  for (const PanelElement& element : r.elements) {
    w_.newline().open('{').key("nodes").open('[');
    for (const int node : element.nodes) {
      auto at = std::find(nodes.begin(), nodes.end(), node);
      if (at == nodes.end()) at = nodes.insert(nodes.end(), node);
      w_.value(static_cast<std::size_t>(at - nodes.begin()));
    }
    w_.close(']');
    resultants(element);
    w_.close('}');
  }
  w_.close(']');
  if (!r.nodes.empty()) {
    w_.key("nodes").open('[');
    for (const PanelNode& node : r.nodes) {
      const auto at = std::find(nodes.begin(), nodes.end(), node.node);
      w_.newline().open('{').key("node").value(static_cast<std::size_t>(at - nodes.begin()));
      resultants(node);
      w_.close('}');
    }
    w_.close(']');
  }
  if (!nodes.empty()) {
    w_.key("discretisation_error").value(r.discretisation_error);
    mesh(nodes, c);
  }
  w_.close('}');
}

/// Places and displacements of a panel's mesh nodes, numbered as its elements do.
void ResultsWriter::mesh(const std::vector<int>& nodes, const CombinationResult& c) {
  const std::array<double, 1> length{b_.units.length};
  const auto own = [&](int node) { return static_cast<std::size_t>(node) < b_.nodes.size(); };
  const auto of_mesh = [&](int node) { return static_cast<std::size_t>(node) - b_.nodes.size(); };
  w_.key("places").open('[');
  for (const int node : nodes) {
    const auto n = static_cast<std::size_t>(node);
    list(own(node) ? b_.nodes[n].position : result_.mesh_nodes[of_mesh(node)], length, 3);
  }
  w_.close(']').newline().key("displacements").open('[');
  for (const int node : nodes) {
    const auto n = static_cast<std::size_t>(node);
    list(own(node) ? c.displacements[n] : c.mesh_displacements[of_mesh(node)], movement_, 6);
  }
  w_.close(']');
}

template <class Result>
void ResultsWriter::resultants(const Result& r) {
  const std::array<double, 1> tension{b_.units.force / b_.units.length}, bending{b_.units.force};
  w_.key("membrane");
  list(r.membrane, tension, 3);
  w_.key("moments");
  list(r.moments, bending, 3);
  w_.key("shears");
  list(r.shears, tension, 2);
}

void ResultsWriter::joint(const Joint& joint, const Utilisation& used) {
  if (!joint.capacity.breakable) return;
  w_.newline().key(joint.name).open('{').key("utilisation").value(used.value);
  w_.key("governing").value(sense_names[static_cast<std::size_t>(used.sense)]).close('}');
}

}  // namespace topple::structure
