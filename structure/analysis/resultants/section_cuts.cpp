#include "analysis/resultants/section_cuts.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "analysis/resultants/shell_results.h"
#include "model/index_of.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

/// Forces at places, added up about a point.
class Resultant {
 public:
  explicit Resultant(const Vec3& about) : about_(about) {}
  void add(const Vec3& at, const Vec3& force, const Vec3& moment) {
    sum_.head<3>() += force;
    sum_.tail<3>() += (at - about_).cross(force) + moment;
  }
  void add(const Vec3& at, const Vec6& load) { add(at, load.head<3>(), load.tail<3>()); }
  [[nodiscard]] const Vec6& sum() const { return sum_; }

 private:
  Vec3 about_;
  Vec6 sum_ = Vec6::Zero();
};

/// The structure as it bears one combination.
struct State {
  const Building& building;
  const Frame& frame;
  const PartLoads& parts;
  const solver::LoadSet& loads;
  const solver::StaticSolution& solution;
  bool displaced;

  [[nodiscard]] const Vec6& moved(int node) const { return solution.displacements[static_cast<std::size_t>(node)]; }
  [[nodiscard]] const Vec3& rest(int node) const { return frame.model.nodes[static_cast<std::size_t>(node)]; }
  /// Where what acts on a node, or at the end of a rigid arm of it, acts.
  [[nodiscard]] Vec3 position(int node, const Vec3& arm = Vec3::Zero()) const {
    Vec3 at = rest(node) + arm;
    if (displaced) at += moved(node).head<3>() + moved(node).tail<3>().cross(arm);
    return at;
  }
  /// What a node does to the end of a beam, global.
  [[nodiscard]] Vec6 end_force(int beam, std::size_t end) const {
    const Mat3 axes = frame.model.beams[static_cast<std::size_t>(beam)].axes.transpose();
    const solver::Vec12& forces = solution.beam_end_forces[static_cast<std::size_t>(beam)];
    const auto first = static_cast<Eigen::Index>(6 * end);
    Vec6 global;
    global << axes * forces.segment<3>(first), axes * forces.segment<3>(first + 3);
    return global;
  }
};

/// What hangs and acts on each node, for cuts through rigid floors.
struct AtNodes {
  std::vector<std::vector<std::pair<int, std::size_t>>> beams, shells;  ///< with the end, the corner
  std::vector<Vec6> given;                                              ///< loads and reactions

  explicit AtNodes(const State& s) {
    const auto& model = s.frame.model;
    if (model.diaphragms.empty()) return;
    const auto add = [&](auto& lists, const auto& elements) {
      lists.resize(model.nodes.size());
      for (std::size_t e = 0; e < elements.size(); ++e)
        for (std::size_t k = 0; k < elements[e].node.size(); ++k)
          lists[static_cast<std::size_t>(elements[e].node[k])].emplace_back(static_cast<int>(e), k);
    };
    add(beams, model.beams);
    add(shells, model.shells);
    given.assign(model.nodes.size(), Vec6::Zero());
    for (const solver::NodeLoad& load : s.loads.nodes) given[static_cast<std::size_t>(load.node)] += load.load;
    for (std::size_t r = 0; r < model.supports.size(); ++r)
      given[static_cast<std::size_t>(model.supports[r].node)] += s.solution.reactions[r];
  }
};

/// Reads one cut.
class Cut {
 public:
  Cut(const State& state, const SectionCut& cut, const std::vector<std::vector<const solver::BeamLoad*>>& beam_loads,
      const AtNodes& at_nodes, double size)
      : s_(state), cut_(cut), beam_loads_(beam_loads), at_nodes_(at_nodes), tolerance_(rounding * size) {}

  [[nodiscard]] CutResult read() const {
    CutResult result;
    const auto add = [&](auto& list, auto id, const Vec6& global) {
      Vec6 own;
      own << cut_.axes * global.head<3>(), cut_.axes * global.tail<3>();
      list.emplace_back(id, own);
      result.force += own;
    };
    const auto chosen = [&](const auto& list, auto id) {
      return cut_.everything || std::binary_search(list.begin(), list.end(), id);
    };
    for (std::size_t m = 0; m < s_.building.members.size(); ++m)
      if (const MemberId id(m); chosen(cut_.members, id) && passes_member(m))
        add(result.members, id, through_member(m));
    for (std::size_t p = 0; p < s_.building.panels.size(); ++p)
      if (const PanelId id(p); chosen(cut_.panels, id) && passes_panel(p)) add(result.panels, id, through_panel(p));
    if (!cut_.everything) return result;
    for (std::size_t d = 0; d < s_.frame.model.diaphragms.size(); ++d)
      if (passes(s_.frame.model.diaphragms[d].nodes)) add(result.diaphragms, d, through_diaphragm(d));
    return result;
  }

 private:
  static constexpr double rounding = 1e-9;  // of the structure's size: nearer to the plane is in it

