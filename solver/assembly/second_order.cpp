#include "topple/solver/second_order.h"

#include <chrono>
#include <cmath>

#include "assembly/frame_loads.h"
#include "assembly/frame_recovery.h"
#include "assembly/frame_system.h"
#include "assembly/mechanism.h"
#include "assembly/refinement.h"
#include "elements/second_order_beam.h"
#include "factor/factor.h"

namespace topple::solver {
namespace {

constexpr int most_iterations = 100;
/// Relative change of axial forces that counts as none; and the one below which rounding may keep them from settling
/// further, so that it is enough when they do not come closer (stiff members that a large sway carries along).
constexpr double settled = 1e-12, settled_to_rounding = 1e-8;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::vector<double> shell_strains(const FrameModel& model, const LoadSet& loads) {
  std::vector<double> strain(model.shells.size(), 0);
  for (const ShellLoad& load : loads.shells) strain[static_cast<std::size_t>(load.shell)] += load.strain;
  return strain;
}

struct SecondOrderAnalysis::State {
 public:
  State(const FrameModel& model, SecondOrder mode, const AnalysisOptions& options, std::vector<JointedShell> jointed)
      : system_(model), options_(options) {
    axial_.mode = mode;
    axial_.jointed = std::move(jointed);
    system_.assemble();
    require_none(system_.defect());
    const auto start = std::chrono::steady_clock::now();
    if (system_.dofs().equations > 0)
      factor_ = std::make_unique<Factor>(system_.matrix(), system_.elimination_order(), options.factorisation,
                                         options.threads);
    statistics.order_seconds += seconds_since(start);
    statistics.freedoms = static_cast<std::size_t>(system_.dofs().equations);
    system_.second_order = &axial_;
  }

  SecondOrderSolution run(const LoadSet& loads, const StaticSolution& first_order) {
    const std::size_t beams = system_.model.beams.size();
    axial_.first_axial.assign(beams, 0);
    axial_.loads.assign(beams, {});
    for (const BeamLoad& load : loads.beams) axial_.loads[static_cast<std::size_t>(load.beam)].push_back(load);
    axial_.shell_displacements.clear();
    of_this_tangent_ = usable_ = false;
    if (!system_.model.shells.empty()) axial_.shell_strain = shell_strains(system_.model, loads);
    SecondOrderSolution result;
    result.solution = first_order;  // the axial forces to begin with
    double before = 1;
    for (result.iterations = 1; result.iterations <= most_iterations; ++result.iterations) {
      const double change = update_axial_forces(result.solution);
      const bool no_closer = change <= settled_to_rounding && change >= before;
      before = change;
      if (result.iterations > 1 && (change <= settled || no_closer)) {
        result.axial = axial_;
        judge(result.solution.quality);
        return result;
      }
      require_straight_members();
      system_.assemble(options_.threads);
      result.solution = solve(loads);
    }
    throw std::runtime_error("the axial forces of the second-order analysis do not settle in " +
                             std::to_string(most_iterations) + " iterations");
  }

  AnalysisStatistics statistics;

 private:
  /// Returns the largest change over the largest force.
  double update_axial_forces(const StaticSolution& solution) {
    double change = 0, largest = 0;
    for (std::size_t i = 0; i < axial_.first_axial.size(); ++i) {
      const double tension = -solution.beam_end_forces[i](0);
      change = std::max(change, std::abs(tension - axial_.first_axial[i]));
      largest = std::max(largest, std::abs(tension));
      axial_.first_axial[i] = tension;
    }
    const double relative = largest > 0 ? change / largest : 0;
    return system_.model.shells.empty() ? relative : std::max(relative, update_displacements(solution));
  }

  /// Membrane forces follow from displacements: returns their largest change over the largest translation.
  double update_displacements(const StaticSolution& solution) {
    double change = 0, largest = 0;
    std::vector<Vec6>& known = axial_.shell_displacements;
    known.resize(solution.displacements.size(), Vec6::Zero());
    for (std::size_t n = 0; n < known.size(); ++n) {
      change = std::max(change, (solution.displacements[n] - known[n]).head<3>().norm());
      largest = std::max(largest, solution.displacements[n].head<3>().norm());
      known[n] = solution.displacements[n];
    }
    return largest > 0 ? change / largest : 0;
  }

