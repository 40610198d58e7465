#include "mesh/semi_rigid_edges.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "failure/panel_demand.h"
#include "mesh/semi_rigid_elements.h"
#include "model/index_of.h"
#include "topple/solver/superelement.h"

namespace topple::structure {

namespace {

/// Directions (squared sines between them) nearer than this are one.
constexpr double same_direction = 1e-9;

/// Translations or rotations of one side of a joint against the other.
struct Give {
  Mat3 held = Mat3::Zero();    ///< sum of n n' over the directions that it holds
  Mat3 spring = Mat3::Zero();  ///< its springs
};
struct Pair {
  std::array<Give, 2> of;  ///< translations, rotations
};

/// What a rigid end is held by that is not a joint which gives.
class Grounds {
 public:
  Grounds(const Building& building, const Frame& frame, const std::vector<char>& gives) {
    of_.assign(frame.model.nodes.size(), {Mat3::Zero(), Mat3::Zero()});
    for (const solver::Beam& beam : frame.model.beams)
      for (const int node : beam.node) hold(node);
    std::vector<char> of_semi_rigid_panel(frame.model.shells.size(), 0);
    for (std::size_t p = 0; p < building.panels.size(); ++p)
      for (std::size_t k = 0; k < frame.meshes[p].elements.size() && gives[p] != 0; ++k)
        of_semi_rigid_panel[static_cast<std::size_t>(frame.meshes[p].first_shell) + k] = 1;
    for (std::size_t s = 0; s < frame.model.shells.size(); ++s)
      for (const int node : frame.model.shells[s].node)
        if (of_semi_rigid_panel[s] == 0) hold(node);
    for (const solver::Support& support : frame.model.supports)
      for (int i = 0; i < 6; ++i)
        if (support.stiffness(i) > 0)
          of_[static_cast<std::size_t>(support.node)][static_cast<std::size_t>(i / 3)](i % 3, i % 3) += 1;
  }
  [[nodiscard]] bool any(int node) const {
    const auto& [translations, rotations] = of_[static_cast<std::size_t>(node)];
    return !translations.isZero(0) || !rotations.isZero(0);
  }
  void add(int node, const Pair& joint) {
    for (std::size_t part = 0; part < 2; ++part)
      of_[static_cast<std::size_t>(node)][part] += joint.of[part].held + unit(joint.of[part].spring);
  }
  /// Directions in which nothing holds the rigid end: sum of n n'.
  [[nodiscard]] Mat3 loose(int node, std::size_t part) const {
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(of_[static_cast<std::size_t>(node)][part]);
    Mat3 sum = Mat3::Zero();
    for (int i = 0; i < 3; ++i)
      if (eigen.eigenvalues()(i) < same_direction)
        sum += eigen.eigenvectors().col(i) * eigen.eigenvectors().col(i).transpose();
    return sum;
  }

 private:
  void hold(int node) {
    for (Mat3& part : of_[static_cast<std::size_t>(node)]) part += Mat3::Identity();
  }
  static Mat3 unit(const Mat3& spring) {
    const double size = spring.norm();
    return size > 0 ? Mat3(spring / size) : Mat3::Zero();
  }
  std::vector<std::array<Mat3, 2>> of_;
};

class SemiRigidEdges {
 public:
  SemiRigidEdges(const Building& building, Frame& frame) : building_(building), frame_(frame), members_(building) {}

  void add() {
    std::vector<char> gives(building_.panels.size(), 0);
    bool any = false;
    for (std::size_t p = 0; p < building_.panels.size(); ++p) {
      const Joint& joint = building_[building_.joint(PanelId(p), 0)];
      gives[p] = !frame_.meshes[p].elements.empty() && (joint.stiffness.array() != unlimited).any() ? 1 : 0;
      any = any || gives[p] != 0;
    }
    if (!any) return;
    find_neighbours();
    Grounds grounds(building_, frame_, gives);
    std::vector<std::map<int, Pair>> joints(building_.panels.size());
    for (std::size_t p = 0; p < joints.size(); ++p)
      if (gives[p] != 0) joints[p] = joints_of(PanelId(p), grounds);
    for (const auto& panel : joints)
      for (const auto& [node, joint] : panel) grounds.add(node, joint);
    // A rigid end between panels that all let go of it would spin by itself: it goes with the first of them.
    std::map<int, std::size_t> first;
    for (std::size_t p = 0; p < joints.size(); ++p)
      for (auto& [node, joint] : joints[p])
        if (first.try_emplace(node, p).first->second == p)
          for (std::size_t part = 0; part < 2; ++part) joint.of[part].held += grounds.loose(node, part);
    for (std::size_t p = 0; p < joints.size(); ++p)
      if (gives[p] != 0) separate(PanelId(p), joints[p]);
  }

