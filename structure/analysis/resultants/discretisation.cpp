#include "analysis/resultants/discretisation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/resultants/shell_results.h"
#include "model/index_of.h"

namespace topple::structure {

namespace {

/// nx, ny, nxy, mx, my, mxy, qx, qy
using Resultants = Eigen::Matrix<double, 8, 1>;
/// A linear field: value at the patch's middle and slopes.
using LinearField = Eigen::Matrix<double, 8, 3>;

Resultants as_vector(const solver::ShellResultants& r) {
  Resultants v;
  v << r.membrane, r.moments, r.shears;
  return v;
}

/// Twice the strain energy per area of resultants.
class Compliance {
 public:
  Compliance(const Material& material, double thickness)
      : nu_(material.poisson_ratio),
        membrane_(1 / (material.youngs_modulus * thickness)),
        bending_(12 / (material.youngs_modulus * std::pow(thickness, 3))),
        shear_(2 * (1 + nu_) / (material.youngs_modulus * thickness * 5 / 6)) {}
  [[nodiscard]] double energy(const Resultants& r) const {
    const auto plane = [&](Eigen::Index at) {
      const double x = r(at), y = r(at + 1), xy = r(at + 2);
      return x * x + y * y - 2 * nu_ * x * y + 2 * (1 + nu_) * xy * xy;
    };
    return membrane_ * plane(0) + bending_ * plane(3) + shear_ * (r(6) * r(6) + r(7) * r(7));
  }

 private:
  double nu_, membrane_, bending_, shear_;
};

/// One panel's elements, in its plane.
class Patches {
 public:
  Patches(const Building& building, const Frame& frame, PanelId id, const PanelResultants& found)
      : mesh_(frame.meshes[index_of(id)]), found_(found) {
    const Panel& panel = building[id];
    const Vec3 origin = building[panel.nodes[0]].position;
    for (std::size_t k = 0; k < mesh_.elements.size(); ++k)
      for (const int node : mesh_.elements[k]) {
        Node& at = nodes_[node];
        at.place = (panel.axes * (frame.model.nodes[static_cast<std::size_t>(node)] - origin)).head<2>();
        at.elements.push_back(k);
      }
    recover();
  }

  [[nodiscard]] bool has_inside() const { return inside_ > 0; }
  /// Recovered resultants at the corners of an element.
  [[nodiscard]] std::array<Resultants, 4> corners(std::size_t element) const {
    std::array<Resultants, 4> values;
    for (std::size_t c = 0; c < 4; ++c) values[c] = nodes_.at(mesh_.elements[element][c]).recovered;
    return values;
  }
  /// Of every node of the mesh.
  [[nodiscard]] std::vector<PanelNode> at_nodes() const {
    std::vector<PanelNode> all;
    for (const auto& [id, node] : nodes_) {
      PanelNode& at = all.emplace_back();
      at.node = id;
      for (std::size_t i = 0; i < 3; ++i) {
        at.membrane[i] = node.recovered(static_cast<Eigen::Index>(i));
        at.moments[i] = node.recovered(static_cast<Eigen::Index>(3 + i));
        if (i < 2) at.shears[i] = node.recovered(static_cast<Eigen::Index>(6 + i));
      }
    }
    return all;
  }
  [[nodiscard]] double area(std::size_t element) const {
    const auto at = [&](std::size_t c) { return nodes_.at(mesh_.elements[element][c]).place; };
    const Vec2 a = at(2) - at(0), b = at(3) - at(1);
    return std::abs(a.x() * b.y() - a.y() * b.x()) / 2;
  }

 private:
  struct Node {
    Vec2 place = Vec2::Zero();
    std::vector<std::size_t> elements;
    bool inside = false;
    LinearField field = LinearField::Zero();
    Resultants recovered = Resultants::Zero();
  };

  [[nodiscard]] Vec2 centre(std::size_t element) const {
    Vec2 sum = Vec2::Zero();
    for (const int node : mesh_.elements[element]) sum += nodes_.at(node).place / 4;
    return sum;
  }

  /// Patches round the nodes inside (four elements each) have linear fields; nodes on the border take the mean of those
  /// of the patches that their elements belong to.
  void recover() {
    for (auto& [id, node] : nodes_) {
      node.inside = node.elements.size() >= 4;
      if (!node.inside) continue;
      ++inside_;
      fit(node);
      node.recovered = node.field.col(0);
    }
    for (auto& [id, node] : nodes_)
      if (!node.inside) recover_from_patches(node);
  }