  void require_straight_members() const {
    for (std::size_t i = 0; i < system_.model.beams.size(); ++i) {
      if (far_from_buckling_inside(system_.model.beams[i], axial_.first_axial[i], axial_.loads[i])) continue;
      const SecondOrderBeam beam(system_.model.beams[i], 1, axial_.mode, axial_.first_axial[i], axial_.loads[i]);
      if (beam.buckled_modes() == 0) continue;
      Mechanism mechanism;
      mechanism.beams.push_back(static_cast<int>(i));
      mechanism.motion.assign(system_.model.nodes.size(), Vec6::Zero());
      throw Buckled("beam " + std::to_string(i) + " buckles between its ends", mechanism);
    }
  }

  void factorise() {
    const auto start = std::chrono::steady_clock::now();
    const Stability stability = factorise_and_judge(system_, *factor_, options_);
    if (stability.defect) throw Buckled(stability.defect->message, stability.defect->motion);
    of_this_tangent_ = usable_ = true;
    factor_scale_.assign(system_.scale().begin(), system_.scale().end());
    statistics.factorisation = factor_->name();
    statistics.ordering = "node graph METIS";
    statistics.factor_entries = factor_->entries();
    statistics.factor_operations = factor_->operations();
    statistics.factor_seconds += seconds_since(start);
  }

  /// Scaled. From one iteration to the next the tangent hardly changes: the factor of an earlier one, and the last
  /// answer, lead to the same backward error in a few solves, or else the tangent is factorised.
  RefinedSolution solve_scaled(const Eigen::MatrixXd& b) {
    const Eigen::Map<const Eigen::VectorXd> scale(system_.scale().data(), b.rows());
    of_this_tangent_ = false;
    if (usable_) {
      // Scales are powers of two: the factor serves in another one as well.
      const Eigen::VectorXd ratio =
          Eigen::Map<const Eigen::VectorXd>(factor_scale_.data(), b.rows()).cwiseQuotient(scale);
      const LinearSolve earlier = [&](Eigen::Ref<Eigen::MatrixXd> x) {
        x.array().colwise() *= ratio.array();
        factor_->solve(x);
        x.array().colwise() *= ratio.array();
      };
      RefinedSolution refined = refine(ExtendedResidual(system_.matrix()), earlier, b, last_.cwiseQuotient(scale));
      if (refined.quality.front().converged) return refined;
    }
    factorise();
    const LinearSolve linear = [this](Eigen::Ref<Eigen::MatrixXd> x) { factor_->solve(x); };
    return solve_refined(system_.matrix(), linear, b);
  }

  StaticSolution solve(const LoadSet& loads) {
    const auto start = std::chrono::steady_clock::now();
    const double factorising = statistics.factor_seconds;
    const LoadVector load = load_vector(system_, loads);
    require_none(system_.unbalanced_load(load));
    const Eigen::Index n = system_.dofs().equations;
    Eigen::MatrixXd b(n, 1);
    for (Eigen::Index i = 0; i < n; ++i) b(i, 0) = load.force(i) * system_.scale()[static_cast<std::size_t>(i)];
    SolveQuality quality;
    if (n > 0) {
      const RefinedSolution refined = solve_scaled(b);
      quality = refined.quality.front();
      for (Eigen::Index i = 0; i < n; ++i) b(i, 0) = refined.x(i, 0) * system_.scale()[static_cast<std::size_t>(i)];
      last_ = b.col(0);
    }
    StaticSolution solution = recover(load, b.col(0));
    solution.quality = quality;
    statistics.solve_seconds += seconds_since(start) - (statistics.factor_seconds - factorising);
    return solution;
  }

  /// Of the last tangent, which is that of the answer: an estimate takes some solves.
  void judge(SolveQuality& quality) {
    if (factor_ && !of_this_tangent_) factorise();
    if (factor_)
      quality.condition =
          estimate_condition(system_.matrix(), [this](Eigen::Ref<Eigen::MatrixXd> x) { factor_->solve(x); });
    quality.condition = std::max(quality.condition, 1.0);
    quality.error_bound = forward_error_bound(quality.condition, quality.backward_error);
    statistics.digits_left = std::clamp(16 - std::log10(quality.condition), 0.0, 16.0);
  }

  [[nodiscard]] StaticSolution recover(const LoadVector& load, const Eigen::VectorXd& u) const {
    LoadVector used_up = load;
    StaticSolution solution = std::move(recover_solutions(system_, {&used_up, 1}, u, options_.threads).front());
    if (axial_.mode == SecondOrder::frame3dd) print_as_frame3dd(load, solution);
    return solution;
  }

  void print_as_frame3dd(const LoadVector& load, StaticSolution& solution) const {
    for (std::size_t i = 0; i < system_.model.beams.size(); ++i) {
      const Vec12 fixed = load.beam_fixed_end.empty() ? Vec12::Zero() : load.beam_fixed_end[i];
      solution.beam_end_forces[i] = frame3dd_end_forces(
          system_.model.beams[i], beam_rigid_end_displacements(system_.model.beams[i], solution.displacements), fixed,
          system_.ends_apart(static_cast<int>(i)));
    }
  }