 private:
  [[nodiscard]] Vec3 position(int node) const { return frame_.model.nodes[static_cast<std::size_t>(node)]; }

  /// Sides of elements, as pairs of nodes, that more than one panel has.
  void find_neighbours() {
    std::map<std::pair<int, int>, int> seen;
    for (std::size_t p = 0; p < building_.panels.size(); ++p)
      for (const auto& edge : frame_.meshes[p].edge_nodes)
        for (std::size_t i = 0; i + 1 < edge.size(); ++i) ++seen[std::minmax(edge[i], edge[i + 1])];
    for (const auto& [side, count] : seen)
      if (count > 1) shared_.push_back(side);
  }
  [[nodiscard]] bool shared(int a, int b) const {
    return std::binary_search(shared_.begin(), shared_.end(), std::pair<int, int>(std::minmax(a, b)));
  }

  /// A member, another shell or a support lies along the edge.
  [[nodiscard]] bool bears(PanelId panel, std::size_t edge) const {
    if (!members_.of(panel, static_cast<int>(edge)).empty()) return true;
    for (const EdgeSupport& support : building_.edge_supports)
      if (support.panel == panel && static_cast<std::size_t>(support.edge) == edge) return true;
    const auto& nodes = frame_.meshes[index_of(panel)].edge_nodes[edge];
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
      if (shared(nodes[i], nodes[i + 1])) return true;
    return false;
  }

  /// Of each node at which the panel hangs. A corner belongs to those of its edges that something lies along, to both
  /// where that is so for neither; both hold it, side by side.
  [[nodiscard]] std::map<int, Pair> joints_of(PanelId id, const Grounds& grounds) const {
    const Panel& panel = building_[id];
    const PanelMesh& mesh = frame_.meshes[index_of(id)];
    std::array<bool, 4> bearing{};
    for (std::size_t edge = 0; edge < 4; ++edge) bearing[edge] = bears(id, edge);
    std::map<int, Pair> joints;
    for (std::size_t edge = 0; edge < 4; ++edge) {
      const auto& nodes = mesh.edge_nodes[edge];
      const Mat3 axes = edge_axes(building_, panel, edge).transpose();
      const std::vector<double> shares = shares_of(mesh, nodes);
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const int node = nodes[i];
        const bool first = node == panel.nodes[edge].index, last = node == panel.nodes[(edge + 1) % 4].index;
        const std::size_t other = first ? (edge + 3) % 4 : (edge + 1) % 4;
        if ((first || last) && !bearing[edge] && bearing[other]) continue;
        if (!(first || last) && !grounds.any(node) && !bearing[edge]) continue;
        hold(building_[building_.joint(id, static_cast<int>(edge))].stiffness, axes, shares[i], joints[node]);
      }
    }
    return joints;
  }

  /// The share of the intact edge that hangs on each of its nodes: half of the elements' sides on either hand.
  [[nodiscard]] std::vector<double> shares_of(const PanelMesh& mesh, const std::vector<int>& nodes) const {
    std::vector<double> shares(nodes.size(), 0);
    double whole = 0;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      const auto has = [&](const std::array<int, 4>& element, int node) {
        return std::find(element.begin(), element.end(), node) != element.end();
      };
      if (std::none_of(mesh.elements.begin(), mesh.elements.end(),
                       [&](const auto& element) { return has(element, nodes[i]) && has(element, nodes[i + 1]); }))
        continue;
      const double length = (position(nodes[i + 1]) - position(nodes[i])).norm();
      shares[i] += length / 2;
      shares[i + 1] += length / 2;
      whole += length;
    }
    for (double& share : shares) share /= whole > 0 ? whole : 1;
    return shares;
  }

  static void hold(const Vec6& stiffness, const Mat3& axes, double share, Pair& joint) {
    for (int i = 0; i < 6; ++i) {
      const Mat3 direction = axes.col(i % 3) * axes.col(i % 3).transpose();
      Give& give = joint.of[static_cast<std::size_t>(i / 3)];
      if (stiffness(i) == unlimited)
        give.held += direction;
      else
        give.spring += share * stiffness(i) * direction;
    }
  }