  [[nodiscard]] double beyond(const Vec3& place) const { return (place - cut_.at).dot(cut_.axes.row(0)); }
  [[nodiscard]] bool behind(const Vec3& place) const { return beyond(place) <= tolerance_; }
  template <class Nodes>
  [[nodiscard]] bool passes(const Nodes& nodes) const {
    const auto here = [&](int node) { return behind(s_.rest(node)); };
    return std::any_of(nodes.begin(), nodes.end(), here) && !std::all_of(nodes.begin(), nodes.end(), here);
  }

  [[nodiscard]] std::vector<int> beams_of(std::size_t member) const {
    std::vector<int> beams;
    for (const MemberPiece& piece : s_.frame.pieces[member]) beams.push_back(piece.beam);
    if (beams.empty()) beams.push_back(static_cast<int>(member));
    return beams;
  }
  [[nodiscard]] bool passes_member(std::size_t member) const {
    const std::vector<int> beams = beams_of(member);
    return std::any_of(beams.begin(), beams.end(), [&](int beam) { return passes_beam(beam); });
  }
  /// Between its nodes, rigid arms included.
  [[nodiscard]] bool passes_beam(int index) const {
    const solver::Beam& beam = s_.frame.model.beams[static_cast<std::size_t>(index)];
    int count = 0;
    for (std::size_t end = 0; end < 2; ++end)
      count += behind(s_.rest(beam.node[end])) + behind(s_.rest(beam.node[end]) + beam.offset[end]);
    return count > 0 && count < 4;
  }
  [[nodiscard]] Vec6 through_member(std::size_t member) const {
    Resultant sum(cut_.at);
    for (const int index : beams_of(member)) {
      if (!passes_beam(index)) continue;
      const solver::Beam& beam = s_.frame.model.beams[static_cast<std::size_t>(index)];
      for (std::size_t end = 0; end < 2; ++end)
        if (behind(s_.rest(beam.node[end])))
          sum.add(s_.position(beam.node[end], beam.offset[end]), -s_.end_force(index, end));
      for (const solver::BeamLoad* load : beam_loads_[static_cast<std::size_t>(index)]) add_beam_load(*load, beam, sum);
    }
    return sum.sum();
  }

  /// Takes off what of a load lies behind the plane.
  void add_beam_load(const solver::BeamLoad& load, const solver::Beam& beam, Resultant& sum) const {
    const Vec3 x = beam.axes.row(0), start = s_.rest(beam.node[0]) + beam.offset[0];
    const auto put = [&](double at, const Vec6& local) {
      Vec3 place = start + at * x;
      if (s_.displaced) {
        const Vec3 first = s_.position(beam.node[0], beam.offset[0]), last = s_.position(beam.node[1], beam.offset[1]);
        place = first + at / beam.length * (last - first);
      }
      sum.add(place, -(beam.axes.transpose() * local.head<3>()), -(beam.axes.transpose() * local.tail<3>()));
    };
    if (load.kind == solver::BeamLoad::Kind::temperature) return;
    if (load.kind == solver::BeamLoad::Kind::point) {
      if (behind(start + load.from * x)) put(load.from, load.first);
      return;
    }
    const double slope = x.dot(cut_.axes.row(0)), height = beyond(start);
    double from = load.from, to = load.to;
    const bool first = height + slope * from <= tolerance_, last = height + slope * to <= tolerance_;
    if (!first && !last) return;
    if (first != last) (first ? to : from) = std::clamp(-height / slope, load.from, load.to);
    const auto intensity = [&](double at) -> Vec6 {
      return load.first + (at - load.from) / (load.to - load.from) * (load.last - load.first);
    };
    // Two triangles of a trapezoid, each at its own centroid: exact.
    const double width = to - from;
    put(from + width / 3, intensity(from) * (width / 2));
    put(to - width / 3, intensity(to) * (width / 2));
  }

  [[nodiscard]] bool passes_panel(std::size_t p) const {
    const auto& elements = s_.frame.meshes[p].elements;
    if (elements.empty()) {
      const int shell = s_.frame.shell_of_panel[p];
      return shell >= 0 && passes(s_.frame.model.shells[static_cast<std::size_t>(shell)].node);
    }
    return std::any_of(elements.begin(), elements.end(), [&](const auto& nodes) { return passes(nodes); });
  }
  [[nodiscard]] Vec6 through_panel(std::size_t p) const {
    Resultant sum(cut_.at);
    const PanelMesh& mesh = s_.frame.meshes[p];
    const PanelAction& action = s_.parts.panels[p];
    const Vec3 traction = action.body_force - action.pressure * Vec3(s_.building.panels[p].axes.row(2));
    const auto element = [&](const std::array<int, 4>& nodes, const std::array<Vec6, 4>& forces) {
      for (std::size_t c = 0; c < 4; ++c)
        if (behind(s_.rest(nodes[c]))) sum.add(s_.position(nodes[c]), -forces[c]);
    };
    for (std::size_t k = 0; k < mesh.elements.size(); ++k) {
      if (!passes(mesh.elements[k])) continue;
      element(mesh.elements[k], element_forces(s_.building, s_.frame, PanelId(p), k, s_.parts, s_.solution));
      for (const std::size_t i : {std::size_t{1}, std::size_t{2}}) add_triangle(mesh.elements[k], i, traction, sum);
    }
    if (const int shell = s_.frame.shell_of_panel[p]; mesh.elements.empty() && shell >= 0)
      element(s_.frame.model.shells[static_cast<std::size_t>(shell)].node,
              s_.solution.shell_corner_forces[static_cast<std::size_t>(shell)]);
    return sum.sum();
  }