  FrameSystem system_;
  AnalysisOptions options_;
  AxialState axial_;
  std::unique_ptr<Factor> factor_;
  bool usable_ = false;           ///< the factor is of a tangent under these loads,
  bool of_this_tangent_ = false;  ///< of the last one
  std::vector<double> factor_scale_;
  Eigen::VectorXd last_;  ///< the last answer, not scaled
};

SecondOrderAnalysis::SecondOrderAnalysis(const FrameModel& model, SecondOrder mode, const AnalysisOptions& options,
                                         std::vector<JointedShell> jointed)
    : state_(std::make_unique<State>(model, mode, options, std::move(jointed))) {}
SecondOrderAnalysis::~SecondOrderAnalysis() = default;
SecondOrderAnalysis::SecondOrderAnalysis(SecondOrderAnalysis&&) noexcept = default;
SecondOrderAnalysis& SecondOrderAnalysis::operator=(SecondOrderAnalysis&&) noexcept = default;

SecondOrderSolution SecondOrderAnalysis::solve(const LoadSet& loads, const StaticSolution& first_order) {
  return state_->run(loads, first_order);
}
const AnalysisStatistics& SecondOrderAnalysis::statistics() const { return state_->statistics; }

Vec12 beam_rigid_end_displacements(const Beam& beam, const std::vector<Vec6>& nodes) {
  return rigid_end_displacements(beam, nodes[static_cast<std::size_t>(beam.node[0])],
                                 nodes[static_cast<std::size_t>(beam.node[1])]);
}

struct SecondOrderDiagram::State {
  double length = 0;
  BeamDiagram linear;  ///< axial force and torsion; for `cubic` everything
  bool exact = false;
  BeamColumn::Curve xy, xz;
  std::array<double, 2> ends_xy{}, ends_xz{};  ///< v at both ends of the curves
  std::vector<double> marks;                   ///< where curves may kink

  /// In second order bending alone is another than the linear diagram's.
  [[nodiscard]] bool bends(BeamDiagram::Quantity quantity) const {
    return exact && quantity != BeamDiagram::axial && quantity != BeamDiagram::torsion;
  }

  /// Where it jumps, the value just before, or just `beyond`.
  [[nodiscard]] double value(BeamDiagram::Quantity quantity, double x, bool beyond = false) const {
    enum { v, rotation, M, T };
    const auto from_chord = [&](const BeamColumn::Curve& curve, const std::array<double, 2>& ends) {
      const double f = x / length;
      return curve.value(v, x) - (1 - f) * ends[0] - f * ends[1];
    };
    if (!bends(quantity)) return linear.value(quantity, x, beyond);
    switch (quantity) {
      case BeamDiagram::shear_y:
        return xy.value(T, x, beyond);
      case BeamDiagram::shear_z:
        return xz.value(T, x, beyond);
      case BeamDiagram::moment_z:
        return xy.value(M, x, beyond);
      case BeamDiagram::moment_y:
        return -xz.value(M, x, beyond);
      case BeamDiagram::deflection_y:
        return from_chord(xy, ends_xy);
      default:
        return from_chord(xz, ends_xz);
    }
  }

