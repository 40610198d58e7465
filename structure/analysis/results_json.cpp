// results.json: see docs/results-format.md.
#include <algorithm>
#include <memory>
#include <set>

#include "formats/json_writer.h"
#include "side_by_side.h"
#include "topple/solver/blas_kernel.h"
#include "topple/structure/analysis.h"

namespace topple::structure {

namespace {

/// Writes in the model's units: every quantity is divided by its factor to SI.
class Writer {
 public:
  Writer(const Building& building, const AnalysisRequest& request, const AnalysisResult& result,
         const std::map<std::string, double>& seconds, JsonWriter writer = {})
      : b_(building), request_(request), result_(result), seconds_(seconds), w_(std::move(writer)) {
    const Units& u = building.units;
    force_ = {u.force, u.force, u.force, u.force * u.length, u.force * u.length, u.force * u.length};
    movement_ = {u.length, u.length, u.length, 1, 1, 1};
    diagram_ = {u.force,  u.force, u.force, u.force * u.length, u.force * u.length, u.force * u.length,
                u.length, u.length};
    auto keys = std::make_shared<Keys>();
    for (const Node& node : building.nodes) keys->nodes.push_back(json_key(node.name));
    for (const Member& member : building.members) keys->members.push_back(json_key(member.name));
    for (std::size_t q = 0; q < 8; ++q) keys->diagrams[q] = json_key(diagram_names[q]) + R"({"min":[)";
    keys_ = std::move(keys);
  }

