// results.json: see docs/results-format.md.
#include <algorithm>
#include <numeric>
#include <set>

#include "analysis/results/results_writer.h"
#include "model/index_of.h"
#include "parallel/in_order.h"
#include "topple/solver/blas_kernel.h"

namespace topple::structure {

namespace {

std::string as_value(std::string_view text) { return JsonWriter().value(text).release(); }

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
    return member.valid() && !std::binary_search(selection.members.begin(), selection.members.end(), index_of(member));
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
  return w_.release() + "\n";
}

void ResultsWriter::write(const std::function<void(std::string_view)>& sink) {
  const std::vector<Piece> all = pieces();
  const auto make = [&](std::size_t i, std::string& text) {
    ResultsWriter piece(*this, std::move(text));
    all[i](piece);
    text = piece.w_.release();
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