  [[nodiscard]] std::array<double, 8> values(double x, bool beyond) const {
    if (!exact) return linear.values(x, beyond);
    std::array<double, 8> all{};
    for (int q = 0; q < BeamDiagram::quantities; ++q)
      all[static_cast<std::size_t>(q)] = value(static_cast<BeamDiagram::Quantity>(q), x, beyond);
    return all;
  }
};

namespace {

/// End forces whose shears are across the displaced chord: first-order statics then join the moments at both ends.
Vec12 across_the_chord(const Beam& beam, double axial, const Vec12& end_forces, const Vec12& rigid_ends) {
  Vec12 result = end_forces;
  for (int c : {1, 2}) {
    const double share = axial * (rigid_ends(c + 6) - rigid_ends(c)) / beam.length;
    result(c) += share;
    result(c + 6) -= share;
  }
  return result;
}

}  // namespace

SecondOrderDiagram::SecondOrderDiagram(const Beam& beam, const AxialState& axial, int index, const Vec12& end_forces,
                                       const Vec12& rigid_ends) {
  const auto i = static_cast<std::size_t>(index);
  const std::vector<BeamLoad>& loads = axial.loads[i];
  const bool exact = axial.mode == SecondOrder::exact;
  const double mean = 0.5 * (end_forces(6) - end_forces(0));
  state_.reset(
      new State{beam.length,
                BeamDiagram(beam, exact ? end_forces : across_the_chord(beam, mean, end_forces, rigid_ends), loads),
                exact,
                {},
                {},
                {},
                {},
                {0, beam.length}});
  if (exact) {
    const SecondOrderBeam column(beam, 1, axial.mode, axial.first_axial[i], loads);
    state_->xy = column.in_xy().curve(plane_part(rigid_ends, false));
    state_->xz = column.in_xz().curve(plane_part(rigid_ends, true));
    state_->ends_xy = {state_->xy.value(0, 0), state_->xy.value(0, beam.length)};
    state_->ends_xz = {state_->xz.value(0, 0), state_->xz.value(0, beam.length)};
  }
  for (const BeamLoad& load : loads) {
    if (load.kind == BeamLoad::Kind::temperature) continue;
    state_->marks.push_back(std::clamp(load.from, 0.0, beam.length));
    if (load.kind == BeamLoad::Kind::distributed) state_->marks.push_back(std::clamp(load.to, 0.0, beam.length));
  }
  std::sort(state_->marks.begin(), state_->marks.end());
}
SecondOrderDiagram::~SecondOrderDiagram() = default;
SecondOrderDiagram::SecondOrderDiagram(SecondOrderDiagram&&) noexcept = default;
SecondOrderDiagram& SecondOrderDiagram::operator=(SecondOrderDiagram&&) noexcept = default;

std::array<double, 8> SecondOrderDiagram::values(double distance, bool beyond) const {
  return state_->values(std::clamp(distance, 0.0, state_->length), beyond);
}

std::vector<double> SecondOrderDiagram::breaks() const { return state_->linear.breaks(); }

/// Where the load is smooth the curves are too: the best of evenly spread points, made exact by a parabola's golden
/// section around it.
BeamDiagram::Range SecondOrderDiagram::extremes(BeamDiagram::Quantity quantity) const {
  const State& s = *state_;
  if (!s.bends(quantity)) return s.linear.extremes(quantity);
  const auto value = [&](double x) { return s.value(quantity, x); };
  constexpr std::size_t points = 24;
  constexpr double golden = 0.6180339887498949;
  BeamDiagram::Range range{{value(0), 0}, {value(0), 0}};
  const auto consider = [&](double x, double v) {
    if (v < range.least.value) range.least = {v, x};
    if (v > range.greatest.value) range.greatest = {v, x};
  };
  const auto sharpen = [&](double a, double b, double sign) {
    double c = b - golden * (b - a), d = a + golden * (b - a), at_c = sign * value(c), at_d = sign * value(d);
    for (int k = 0; k < 40; ++k) {
      if (at_c < at_d) {
        a = c;
        c = d;
        at_c = at_d;
        d = a + golden * (b - a);
        at_d = sign * value(d);
      } else {
        b = d;
        d = c;
        at_d = at_c;
        c = b - golden * (b - a);
        at_c = sign * value(c);
      }
    }
    consider((a + b) / 2, value((a + b) / 2));
  };
  for (std::size_t m = 0; m + 1 < s.marks.size(); ++m) {
    const double from = s.marks[m], to = s.marks[m + 1], width = to - from;
    if (width <= 0) continue;
    const auto place = [&](std::size_t k) { return k == points ? to : from + width * static_cast<double>(k) / points; };
    std::array<double, points + 1> v{};
    for (std::size_t k = 0; k <= points; ++k) {
      v[k] = s.value(quantity, place(k), k == 0);
      consider(place(k), v[k]);
    }
    for (std::size_t k = 1; k < points; ++k) {
      if (v[k] > v[k - 1] && v[k] >= v[k + 1]) sharpen(place(k - 1), place(k + 1), 1);
      if (v[k] < v[k - 1] && v[k] <= v[k + 1]) sharpen(place(k - 1), place(k + 1), -1);
    }
    // Between an end and the next point the curve may go up and down again: then it sets out the other way.
    constexpr double aside = 1e-6;
    const auto look_between = [&](std::size_t end, std::size_t next, double beside_end) {
      const double sets_out = value(beside_end) - v[end], comes_to = v[next] - v[end];
      const double a = std::min(place(end), place(next)), b = std::max(place(end), place(next));
      if (sets_out > 0 && comes_to < 0) sharpen(a, b, 1);
      if (sets_out < 0 && comes_to > 0) sharpen(a, b, -1);
    };
    look_between(0, 1, from + aside * width);
    look_between(points, points - 1, to - aside * width);
  }
  return range;
}

}  // namespace topple::solver
