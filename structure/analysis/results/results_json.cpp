// results.json: see docs/results-format.md.
#include <algorithm>
#include <numeric>
#include <set>

#include "analysis/results/results_writer.h"
#include "parallel/in_order.h"
#include "topple/solver/blas_kernel.h"

namespace topple::structure {

namespace {

std::string as_value(std::string_view text) { return JsonWriter().value(text).take(); }

}  // namespace

ResultsWriter::ResultsWriter(const Building& building, const AnalysisRequest& request, const AnalysisResult& result,
                             const std::map<std::string, double>& seconds)
    : b_(building), request_(request), result_(result), seconds_(seconds) {
  const Units& u = building.units;
  force_ = {u.force, u.force, u.force, u.force * u.length, u.force * u.length, u.force * u.length};
  movement_ = {u.length, u.length, u.length, 1, 1, 1};
  diagram_ = {u.force,  u.force, u.force, u.force * u.length, u.force * u.length, u.force * u.length,
              u.length, u.length};
  si_ = u.length == 1 && u.force == 1;
  auto names = std::make_shared<Names>();
  for (const Node& node : building.nodes) names->nodes.push_back(json_key(node.name));
  for (const Member& member : building.members) names->members.push_back(json_key(member.name));
  for (std::size_t j = 0; j < building.joints.size(); ++j)
    if (building.joints[j].capacity.breakable) names->breakable.push_back(j);
  names->written.nodes.resize(building.nodes.size());
  std::iota(names->written.nodes.begin(), names->written.nodes.end(), std::size_t{0});
  names->written.members.resize(building.members.size());
  std::iota(names->written.members.begin(), names->written.members.end(), std::size_t{0});
  for (const CombinationResult& c : result.combinations)
    names->combinations.push_back(as_value(building[c.combination].name));
  const auto from_last = [](std::size_t i, const char* name) {
    return ShortText((i > 0 ? "," : "") + json_key(name) + R"({"min":[)");
  };
  for (std::size_t q = 0; q < 8; ++q) names->diagrams[q] = from_last(q, diagram_names[q]);
  for (std::size_t i = 0; i < 6; ++i) names->node_components[i] = from_last(i, component_names[i]);
  names_ = std::move(names);
}

void ResultsWriter::select(const ResultsSelection& selection) {
  auto names = std::make_shared<Names>(*names_);
  names->written = selection;
  std::erase_if(names->breakable, [&](std::size_t j) {
    const MemberId member = b_.joints[j].member;
    return member.valid() && !std::binary_search(selection.members.begin(), selection.members.end(),
                                                 static_cast<std::size_t>(member.index));
  });
  names_ = std::move(names);
}

ResultsWriter::ResultsWriter(const ResultsWriter& whole, std::string storage)
    : b_(whole.b_),
      request_(whole.request_),
      result_(whole.result_),
      seconds_(whole.seconds_),
      force_(whole.force_),
      movement_(whole.movement_),
      diagram_(whole.diagram_),
      si_(whole.si_),
      names_(whole.names_),
      w_(std::move(storage)) {}

std::string ResultsWriter::diagnosis(const Diagnosis& diagnosis) {
  w_.open('{');
  header();
  w_.key("diagnosis").open('{').key("combination").value(b_[diagnosis.combination].name);
  w_.key("kind").value(diagnosis.kind).key("message").value(diagnosis.message).newline().key("nodes").open('[');
  for (const NodeId node : diagnosis.nodes) w_.value(b_[node].name);
  w_.close(']').newline().key("members").open('[');
  for (const MemberId member : diagnosis.members) w_.value(b_[member].name);
  w_.close(']').newline();
  shape(diagnosis.shape);
  w_.close('}').close('}');
  return w_.take() + "\n";
}

void ResultsWriter::write(const std::function<void(std::string_view)>& sink) {
  const std::vector<Piece> all = pieces();
  const auto make = [&](std::size_t i, std::string& text) {
    ResultsWriter piece(*this, std::move(text));
    all[i](piece);
    text = piece.w_.take();
  };
  in_order(all.size(), request_.workers, make, sink);
  sink("\n");
}

template <class Each>
void ResultsWriter::add_items(std::vector<Piece>& pieces, std::size_t count, Each each) {
  constexpr std::size_t together = 512;
  for (std::size_t first = 0; first < count; first += together)
    pieces.push_back([=](ResultsWriter& writer) {
      if (first > 0) writer.w_.follow();
      for (std::size_t i = first; i < std::min(count, first + together); ++i) each(writer, i);
    });
}

/// The text from its beginning to its end; each piece goes on where the one before it ends.
std::vector<ResultsWriter::Piece> ResultsWriter::pieces() const {
  std::vector<Piece> all;
  all.push_back([](ResultsWriter& to) {
    to.w_.open('{');
    to.header();
    if (to.result_.design_code) to.design_header();
    to.w_.key("combinations").open('{');
  });
  for (std::size_t k = 0; k < result_.combinations.size(); ++k) {
    const CombinationResult& c = result_.combinations[k];
    all.push_back([&c, k](ResultsWriter& to) {
      if (k > 0) to.w_.follow();
      to.w_.newline().key(to.b_[c.combination].name).open('{').key("displacements").open('{');
    });
    add_items(all, names_->written.nodes.size(), [&c](ResultsWriter& to, std::size_t i) {
      const std::size_t n = to.names_->written.nodes[i];
      to.node_displacement(n, c.displacements[n]);
    });
    all.push_back([&c](ResultsWriter& to) { to.reactions(c); });
    add_items(all, names_->written.members.size(), [&c](ResultsWriter& to, std::size_t i) {
      const std::size_t m = to.names_->written.members[i];
      to.member(m, c.members[m], c.designs.empty() ? nullptr : &c.designs[m]);
    });
    all.push_back([&c](ResultsWriter& to) { to.behind_members(c); });
  }
  all.push_back(
      [](ResultsWriter& to) { to.w_.close('}').newline().key("envelope").open('{').key("members").open('{'); });
  const bool any = !result_.combinations.empty();  // a structure that floats has modes alone
  add_items(all, any ? names_->written.members.size() : 0,
            [](ResultsWriter& to, std::size_t i) { to.member_envelope(to.names_->written.members[i]); });
  all.push_back([](ResultsWriter& to) {
    to.joint_envelope();
    to.w_.newline().key("displacements").open('{');
  });
  add_items(all, any ? names_->written.nodes.size() : 0,
            [](ResultsWriter& to, std::size_t i) { to.node_envelope(to.names_->written.nodes[i]); });
  all.push_back([](ResultsWriter& to) {
    to.w_.close('}').close('}').newline();
    if (to.request_.losses.any()) to.losses();
    if (to.request_.time_history) to.time_histories();
    if (to.request_.buckling > 0) to.buckling();
    if (to.request_.modes > 0) to.modes();
    if (!to.result_.unfinished.empty()) {
      to.w_.key("unfinished").open('[');
      for (const std::string& missing : to.result_.unfinished) to.w_.value(missing);
      to.w_.close(']').newline();
    }
    to.seconds();
    to.w_.close('}');
  });
  return all;
}

void ResultsWriter::header() {
  w_.key("topple").value(TOPPLE_VERSION).newline();
  w_.key("model").open('{');
  w_.key("title").value(b_.title).key("file").value(b_.file).key("nodes").value(b_.nodes.size());
  w_.key("members").value(b_.members.size()).key("panels").value(b_.panels.size());
  w_.key("freedoms").value(result_.statistics.freedoms).close('}').newline();
  w_.key("units").open('{').key("length").value(b_.units.length_name).key("force").value(b_.units.force_name);
  w_.key("mass").value(b_.units.mass_name).key("angle").value("rad").close('}').newline();
  w_.key("settings").open('{').key("p_delta").value(p_delta());
  w_.key("factorisation").value(result_.statistics.factorisation).key("ordering").value(result_.statistics.ordering);
  w_.key("threads").value(static_cast<std::size_t>(request_.solver.threads));
  w_.key("blas_kernel").value(solver::blas_kernel()).close('}').newline();
}

const char* ResultsWriter::p_delta() const {
  switch (request_.second_order) {
    case solver::SecondOrder::exact:
      return "exact";
    case solver::SecondOrder::cubic:
    case solver::SecondOrder::frame3dd:
      return "cubic";
    default:
      return "none";
  }
}

/// The code, the limit of the drift, and the formula of every clause that was evaluated.
void ResultsWriter::design_header() {
  w_.key("design").open('{').key("code").value(std::string(design_code_name(*result_.design_code)));
  w_.key("drift_limit").value(result_.drift_limit).key("formulas").open('{');
  std::set<std::string> clauses;
  for (const CombinationResult& c : result_.combinations)
    for (const DesignResult& used : c.designs)
      for (const DesignClause& clause : used.clauses) clauses.insert(clause.clause);
  for (const std::string& clause : clauses) w_.key(clause).value(std::string(design_formula(clause)));
  w_.close('}').key("not_checked").open('[');
  for (const std::string_view text : design_not_checked(*result_.design_code)) w_.value(std::string(text));
  w_.close(']').close('}').newline();
}

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

std::string results_json(const Building& building, const AnalysisRequest& request, const AnalysisResult& result,
                         const std::map<std::string, double>& seconds) {
  std::string text;
  write_results_json(building, request, result, seconds, [&](std::string_view piece) { text += piece; });
  return text;
}

void write_results_json(const Building& building, const AnalysisRequest& request, const AnalysisResult& result,
                        const std::map<std::string, double>& seconds,
                        const std::function<void(std::string_view)>& sink) {
  ResultsWriter(building, request, result, seconds).write(sink);
}

std::string results_json(const Building& building, const AnalysisRequest& request, const AnalysisResult& result,
                         const std::map<std::string, double>& seconds, const ResultsSelection& selection) {
  std::string text;
  ResultsWriter writer(building, request, result, seconds);
  writer.select(selection);
  writer.write([&](std::string_view piece) { text += piece; });
  return text;
}

std::string diagnosis_json(const Building& building, const AnalysisRequest& request, const Diagnosis& diagnosis) {
  const AnalysisResult nothing;
  const std::map<std::string, double> no_times;
  return ResultsWriter(building, request, nothing, no_times).diagnosis(diagnosis);
}

}  // namespace topple::structure