  void fit(Node& node) const {
    const auto n = static_cast<Eigen::Index>(node.elements.size());
    Eigen::MatrixXd places(n, 3), values(n, 8);
    double size = 0;
    for (const std::size_t k : node.elements) size = std::max(size, (centre(k) - node.place).norm());
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::size_t k = node.elements[static_cast<std::size_t>(i)];
      const Vec2 away = (centre(k) - node.place) / size;
      places.row(i) << 1, away.x(), away.y();
      values.row(i) = as_vector(found_.centre[k]).transpose();
    }
    const Eigen::MatrixXd fitted = places.colPivHouseholderQr().solve(values);
    node.field = fitted.transpose();
    node.field.rightCols<2>() /= size;
  }

  void recover_from_patches(Node& node) {
    double count = 0;
    for (const std::size_t k : node.elements)
      for (const int other : mesh_.elements[k]) {
        const Node& patch = nodes_.at(other);
        if (!patch.inside) continue;
        const Vec2 away = node.place - patch.place;
        node.recovered += patch.field * Vec3(1, away.x(), away.y());
        count += 1;
      }
    if (count > 0) {
      node.recovered /= count;
      return;
    }
    for (const std::size_t k : node.elements)
      node.recovered += as_vector(found_.centre[k]) / static_cast<double>(node.elements.size());
  }

  const PanelMesh& mesh_;
  const PanelResultants& found_;
  std::map<int, Node> nodes_;
  std::size_t inside_ = 0;
};

struct Energies {
  double error = 0, whole = 0;
};

Energies energies_of(const Building& building, const Frame& frame, PanelId id, const PanelResultants& found,
                     const Patches& patches) {
  const Panel& panel = building[id];
  const Compliance compliance(building[panel.material], panel.thickness);
  constexpr double gauss = 0.57735026918962576;
  Energies sum;
  for (std::size_t k = 0; k < frame.meshes[index_of(id)].elements.size(); ++k) {
    const std::array<Resultants, 4> corners = patches.corners(k);
    const double weight = patches.area(k) / 4;
    for (std::size_t g = 0; g < 4; ++g) {
      const double x = (g == 1 || g == 2 ? 1 : -1) * gauss, y = (g >= 2 ? 1 : -1) * gauss;
      const Resultants smooth = ((1 - x) * (1 - y) * corners[0] + (1 + x) * (1 - y) * corners[1] +
                                 (1 + x) * (1 + y) * corners[2] + (1 - x) * (1 + y) * corners[3]) /
                                4;
      const Resultants own = as_vector(found.gauss[k][g]);
      sum.error += weight * compliance.energy(smooth - own);
      sum.whole += weight * compliance.energy(own);
    }
  }
  return sum;
}

/// Whether something acts across the panel's plane.
bool loaded_across(const Building& building, PanelId id, const PanelAction& action) {
  const Vec3 normal = building[id].axes.row(2);
  constexpr double rounding = 1e-9;
  return action.pressure != 0 || std::abs(action.body_force.dot(normal)) > rounding * action.body_force.norm();
}

}  // namespace

double recover_resultants(const Building& building, const Frame& frame, const PartLoads& loads,
                          const solver::StaticSolution& solution, std::vector<PanelResult>& panels) {
  Energies all;
  std::vector<std::pair<std::size_t, double>> errors;
  bool unknown = false;
  for (std::size_t p = 0; p < panels.size(); ++p) {
    if (frame.meshes[p].elements.empty()) continue;
    const PanelId id(p);
    const PanelResultants found = panel_resultants(building, frame, id, loads, solution);
    const Patches patches(building, frame, id, found);
    panels[p].nodes = patches.at_nodes();
    if (!patches.has_inside() && loaded_across(building, id, loads.panels[p])) {
      panels[p].discretisation_error = 1;
      unknown = true;
      continue;
    }
    const Energies energies = energies_of(building, frame, id, found, patches);
    all.error += energies.error;
    all.whole += energies.whole;
    errors.emplace_back(p, energies.error);
  }
  const double whole = all.whole + all.error;
  if (whole > 0)
    for (const auto& [p, error] : errors) panels[p].discretisation_error = std::sqrt(error / whole);
  if (unknown) return 1;
  return whole > 0 ? std::sqrt(all.error / whole) : 0;
}

}  // namespace topple::structure