  /// Gives the panel a side of its own where its joints give.
  void separate(PanelId id, const std::map<int, Pair>& joints) {
    PanelMesh& mesh = frame_.meshes[index_of(id)];
    std::map<int, int> semi_rigid;  // by rigid end
    for (const auto& [rigid_end, joint] : joints)
      if (const int index = add_node(rigid_end, joint); index >= 0) semi_rigid.emplace(rigid_end, index);
    const auto own = [&](int node) {
      const auto found = semi_rigid.find(node);
      return found == semi_rigid.end() ? node : frame_.semi_rigid_nodes[static_cast<std::size_t>(found->second)].node;
    };
    for (std::size_t k = 0; k < mesh.elements.size(); ++k) {
      SemiRigidElement element;
      element.shell = mesh.first_shell + static_cast<int>(k);
      for (std::size_t c = 0; c < 4; ++c)
        if (const auto found = semi_rigid.find(mesh.elements[k][c]); found != semi_rigid.end())
          element.semi_rigid_node[c] = found->second;
      if (element.semi_rigid_node != std::array{-1, -1, -1, -1}) add_element(element);
      for (int& node : mesh.elements[k]) node = own(node);
    }
    for (auto& edge : mesh.edge_nodes)
      for (int& node : edge) node = own(node);
  }

  /// Directions that are held, then those that give; how many are held.
  static std::pair<Mat3, int> basis(const Give& give) {
    if ((give.held.array() == 0).all()) return {Mat3::Identity(), 0};
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(give.held);
    const Mat3 directions = eigen.eigenvectors().rowwise().reverse();
    const auto held = (eigen.eigenvalues().array() > same_direction).count();
    return {directions, static_cast<int>(held)};
  }

  /// Index in semi_rigid_nodes, or -1 where the joints at this node give in nothing.
  int add_node(int rigid_end, const Pair& joint) {
    const auto [translations, held_translations] = basis(joint.of[0]);
    const auto [rotations, held_rotations] = basis(joint.of[1]);
    if (held_translations == 3 && held_rotations == 3) return -1;
    SemiRigidNode semi_rigid;
    semi_rigid.node = static_cast<int>(frame_.model.nodes.size());
    semi_rigid.rigid_end = rigid_end;
    semi_rigid.translations = translations;
    semi_rigid.rotations = rotations;
    frame_.model.nodes.push_back(position(rigid_end));
    solver::Support support{semi_rigid.node, Vec6::Zero()};
    support.stiffness.head(held_translations).setConstant(unlimited);
    support.stiffness.segment(3, held_rotations).setConstant(unlimited);
    frame_.model.supports.push_back(support);
    add_springs(semi_rigid, joint, held_translations, held_rotations);
    frame_.semi_rigid_nodes.push_back(semi_rigid);
    return static_cast<int>(frame_.semi_rigid_nodes.size()) - 1;
  }

  void add_springs(const SemiRigidNode& semi_rigid, const Pair& joint, int held_translations, int held_rotations) {
    solver::Patch patch{{semi_rigid.node}, Eigen::MatrixXd::Zero(6, 6)};
    patch.stiffness.topLeftCorner<3, 3>() =
        semi_rigid.translations.transpose() * joint.of[0].spring * semi_rigid.translations;
    patch.stiffness.bottomRightCorner<3, 3>() =
        semi_rigid.rotations.transpose() * joint.of[1].spring * semi_rigid.rotations;
    for (int i = 0; i < 6; ++i)
      if (i % 3 < (i < 3 ? held_translations : held_rotations)) {
        patch.stiffness.row(i).setZero();
        patch.stiffness.col(i).setZero();
      }
    if (!patch.stiffness.isZero(0)) frame_.model.patches.push_back(std::move(patch));
  }

  void add_element(SemiRigidElement element) {
    const solver::Shell& shell = frame_.model.shells[static_cast<std::size_t>(element.shell)];
    solver::Superelement::Patch alone;
    for (const int node : shell.node) alone.nodes.push_back(position(node));
    alone.shells = {shell};
    alone.shells.front().node = {0, 1, 2, 3};
    alone.kept = {0, 1, 2, 3};
    element.stiffness = solver::Superelement(std::move(alone)).stiffness();
    const auto [nodes, from] = corners_by_freedoms(frame_, element);
    solver::Patch patch;
    patch.node = nodes;
    patch.stiffness = from.transpose() * element.stiffness * from;
    patch.stiffness = ((patch.stiffness + patch.stiffness.transpose()) / 2).eval();
    frame_.model.patches.push_back(std::move(patch));
    frame_.model.shell_stiffness[element.shell].setZero();
    frame_.semi_rigid_elements.push_back(element);
  }

  const Building& building_;
  Frame& frame_;
  EdgeMembers members_;
  std::vector<std::pair<int, int>> shared_;
};

}  // namespace

void add_semi_rigid_edges(const Building& building, Frame& frame) { SemiRigidEdges(building, frame).add(); }

}  // namespace topple::structure
