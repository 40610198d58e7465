#include "extended_frame.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace reference {

namespace {

using topple::solver::Beam;
using topple::solver::BeamLoad;
using topple::solver::FrameModel;
using Matrix12 = std::array<std::array<Real, 12>, 12>;
using Vector12 = std::array<Real, 12>;

void require(bool known, const char* what) {
  if (!known) throw std::runtime_error(std::string("reference solution: ") + what + " are not in it");
}

/// Bending in one plane: v along one axis, r the rotation with v' = sign r. Przemieniecki 1968, table 5.1, with
/// phi = 12 E I/(G As L2).
void add_bending(Matrix12& k, int v, int r, Real sign, Real EI, Real GAs, Real L) {
  const Real phi = GAs > 0 ? 12 * EI / (GAs * L * L) : 0;
  const Real c = EI / (L * L * L * (1 + phi));
  const std::array<int, 4> at{v, r, v + 6, r + 6};
  const Real s = sign * L;
  const Real entries[4][4] = {{12, 6 * s, -12, 6 * s},
                              {6 * s, (4 + phi) * L * L, -6 * s, (2 - phi) * L * L},
                              {-12, -6 * s, 12, -6 * s},
                              {6 * s, (2 - phi) * L * L, -6 * s, (4 + phi) * L * L}};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) k[at[i]][at[j]] += c * entries[i][j];
  }
}

Matrix12 local_stiffness(const Beam& beam) {
  Matrix12 k{};
  const Real L = beam.length, E = beam.youngs_modulus, G = beam.shear_modulus;
  const auto add_rod = [&](int c, Real stiffness) {
    k[c][c] += stiffness;
    k[c + 6][c + 6] += stiffness;
    k[c][c + 6] -= stiffness;
    k[c + 6][c] -= stiffness;
  };
  add_rod(0, E * beam.area / L);
  add_rod(3, G * beam.J / L);
  add_bending(k, 1, 5, 1, E * beam.Iz, G * beam.shear_area_y, L);
  add_bending(k, 2, 4, -1, E * beam.Iy, G * beam.shear_area_z, L);
  return k;
}

/// Nodal forces with the work of a transverse intensity q(x): integrals of Hermite's functions (exact for a beam
/// without shear deformation, and for one with it when the load is symmetric) by Gauss's rule with four points, exact
/// to degree 7.
void add_transverse(Vector12& f, int v, int r, Real sign, Real L, Real a, Real b, Real qa, Real qb) {
  static constexpr Real node[4] = {-0.861136311594052575223946488893L, -0.339981043584856264802665759103L,
                                   0.339981043584856264802665759103L, 0.861136311594052575223946488893L};
  static constexpr Real weight[4] = {0.347854845137453857373063949222L, 0.652145154862546142626936050778L,
                                     0.652145154862546142626936050778L, 0.347854845137453857373063949222L};
  for (int i = 0; i < 4; ++i) {
    const Real x = (a + b) / 2 + (b - a) / 2 * node[i], t = x / L;
    const Real q = (qa + (qb - qa) * (x - a) / (b - a)) * weight[i] * (b - a) / 2;
    f[v] += q * (1 - 3 * t * t + 2 * t * t * t);
    f[r] += sign * q * L * (t - 2 * t * t + t * t * t);
    f[v + 6] += q * (3 * t * t - 2 * t * t * t);
    f[r + 6] += sign * q * L * (-t * t + t * t * t);
  }
}

void add_along(Vector12& f, int c, Real L, Real a, Real b, Real qa, Real qb) {
  const Real total = (qa + qb) / 2 * (b - a);
  const Real moment = (b - a) * (a * (qa + qb) / 2 + (b - a) * (qa / 6 + qb / 3));  // integral of q x
  f[c] += total - moment / L;
  f[c + 6] += moment / L;
}

Vector12 load_vector(const Beam& beam, const std::vector<BeamLoad>& loads, int index) {
  Vector12 f{};
  for (const BeamLoad& load : loads) {
    if (load.beam != index) continue;
    require(load.kind == BeamLoad::Kind::distributed, "loads that are not distributed");
    require(beam.shear_area_y == 0 && beam.shear_area_z == 0, "loaded beams with shear deformation");
    require(load.first.tail<3>().isZero() && load.last.tail<3>().isZero(), "distributed moments");
    const Real L = beam.length, a = load.from, b = load.to;
    add_along(f, 0, L, a, b, load.first[0], load.last[0]);
    add_transverse(f, 1, 5, 1, L, a, b, load.first[1], load.last[1]);
    add_transverse(f, 2, 4, -1, L, a, b, load.first[2], load.last[2]);
  }
  return f;
}

/// Local components of 12 global ones (`forward`), or back.
Vector12 turn(const Beam& beam, const Vector12& from, bool forward) {
  Vector12 to{};
  for (int block = 0; block < 12; block += 3) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) to[block + i] += Real(forward ? beam.axes(i, j) : beam.axes(j, i)) * from[block + j];
    }
  }
  return to;
}