  /// Takes off the traction on what of a triangle (corners 0, i, i + 1) lies behind the plane.
  void add_triangle(const std::array<int, 4>& nodes, std::size_t i, const Vec3& traction, Resultant& sum) const {
    const std::array<std::size_t, 3> corners{0, i, i + 1};
    std::vector<Vec3> kept;  // where it is now
    for (std::size_t c = 0; c < 3; ++c) {
      const int node = nodes[corners[c]], next = nodes[corners[(c + 1) % 3]];
      const double here = beyond(s_.rest(node)), there = beyond(s_.rest(next));
      if (here <= tolerance_) kept.push_back(s_.position(node));
      if ((here <= tolerance_) == (there <= tolerance_)) continue;
      kept.push_back(s_.position(node) + here / (here - there) * (s_.position(next) - s_.position(node)));
    }
    // Loads are those of the undisplaced element, whose area is counted across its mean normal.
    const Vec3 whole =
        (s_.position(nodes[i]) - s_.position(nodes[0])).cross(s_.position(nodes[i + 1]) - s_.position(nodes[0]));
    const Vec3 normal = (s_.rest(nodes[2]) - s_.rest(nodes[0])).cross(s_.rest(nodes[3]) - s_.rest(nodes[1]));
    const Vec3 rest = (s_.rest(nodes[i]) - s_.rest(nodes[0])).cross(s_.rest(nodes[i + 1]) - s_.rest(nodes[0]));
    const double area = rest.dot(normal.normalized()) / 2;
    for (std::size_t k = 1; k + 1 < kept.size(); ++k) {
      const double share = (kept[k] - kept[0]).cross(kept[k + 1] - kept[0]).dot(whole) / whole.squaredNorm();
      sum.add((kept[0] + kept[k] + kept[k + 1]) / 3, -share * area * traction, Vec3::Zero());
    }
  }

  /// What a rigid floor does to the nodes behind the plane: all that the rest does not balance, in the floor's plane.
  [[nodiscard]] Vec6 through_diaphragm(std::size_t index) const {
    if (!s_.frame.semi_rigid_elements.empty())
      throw InputError(s_.building.file + ": cuts." + cut_.name + ": it passes diaphragm " +
                       s_.building.diaphragms[index].name +
                       " of a model in which joints of shells give; accepted: `parts` without it");
    const auto& nodes = s_.frame.model.diaphragms[index].nodes;
    Resultant sum(cut_.at);
    for (const int node : nodes) {
      if (!behind(s_.rest(node))) continue;
      const Vec6 left = demand_of_elements(node) - at_nodes_.given[static_cast<std::size_t>(node)];
      sum.add(s_.position(node), Vec3(left.x(), left.y(), 0), Vec3(0, 0, left(5)));
    }
    return sum.sum();
  }
  /// What a node does to all that hangs on it, about itself.
  [[nodiscard]] Vec6 demand_of_elements(int node) const {
    Resultant sum(s_.position(node));
    for (const auto& [b, end] : at_nodes_.beams[static_cast<std::size_t>(node)])
      sum.add(s_.position(node, s_.frame.model.beams[static_cast<std::size_t>(b)].offset[end]), s_.end_force(b, end));
    for (const auto& [k, corner] : at_nodes_.shells[static_cast<std::size_t>(node)])
      sum.add(s_.position(node), s_.solution.shell_corner_forces[static_cast<std::size_t>(k)][corner]);
    return sum.sum();
  }

  const State& s_;
  const SectionCut& cut_;
  const std::vector<std::vector<const solver::BeamLoad*>>& beam_loads_;
  const AtNodes& at_nodes_;
  double tolerance_;
};

}  // namespace

std::vector<CutResult> cut_results(const Building& building, const Frame& frame, const std::vector<SectionCut>& cuts,
                                   const PartLoads& parts, const solver::LoadSet& loads,
                                   const solver::StaticSolution& solution, bool displaced) {
  std::vector<CutResult> results;
  if (cuts.empty()) return results;
  const State state{building, frame, parts, loads, solution, displaced};
  std::vector<std::vector<const solver::BeamLoad*>> beam_loads(frame.model.beams.size());
  for (const solver::BeamLoad& load : loads.beams) beam_loads[static_cast<std::size_t>(load.beam)].push_back(&load);
  Vec3 low = frame.model.nodes.front(), high = low;
  for (const Vec3& node : frame.model.nodes) {
    low = low.cwiseMin(node);
    high = high.cwiseMax(node);
  }
  const AtNodes at_nodes(state);
  for (const SectionCut& cut : cuts)
    results.push_back(Cut(state, cut, beam_loads, at_nodes, (high - low).norm()).read());
  return results;
}

}  // namespace topple::structure