  /// The header keys and what moves.
  std::string write_diagnosis(const Diagnosis& diagnosis) {
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

  std::string write() {
    write_all();
    return w_.take() + "\n";
  }

  /// To the writer's sink.
  void stream() {
    write_all();
    w_.finish();
  }

 private:
  /// Names as keys, made once.
  struct Keys {
    std::vector<std::string> nodes, members;
    std::array<std::string, 8> diagrams;  ///< up to the first number
  };

  /// For a part of what another one writes, into the storage of an earlier text.
  Writer(const Writer& whole, std::string storage)
      : b_(whole.b_),
        request_(whole.request_),
        result_(whole.result_),
        seconds_(whole.seconds_),
        force_(whole.force_),
        movement_(whole.movement_),
        diagram_(whole.diagram_),
        keys_(whole.keys_),
        w_(std::move(storage)) {}

  void write_all() {
    w_.open('{');
    header();
    if (result_.design_code) design_header();
    w_.key("combinations").open('{');
    for (const CombinationResult& c : result_.combinations) combination(c);
    w_.close('}').newline();
    envelope();
    if (request_.losses.any()) losses();
    if (request_.buckling > 0) buckling();
    if (request_.modes > 0) modes();
    w_.key("seconds").open('{');
    for (const auto& [stage, time] : seconds_) w_.key(stage).value(time);
    w_.close('}').close('}');
  }

  void header() {
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

  [[nodiscard]] const char* p_delta() const {
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
  void design_header() {
    w_.key("design").open('{').key("code").value(std::string(design_code_name(*result_.design_code)));
    w_.key("drift_limit").value(result_.drift_limit).key("formulas").open('{');
    std::set<std::string> clauses;
    for (const CombinationResult& c : result_.combinations)
      for (const DesignResult& used : c.designs)
        for (const DesignClause& clause : used.clauses) clauses.insert(clause.clause);
    for (const std::string& clause : clauses) w_.key(clause).value(std::string(design_formula(clause)));
    w_.close('}').close('}').newline();
  }

  template <class Values, class Factors>
  void list(const Values& values, const Factors& factors, int count) {
    w_.open('[');
    for (int i = 0; i < count; ++i) w_.value(values[i] / factors[static_cast<std::size_t>(i) % factors.size()]);
    w_.close(']');
  }

  /// Calls each(writer, i) for every item of a list: some hundred of them at a time by a writer of their own, as many
  /// of those at once as there are threads.
  template <class Each>
  void items(std::size_t count, Each each) {
    constexpr std::size_t together = 512;
    const std::size_t chunks = (count + together - 1) / together, at_once = workers_for(chunks, request_.workers);
    if (at_once == 1) {
      for (std::size_t i = 0; i < count; ++i) each(*this, i);
      return;
    }
    texts_.resize(at_once);
    for (std::size_t from = 0; from < chunks; from += at_once) {
      const std::size_t batch = std::min(at_once, chunks - from);
      side_by_side(batch, request_.workers, [&](std::size_t k) {
        Writer own(*this, std::move(texts_[k]));
        const std::size_t first = (from + k) * together;
        for (std::size_t i = first; i < std::min(count, first + together); ++i) each(own, i);
        texts_[k] = own.w_.take();
      });
      for (std::size_t k = 0; k < batch; ++k) w_.item(texts_[k]);
    }
  }

  void combination(const CombinationResult& c) {
    w_.newline().key(b_[c.combination].name).open('{');
    w_.key("displacements").open('{');
    for (std::size_t i = 0; i < b_.nodes.size(); ++i) {
      w_.newline().raw_key(keys_->nodes[i]);
      list(c.displacements[i], movement_, 6);
    }
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
    items(b_.members.size(), [&](Writer& writer, std::size_t i) {
      writer.member(i, c.members[i], c.designs.empty() ? nullptr : &c.designs[i]);
    });
    w_.close('}').newline().key("panels").open('{');
    for (std::size_t i = 0; i < b_.panels.size(); ++i) panel(b_.panels[i], c.panels[i], c);
    w_.close('}').newline().key("joints").open('{');
    for (std::size_t i = 0; i < b_.joints.size(); ++i) joint(b_.joints[i], c.joints[i]);
    w_.close('}').newline().key("storeys").open('{');
    for (std::size_t i = 0; i < c.storeys.size(); ++i) {
      w_.key(std::to_string(i + 1)).open('{').key("drift").value(c.storeys[i].drift).key("shear").open('[');
      w_.value(c.storeys[i].shear[0] / b_.units.force).value(c.storeys[i].shear[1] / b_.units.force).close(']');
      if (result_.design_code) w_.key("utilisation").value(c.storeys[i].drift / result_.drift_limit);
      w_.close('}');
    }
    w_.close('}').newline().key("equilibrium_error").value(c.equilibrium_error);
    w_.key("backward_error").value(c.quality.backward_error).key("condition").value(c.quality.condition);
    w_.key("error_bound").value(c.quality.error_bound).close('}');
  }

  void design(const DesignResult& used) {
    if (used.governing.empty()) return;
    w_.key("utilisation").value(used.utilisation).key("governing").value(used.governing).key("clauses").open('{');
    for (const DesignClause& clause : used.clauses) w_.key(clause.clause).value(clause.utilisation);
    w_.close('}');
  }

  void member(std::size_t m, const MemberResult& r, const DesignResult* used) {
    w_.newline().raw_key(keys_->members[m]).raw_value(R"({"end_forces":)");
    list(r.end_forces, force_, 12);
    if (used != nullptr) design(*used);
    w_.raw_key(r.active ? R"("active":true,"extremes":{)" : R"("active":false,"extremes":{)");
    for (std::size_t q = 0; q < 8; ++q) {
      w_.raw_key(keys_->diagrams[q]).value(r.min[q].value / diagram_[q]).value(r.min[q].at / b_.units.length);
      w_.raw_value(R"(],"max":[)").value(r.max[q].value / diagram_[q]).value(r.max[q].at / b_.units.length);
      w_.raw_value("]}");
    }
    w_.close('}');
    if (request_.stations > 0) stations(b_.members[m], r);
    w_.close('}');
  }

  void stations(const Member& member, const MemberResult& r) {
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

  void panel(const Panel& panel, const PanelResult& r, const CombinationResult& c) {
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
    if (!nodes.empty()) mesh(nodes, c);
    w_.close('}');
  }

  /// Places and displacements of a panel's mesh nodes, numbered as its elements do.
  void mesh(const std::vector<int>& nodes, const CombinationResult& c) {
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
  void resultants(const Result& r) {
    const std::array<double, 1> tension{b_.units.force / b_.units.length}, bending{b_.units.force};
    w_.key("membrane");
    list(r.membrane, tension, 3);
    w_.key("moments");
    list(r.moments, bending, 3);
    w_.key("shears");
    list(r.shears, tension, 2);
  }

  void joint(const Joint& joint, const Utilisation& used) {
    if (!joint.capacity.breakable) return;
    w_.newline().key(joint.name).open('{').key("utilisation").value(used.value);
    w_.key("governing").value(sense_names[static_cast<std::size_t>(used.sense)]).close('}');
  }

  /// The largest and smallest over the combinations, with the combination's name.
  template <class Of>
  const CombinationResult& best(Of of) const {
    return *std::max_element(result_.combinations.begin(), result_.combinations.end(),
                             [&](const auto& a, const auto& b) { return of(a) < of(b); });
  }

  void bound(const Extreme& e, double factor, const CombinationResult& c) {
    w_.open('[').value(e.value / factor).value(e.at / b_.units.length).value(b_[c.combination].name).close(']');
  }

  void losses() {
    w_.key("losses").open('{');
    for (const MemberLoss& loss : result_.losses.losses) {
      w_.newline().key(b_[loss.member].name).open('{');
      for (const LossState& state : loss.states) {
        w_.key(b_[state.combination].name).open('{');
        state.stands() ? loss_state(state) : loss_mechanism(state);
        w_.close('}');
      }
      w_.close('}');
    }
    w_.close('}').newline();
  }

  void loss_mechanism(const LossState& state) {
    w_.key("mechanism").open('{').key("text").value(state.mechanism).key("nodes").open('{');
    for (const auto& [node, motion] : state.motion) {
      w_.key(b_[node].name);
      shape_of(motion);
    }
    w_.close('}').key("members").open('[');
    for (const MemberId member : state.loose) w_.value(b_[member].name);
    w_.close(']').close('}');
  }

  void loss_state(const LossState& state) {
    if (state.worst.valid()) {
      w_.key("worst").open('{').key("joint").value(b_[state.worst].name).key("utilisation").value(state.use.value);
      w_.key("governing").value(sense_names[static_cast<std::size_t>(state.use.sense)]).close('}');
    }
    w_.key("survives").value(state.survives()).key("displacements").open('{');
    for (std::size_t n = 0; n < state.displacements.size(); ++n) {
      w_.raw_key(keys_->nodes[n]);
      list(state.displacements[n], movement_, 6);
    }
    w_.close('}').key("members").open('{');
    for (const auto& [member, forces] : state.end_forces) {
      w_.key(b_[member].name).open('{').key("end_forces");
      list(forces, force_, 12);
      w_.close('}');
    }
    w_.close('}').key("joints").open('{');
    for (const auto& [id, used] : state.joints) joint(b_[id], used);
    w_.close('}');
  }

  /// A shape's largest translation is 1, whatever the unit of length; its rotations go with it.
  void shape_of(const Vec6& motion) {
    const std::array<double, 6> scale{1, 1, 1, 1 / b_.units.length, 1 / b_.units.length, 1 / b_.units.length};
    list(motion, scale, 6);
  }

  void buckling() {
    w_.key("buckling").open('{');
    for (const CombinationResult& c : result_.combinations) {
      w_.newline().key(b_[c.combination].name).open('[');
      for (const solver::BucklingMode& mode : c.buckling) {
        w_.newline().open('{').key("factor").value(mode.factor);
        shape(mode.shape);
        w_.close('}');
      }
      w_.close(']');
    }
    w_.close('}').newline();
  }

  void modes() {
    w_.key("modes").open('[');
    for (const solver::VibrationMode& mode : result_.modes) {
      constexpr double pi = 3.14159265358979323846;
      w_.newline().open('{').key("frequency").value(mode.angular_frequency / (2 * pi));
      w_.key("angular_frequency").value(mode.angular_frequency).key("mass_share");
      list(mode.mass_share, std::array<double, 1>{1}, 6);
      shape(mode.shape);
      w_.close('}');
    }
    w_.close(']').newline();
  }

  void shape(const std::vector<Vec6>& motion) {
    w_.key("shape").open('{');
    for (std::size_t n = 0; n < b_.nodes.size(); ++n) {
      w_.raw_key(keys_->nodes[n]);
      shape_of(motion[n]);
    }
    w_.close('}');
  }

  void member_envelope(std::size_t m) {
    w_.newline().raw_key(keys_->members[m]).open('{');
    for (std::size_t q = 0; q < 8; ++q) {
      const auto& low = best([&](const CombinationResult& c) { return -c.members[m].min[q].value; });
      const auto& high = best([&](const CombinationResult& c) { return c.members[m].max[q].value; });
      w_.key(diagram_names[q]).open('{').key("min");
      bound(low.members[m].min[q], diagram_[q], low);
      w_.key("max");
      bound(high.members[m].max[q], diagram_[q], high);
      w_.close('}');
    }
    if (result_.design_code && !result_.combinations.front().designs[m].governing.empty()) {
      const auto& worst = best([&](const CombinationResult& c) { return c.designs[m].utilisation; });
      w_.key("utilisation").open('[').value(worst.designs[m].utilisation).value(b_[worst.combination].name).close(']');
    }
    w_.close('}');
  }

  void envelope() {
    w_.key("envelope").open('{').key("members").open('{');
    items(b_.members.size(), [](Writer& writer, std::size_t m) { writer.member_envelope(m); });
    w_.close('}').newline().key("joints").open('{');
    for (std::size_t j = 0; j < b_.joints.size(); ++j) {
      if (!b_.joints[j].capacity.breakable) continue;
      const auto& worst = best([&](const CombinationResult& c) { return c.joints[j].value; });
      w_.newline()
          .key(b_.joints[j].name)
          .open('[')
          .value(worst.joints[j].value)
          .value(b_[worst.combination].name)
          .close(']');
    }
    w_.close('}').newline().key("displacements").open('{');
    for (std::size_t n = 0; n < b_.nodes.size(); ++n) {
      w_.newline().raw_key(keys_->nodes[n]).open('{');
      for (int i = 0; i < 6; ++i) {
        const auto& low = best([&](const CombinationResult& c) { return -c.displacements[n][i]; });
        const auto& high = best([&](const CombinationResult& c) { return c.displacements[n][i]; });
        const double factor = movement_[static_cast<std::size_t>(i)];
        w_.key(component_names[static_cast<std::size_t>(i)]).open('{').key("min").open('[');
        w_.value(low.displacements[n][i] / factor).value(b_[low.combination].name).close(']').key("max").open('[');
        w_.value(high.displacements[n][i] / factor).value(b_[high.combination].name).close(']').close('}');
      }
      w_.close('}');
    }
    w_.close('}').close('}').newline();
  }

  const Building& b_;
  const AnalysisRequest& request_;
  const AnalysisResult& result_;
  const std::map<std::string, double>& seconds_;
  std::array<double, 6> force_, movement_;
  std::array<double, 8> diagram_;
  std::shared_ptr<const Keys> keys_;
  JsonWriter w_;
  std::vector<std::string> texts_;  ///< of items(), their storage kept
};

}  // namespace

std::string results_json(const Building& building, const AnalysisRequest& request, const AnalysisResult& result,
                         const std::map<std::string, double>& seconds) {
  return Writer(building, request, result, seconds).write();
}

void write_results_json(const Building& building, const AnalysisRequest& request, const AnalysisResult& result,
                        const std::map<std::string, double>& seconds,
                        const std::function<void(std::string_view)>& sink) {
  Writer(building, request, result, seconds, JsonWriter(sink)).stream();
}

std::string diagnosis_json(const Building& building, const AnalysisRequest& request, const Diagnosis& diagnosis) {
  const AnalysisResult nothing;
  const std::map<std::string, double> no_times;
  return Writer(building, request, nothing, no_times).write_diagnosis(diagnosis);
}

}  // namespace topple::structure