/// Cholesky's factorisation of the rows of a symmetric band matrix in place, then both triangular solves.
void solve_band(std::vector<std::vector<Real>>& rows, std::vector<Real>& x) {
  const std::size_t n = rows.size();
  const auto width = [&](std::size_t i) { return rows[i].size(); };  // row i holds columns i - width + 1 to i
  const auto first = [&](std::size_t i) { return i + 1 - width(i); };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = first(i); j <= i; ++j) {
      Real sum = rows[i][j - first(i)];
      for (std::size_t k = std::max(first(i), first(j)); k < j; ++k)
        sum -= rows[i][k - first(i)] * rows[j][k - first(j)];
      if (j < i) {
        rows[i][j - first(i)] = sum / rows[j].back();
      } else {
        if (!(sum > 0)) throw std::runtime_error("reference solution: the model is not stable");
        rows[i].back() = std::sqrt(sum);
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = first(i); k < i; ++k) x[i] -= rows[i][k - first(i)] * x[k];
    x[i] /= rows[i].back();
  }
  for (std::size_t i = n; i-- > 0;) {
    x[i] /= rows[i].back();
    for (std::size_t k = first(i); k < i; ++k) x[k] -= rows[i][k - first(i)] * x[i];
  }
}

/// Numbers of the free freedoms, nodes taken by height: a building's band is then one storey.
std::vector<std::array<int, 6>> number_freedoms(const FrameModel& model, int& count) {
  std::vector<std::array<bool, 6>> held(model.nodes.size());
  for (const auto& support : model.supports) {
    for (int c = 0; c < 6; ++c) {
      require(support.stiffness[c] == 0 || std::isinf(support.stiffness[c]), "springs");
      held[support.node][c] = support.stiffness[c] != 0;
    }
  }
  std::vector<std::size_t> order(model.nodes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return model.nodes[a].z() < model.nodes[b].z(); });
  std::vector<std::array<int, 6>> number(model.nodes.size());
  count = 0;
  for (const std::size_t node : order) {
    for (int c = 0; c < 6; ++c) number[node][c] = held[node][c] ? -1 : count++;
  }
  return number;
}

}  // namespace

Answer solve(const FrameModel& model, const topple::solver::LoadSet& loads) {
  require(model.shells.empty(), "shells");
  require(model.diaphragms.empty(), "diaphragms");
  require(loads.settlements.empty(), "settlements");
  int count = 0;
  const auto number = number_freedoms(model, count);
  const auto freedom = [&](const Beam& beam, int i) { return number[beam.node[i / 6]][i % 6]; };

  std::vector<std::size_t> first(count);
  for (int i = 0; i < count; ++i) first[i] = i;
  for (const Beam& beam : model.beams) {
    for (int end = 0; end < 2; ++end) {
      require(beam.offset[end].isZero(), "offsets");
      for (int c = 0; c < 6; ++c) require(std::isinf(beam.end_stiffness[end][c]), "releases");
    }
    for (int i = 0; i < 12; ++i) {
      for (int j = 0; j < 12; ++j) {
        const int a = freedom(beam, i), b = freedom(beam, j);
        if (a >= 0 && b >= 0) first[a] = std::min<std::size_t>(first[a], b);
      }
    }
  }
  std::vector<std::vector<Real>> rows(count);
  for (int i = 0; i < count; ++i) rows[i].assign(i + 1 - first[i], 0);
  std::vector<Real> x(count, 0);
  for (const auto& load : loads.nodes) {
    for (int c = 0; c < 6; ++c) {
      if (number[load.node][c] >= 0) x[number[load.node][c]] += load.load[c];
    }
  }
  for (std::size_t b = 0; b < model.beams.size(); ++b) {
    const Beam& beam = model.beams[b];
    const Matrix12 k = local_stiffness(beam);
    const Vector12 f = turn(beam, load_vector(beam, loads.beams, static_cast<int>(b)), false);
    for (int j = 0; j < 12; ++j) {
      const int column = freedom(beam, j);
      if (column < 0) continue;
      x[column] += f[j];
      Vector12 unit{};
      unit[j] = 1;
      const Vector12 local = turn(beam, unit, true);
      Vector12 force{};
      for (int p = 0; p < 12; ++p) {
        for (int q = 0; q < 12; ++q) force[p] += k[p][q] * local[q];
      }
      force = turn(beam, force, false);
      for (int i = 0; i < 12; ++i) {
        const int row = freedom(beam, i);
        if (row >= column) rows[row][column - first[row]] += force[i];
      }
    }
  }
  solve_band(rows, x);

  Answer answer;
  answer.displacements.resize(model.nodes.size());
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    for (int c = 0; c < 6; ++c) answer.displacements[n][c] = number[n][c] < 0 ? 0 : x[number[n][c]];
  }
  std::vector<std::array<Real, 6>> node_sum(model.nodes.size());
  for (std::size_t b = 0; b < model.beams.size(); ++b) {
    const Beam& beam = model.beams[b];
    Vector12 global{};
    for (int i = 0; i < 12; ++i) global[i] = answer.displacements[beam.node[i / 6]][i % 6];
    const Vector12 local = turn(beam, global, true);
    const Matrix12 k = local_stiffness(beam);
    Vector12 force = load_vector(beam, loads.beams, static_cast<int>(b));
    for (Real& component : force) component = -component;
    for (int p = 0; p < 12; ++p) {
      for (int q = 0; q < 12; ++q) force[p] += k[p][q] * local[q];
    }
    answer.beam_end_forces.push_back(force);
    const Vector12 at_nodes = turn(beam, force, false);
    for (int i = 0; i < 12; ++i) node_sum[beam.node[i / 6]][i % 6] += at_nodes[i];
  }
  for (const auto& load : loads.nodes) {
    for (int c = 0; c < 6; ++c) node_sum[load.node][c] -= load.load[c];
  }
  for (const auto& support : model.supports) answer.reactions.push_back(node_sum[support.node]);
  return answer;
}

}  // namespace reference
