#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <optional>
#include <set>
#include <span>

#include "analysis/divided_member.h"
#include "analysis/equilibrium.h"
#include "analysis/instability.h"
#include "analysis/largest_displacement.h"
#include "analysis/loads_by_member.h"
#include "analysis/modal_masses.h"
#include "analysis/one_way_members.h"
#include "analysis/request_checks.h"
#include "analysis/resultants/discretisation.h"
#include "analysis/resultants/section_cuts.h"
#include "analysis/resultants/shell_results.h"
#include "analysis/sample_analysis.h"
#include "analysis/second_order_member.h"
#include "analysis/storeys.h"
#include "analysis/undivided_members.h"
#include "failure/panel_bearings.h"
#include "failure/panel_demand.h"
#include "loads/case_loads.h"
#include "mesh/giving_edges.h"
#include "parallel/in_order.h"
#include "topple/solver/beam_diagram.h"
#include "topple/solver/case_sums.h"
#include "topple/solver/kept_memory.h"
#include "topple/solver/parallel_for.h"
#include "topple/solver/shifted_modes.h"
#include "topple/structure/analysis.h"
#include "topple/structure/error.h"
#include "topple/structure/frame.h"

namespace topple::structure {

namespace {

/// Everything that the combinations share.
class Analysis {
 public:
  Analysis(const Building& building, const AnalysisRequest& request, solver::KeptEquations* kept = nullptr,
           bool brief = false)
      : building_(building),
        request_(request),
        kept_(kept),
        brief_(brief),
        frame_(make_frame(building)),
        hanging_(hanging_shells(frame_)),
        edges_(building),
        bearing_edges_(building, frame_, edges_),
        bearings_(building, edges_),
        storeys_(building) {
    for (std::size_t m = 0; m < building.members.size(); ++m)
      for (int end = 0; end < 2; ++end)
        if (building[building.joint(MemberId(m), end)].capacity.breakable) breakable_ends_.emplace_back(m, end);
    combinations_ = request.combinations;
    if (combinations_.empty())
      for (std::size_t i = 0; i < building.combinations.size(); ++i) combinations_.emplace_back(i);
    if (combinations_.size() > 1) cases_ = case_loads(building, frame_, edges_, combinations_);
    linear_ = request.second_order == solver::SecondOrder::none && request.buckling == 0 &&
              !OneWayMembers(frame_.model).any();
    if (linear_ && of_cases()) {
      if (!has_meshes(frame_)) prepare_sums();
      return;
    }
    loads_.resize(combinations_.size());
    solver::parallel_for(loads_.size(), workers_for(loads_.size(), request.workers),
                         [&](std::size_t k) { loads_[k] = loads_of(k); });
  }

  AnalysisResult run() {
    std::optional<solver::KeptMemory> kept;  // for what follows the linear answer
    if (!linear_ || request_.modes > 0) kept.emplace();
    AnalysisResult result;
    result.cuts = request_.cuts;
    try {
      solve_and_recover(result);
      if (request_.modes > 0 && !failed_) find_modes(result);
    } catch (const solver::Instability& unstable) {
      const std::string message = building_.file + ": " + describe_instability(building_, frame_, unstable);
      throw UnstableAnalysis(diagnose(building_, frame_, unstable, "mechanism", combinations_.front(), message));
    } catch (const std::invalid_argument& error) {
      // What a reader cannot see: settlements that bend a rigid floor, for one.
      throw InputError(building_.file + ": " + error.what());
    }
    if (failed_ && result.combinations.empty()) throw *failed_;
    const auto& nodes = frame_.model.nodes;
    result.mesh_nodes.assign(nodes.begin() + static_cast<std::ptrdiff_t>(building_.nodes.size()), nodes.end());
    if (!failed_) find_losses_asked_for(result);
    if (!failed_) find_motions_asked_for(result);
    result.warnings.insert(result.warnings.begin(), building_.warnings.begin(), building_.warnings.end());
    warn_of_frame3dd(result);
    if (result.statistics.nearly_unstable)
      result.warnings.push_back("the model is nearly unstable: about " +
                                std::to_string(static_cast<int>(result.statistics.digits_left)) +
                                " digits of the answer are left");
    warn_of_error(result);
    warn_of_meshes(result);
    warn_of_lifting_loads(result);
    warn_of_large_deflections(result);
    if (failed_) {
      if (request_.modes > 0) result.unfinished.emplace_back("natural modes");
      if (request_.losses.any()) result.unfinished.emplace_back("losses of members");
      failed_->partial = std::make_shared<AnalysisResult>(std::move(result));
      throw *failed_;
    }
    return result;
  }

 private:
  /// A structure that floats, whose modes are asked for with a shift, bears no loads: it has modes all the same.
  void solve_and_recover(AnalysisResult& result) {
    try {
      recover(solve_linear(result.statistics), result);
    } catch (const solver::Instability& unstable) {
      if (request_.modes == 0 || building_.requested.frequency_shift <= 0) throw;
      floats_ = true;
      result.combinations.clear();
      result.warnings.push_back("no combination is solved: " + describe_instability(building_, frame_, unstable) +
                                "; the shift that the file gives is for its modes alone");
    }
  }

  /// Combinations that are linear to the end stand alone; others share an ordering, and what one leaves behind.
  void recover(std::vector<solver::StaticSolution> solutions, AnalysisResult& result) {
    result.combinations.resize(solutions.size());
    std::atomic<std::size_t> done = 0;
    const auto one = [&](std::size_t k) {
      result.combinations[k] = analysed(k, std::move(solutions[k]));
      tell("combinations", static_cast<double>(++done) / static_cast<double>(solutions.size()));
    };
    if (linear_) {
      solver::parallel_for(solutions.size(), workers_for(solutions.size(), request_.workers), one);
    } else {
      for (std::size_t k = 0; k < solutions.size(); ++k) try_one(k, one, result);
      std::erase_if(result.combinations, [](const CombinationResult& c) { return !c.combination.valid(); });
    }
  }

  /// One that is not stable does not keep the others from being computed.
  template <class One>
  void try_one(std::size_t k, const One& one, AnalysisResult& result) {
    try {
      one(k);
    } catch (const UnstableAnalysis& unstable) {
      result.unfinished.push_back("combination " + building_[combinations_[k]].name + ": " +
                                  unstable.diagnosis.message);
      if (!failed_) failed_.emplace(unstable);
    }
  }

  void tell(std::string_view stage, double share = -1) const {
    if (request_.progress) request_.progress(stage, share);
  }

  /// Fewer cases than combinations: these are found as sums.
  [[nodiscard]] bool of_cases() const { return !cases_.sets.empty() && cases_.sets.size() < combinations_.size(); }

  /// What combinations have on members, and against their reactions, is then added up from what the cases have.
  void prepare_sums() {
    case_loads_.emplace(building_.members.size(), cases_);
    for (const solver::LoadSet& set : cases_.sets) case_balances_.push_back(balance_of(frame_.model, set));
  }

  [[nodiscard]] CombinationLoads loads_of(std::size_t k) const {
    return combination_loads(building_, frame_, edges_, building_[combinations_[k]]);
  }

  /// The factor, by far the largest thing there is, goes with the analysis: nothing that follows needs it.
  [[nodiscard]] std::vector<solver::StaticSolution> solve_linear(solver::AnalysisStatistics& statistics) {
    tell("factorisation");
    if (of_cases()) {
      solver::CaseSums sums =
          kept_ ? kept_->solve_case_sums(carrying_both(frame_.model), cases_.sets, cases_.factors, request_.solver)
                : solver::solve_case_sums(carrying_both(frame_.model), cases_.sets, cases_.factors, request_.solver);
      statistics = sums.statistics;
      return std::move(sums.solutions);
    }
    std::vector<solver::LoadSet> sets;
    for (CombinationLoads& loads : loads_) sets.push_back(std::move(loads.set));
    std::vector<solver::StaticSolution> solutions;
    if (kept_) {
      solutions = kept_->solve(carrying_both(frame_.model), sets, request_.solver, statistics);
    } else {
      solver::StaticAnalysis analysis(carrying_both(frame_.model), request_.solver);
      solutions = analysis.solve(sets);
      statistics = analysis.statistics();
    }
    for (std::size_t k = 0; k < sets.size(); ++k) loads_[k].set = std::move(sets[k]);
    return solutions;
  }

  void find_losses_asked_for(AnalysisResult& result) const {
    if (!request_.losses.any()) return;
    const auto start = std::chrono::steady_clock::now();
    result.losses = find_losses(building_, combinations_, request_.losses, request_.solver);
    result.loss_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  void find_motions_asked_for(AnalysisResult& result) const {
    if (!request_.time_history) return;
    if (request_.second_order != solver::SecondOrder::none)
      throw InputError(building_.file + ": time histories are found by first order; accepted: no --p-delta");
    const auto start = std::chrono::steady_clock::now();
    result.motions =
        find_motions(building_, combinations_, *request_.time_history, request_.losses.motion, request_.solver);
    result.loss_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  [[nodiscard]] std::vector<std::string> member_names() const {
    std::vector<std::string> names;
    for (const Member& member : building_.members) names.push_back(member.name);
    return names;
  }

  /// With tension-only and compression-only members slack where they have to be.
  [[nodiscard]] OneWayAnswer settled(std::size_t k, solver::StaticSolution solution) const {
    const OneWayMembers one_way(frame_.model);
    if (!one_way.any()) return {std::move(solution), {}, {}, 0, {}};
    const auto linear = [&](const solver::FrameModel& model, OneWayAnswer& answer) {
      solver::StaticAnalysis analysis(model, request_.solver);
      answer.solution = std::move(analysis.solve({&loads_[k].set, 1}).front());
    };
    try {
      return one_way.settle(loads_[k].set, one_way.all_taut(solution), linear, member_names(),
                            OneWayMembers::Mechanisms::go_through);
    } catch (const solver::Instability& unstable) {
      const std::string message = building_.file + ", combination " + building_[combinations_[k]].name +
                                  ", with members slack: " + describe_instability(building_, frame_, unstable);
      throw UnstableAnalysis(diagnose(building_, frame_, unstable, "mechanism", combinations_[k], message));
    } catch (const std::runtime_error& cycle) {
      throw std::runtime_error(building_.file + ", combination " + building_[combinations_[k]].name + ": " +
                               cycle.what());
    }
  }

  /// Second order and buckling on what is taut, when they are asked for.
  [[nodiscard]] CombinationResult analysed(std::size_t k, solver::StaticSolution linear) {
    OneWayAnswer answer = settled(k, std::move(linear));
    const bool second_order = request_.second_order != solver::SecondOrder::none;
    if (!second_order && request_.buckling == 0) {
      if (case_loads_) return gather_sum(k, answer);
      return gather(k, answer, loads_.empty() ? loads_of(k) : std::move(loads_[k]));
    }
    const std::string of = " of " + building_[combinations_[k]].name;
    if (second_order) tell("second order" + of);
    // Where no member goes slack, buckling begins with the same linear answer.
    const bool taut = !OneWayMembers(frame_.model).any();
    solver::StaticSolution first_order;
    if (request_.buckling > 0 && taut) first_order = answer.solution;
    const int iterations = second_order ? turn_to_second_order(k, answer) : 0;
    solver::FrameModel model = carrying_both(frame_.model);
    if (!answer.beams.empty()) model.beams = answer.beams;
    CombinationResult result = gather(k, answer, loads_[k]);
    tangent_ = answer.axial;
    tangent_beams_ = model.beams;
    result.second_order_iterations = iterations;
    if (request_.buckling > 0) tell("buckling" + of);
    if (k + 1 == combinations_.size()) second_order_.reset();  // its factor is as large as the one to come
    if (request_.buckling > 0)
      result.buckling = solver::buckling_modes(model, loads_[k].set, request_.buckling, request_.solver,
                                               largest_buckling_factor, hanging_, taut ? &first_order : nullptr);
    for (solver::BucklingMode& mode : result.buckling) scale_shape(mode.shape);
    return result;
  }

  /// From the first-order answer; members that second order turns over are turned, until every one is as it has to be.
  /// Returns the iterations that the last state took.
  int turn_to_second_order(std::size_t k, OneWayAnswer& answer) {
    const std::string place = building_.file + ", combination " + building_[combinations_[k]].name;
    solver::FrameModel model = carrying_both(frame_.model);
    const OneWayMembers one_way(frame_.model);
    int iterations = 0;
    const auto solve = [&](const solver::FrameModel& state, OneWayAnswer& found) {
      model.beams = state.beams;
      // Combinations with the same members taut share an ordering.
      if (!second_order_ || one_way.any())
        second_order_.emplace(model, request_.second_order, request_.solver, hanging_);
      solver::SecondOrderSolution solution = second_order_->solve(loads_[k].set, found.solution);
      found.solution = std::move(solution.solution);
      found.axial = std::move(solution.axial);
      iterations = solution.iterations;
    };
    const auto solve_anew = [&](const solver::FrameModel& state, OneWayAnswer& found) {
      solver::StaticAnalysis linear(state, request_.solver);
      found.solution = std::move(linear.solve({&loads_[k].set, 1}).front());
      solve(state, found);
    };
    try {
      if (!answer.beams.empty()) model.beams = answer.beams;
      solve(solver::FrameModel(model), answer);
      if (one_way.any()) answer = one_way.settle(loads_[k].set, std::move(answer), solve_anew, member_names());
      return iterations;
    } catch (const solver::Buckled& buckled) {
      auto modes = solver::buckling_modes(model, loads_[k].set, 1, request_.solver, largest_buckling_factor, hanging_);
      const std::string message = place + ": " + beyond_buckling(modes, buckled);
      Diagnosis diagnosis = diagnose(building_, frame_, buckled, "buckling", combinations_[k], message);
      if (!modes.empty()) {
        scale_shape(modes.front().shape);
        diagnosis.shape = modes.front().shape;
      }
      throw UnstableAnalysis(std::move(diagnosis));
    } catch (const solver::Instability& unstable) {
      const std::string message = place + ", with members slack: " + describe_instability(building_, frame_, unstable);
      throw UnstableAnalysis(diagnose(building_, frame_, unstable, "mechanism", combinations_[k], message));
    } catch (const std::runtime_error& cycle) {
      throw std::runtime_error(place + ", second order: " + cycle.what());
    }
  }

  /// What a second-order answer that does not exist says of itself. A linear factor above 1 is not the limit:
  /// deflections that grow with the load bring it down.
  [[nodiscard]] std::string beyond_buckling(const std::vector<solver::BucklingMode>& modes,
                                            const solver::Buckled& buckled) const {
    std::string text = "the loads are beyond what the structure bears before it buckles";
    if (!modes.empty() && modes[0].factor <= 1)
      text += " (critical factor " + short_number(modes[0].factor) + ")";
    else if (!modes.empty())
      text += ": a limit point lies below these loads (the linear critical factor, " + short_number(modes[0].factor) +
              ", leaves out that deflections raise axial forces)";
    return text + "; " + describe_buckling(building_, frame_, buckled);
  }

  /// Without load, all one-way members taut; with second order as the last combination has left the structure.
  void find_modes(AnalysisResult& result) const {
    tell("natural modes");
    solver::MassModel masses{request_.mass,
                             request_.torsional_mass,
                             request_.rotary_inertia,
                             modal_masses(building_, frame_, edges_),
                             mass_lengths(building_, frame_),
                             hanging_};
    solver::FrameModel model = carrying_both(frame_.model);
    const bool loaded = request_.second_order != solver::SecondOrder::none;
    if (loaded && !floats_) model.beams = tangent_beams_;
    const solver::AxialState* tangent = loaded && !floats_ ? &tangent_ : nullptr;
    solver::ModalAnswer answer =
        floats_ ? solver::shifted_modes(model, masses, request_.modes, building_.requested.frequency_shift,
                                        request_.solver, tangent)
                : solver::natural_modes(model, masses, request_.modes, request_.solver, tangent);
    result.modes = std::move(answer.modes);
    for (solver::VibrationMode& mode : result.modes) scale_shape(mode.shape);
    result.moving_mass = answer.moving_mass;
    if (static_cast<int>(result.modes.size()) < request_.modes)
      result.warnings.push_back("the masses have " + std::to_string(result.modes.size()) + " modes, " +
                                std::to_string(request_.modes) + " were asked for");
    // Frame3DD's files ask for modes themselves, and for elements as they are.
    if (building_.requested.modes > 0) return;
    if (std::string told = told_undivided(building_, frame_, result.modes); !told.empty())
      result.warnings.push_back(std::move(told));
  }

  /// So that no point of any node or member, bent between its ends, moves by more than 1; what is noise beside that is
  /// nothing.
  void scale_shape(std::vector<Vec6>& shape) const {
    make_shape_absolute(frame_, shape);
    const double largest = largest_in_shape(building_, shape);
    double most = 0;
    for (const Vec6& motion : shape) most = std::max(most, motion.cwiseAbs().maxCoeff());
    constexpr double noise = 1e-12;
    for (Vec6& motion : shape)
      for (double& component : motion) {
        if (std::abs(component) < noise * most) component = 0;
        if (largest > 0) component /= largest;
      }
  }

  /// Frame3DD takes a thermal strain for an axial force in the end forces that it prints.
  void warn_of_frame3dd(AnalysisResult& result) const {
    if (request_.second_order != solver::SecondOrder::frame3dd) return;
    std::set<int> heated;
    for (const CombinationLoads& loads : loads_)
      for (const solver::BeamLoad& load : loads.set.beams)
        if (load.kind == solver::BeamLoad::Kind::temperature) heated.insert(load.beam);
    if (heated.empty()) return;
    result.warnings.push_back(
        "end forces are Frame3DD's own, which are not in equilibrium for heated elements under geometric stiffness (" +
        building_.members[static_cast<std::size_t>(*heated.begin())].name +
        (heated.size() > 1 ? " and " + std::to_string(heated.size() - 1) + " more" : "") +
        "); --p-delta=cubic gives those in equilibrium");
  }

  /// What an answer says of its own error, where that is more than an engineer can overlook.
  void warn_of_error(AnalysisResult& result) const {
    constexpr double few_digits = 1e-6;
    const auto digits = [](double error) {
      return std::to_string(error < 1 ? static_cast<int>(-std::log10(error)) : 0);
    };
    for (const CombinationResult& c : result.combinations) {
      const std::string of = "combination " + building_[c.combination].name + ": ";
      if (!(c.equilibrium_error <= few_digits))
        result.warnings.push_back(of + "reactions balance the loads to about " + digits(c.equilibrium_error) +
                                  " digits only (equilibrium error " + short_number(c.equilibrium_error) + ")");
      if (!c.quality.converged)
        result.warnings.push_back(of + "the equations are not solved to rounding (backward error " +
                                  short_number(c.quality.backward_error) + "); about " + digits(c.quality.error_bound) +
                                  " digits of the displacements are certain");
    }
  }

  /// Stresses of a mesh that is too coarse; the deflections' error goes with the square.
  void warn_of_meshes(AnalysisResult& result) const {
    constexpr double coarse = 0.4;  // deflections are then off by some per cent
    for (const CombinationResult& c : result.combinations) {
      if (!(c.discretisation_error > coarse)) continue;
      const auto worst = std::max_element(c.panels.begin(), c.panels.end(), [](const auto& a, const auto& b) {
        return a.discretisation_error < b.discretisation_error;
      });
      result.warnings.push_back("combination " + building_[c.combination].name +
                                ": the shells' meshes are coarse: estimated error of stresses " +
                                short_number(100 * c.discretisation_error) + " %, most in panel " +
                                building_.panels[static_cast<std::size_t>(worst - c.panels.begin())].name +
                                "; a larger `mesh` lowers it");
    }
  }

  /// Loads that lift the whole are mostly signs that are missing.
  void warn_of_lifting_loads(AnalysisResult& result) const {
    constexpr double rounding = 1e-9;
    if (building_.units.consistent) return;  // up may be any way
    for (const CombinationResult& c : result.combinations)
      if (c.total_load[2] > rounding * c.total_load.head<3>().norm())
        result.warnings.push_back("combination " + building_[c.combination].name + ": its loads lift the structure (" +
                                  short_number(c.total_load[2] / building_.units.force) +
                                  " upwards on balance); loads that act downwards are negative along z");
  }

  /// Beyond a tenth of the structure's size nothing linear holds.
  void warn_of_large_deflections(AnalysisResult& result) const {
    constexpr double large = 0.1;
    if (building_.nodes.empty()) return;
    Vec3 low = building_.nodes.front().position, high = low;
    for (const Node& node : building_.nodes) {
      low = low.cwiseMin(node.position);
      high = high.cwiseMax(node.position);
    }
    const double size = (high - low).norm();
    for (const CombinationResult& c : result.combinations) {
      const std::string of = "combination " + building_[c.combination].name + ": ";
      if (c.largest.value > large * size) {
        result.warnings.push_back(of + "the largest displacement (" +
                                  short_number(c.largest.value / building_.units.length) +
                                  ") is above a tenth of the structure's size; small displacements are assumed");
        continue;
      }
      for (std::size_t m = 0; m < c.members.size(); ++m) {
        const auto sag = [&](std::size_t q) {
          return std::max(std::abs(c.members[m].min[q].value), std::abs(c.members[m].max[q].value));
        };
        if (std::max(sag(6), sag(7)) <= large * building_.members[m].length) continue;
        result.warnings.push_back(of + "member " + building_.members[m].name +
                                  " deflects by more than a tenth of its length; small displacements are assumed");
        break;
      }
    }
  }

  static std::string short_number(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", number);
    return text;
  }

  [[nodiscard]] CombinationResult gather(std::size_t k, const OneWayAnswer& answer, CombinationLoads loads) const {
    solver::StaticSolution absolute;
    if (!frame_.giving_nodes.empty()) {
      absolute = answer.solution;
      make_absolute(frame_, absolute.displacements);
    }
    const solver::StaticSolution& solution = frame_.giving_nodes.empty() ? answer.solution : absolute;
    const LoadsByMember by_member(building_.members.size(), loads.whole ? loads.whole->beams : loads.set.beams);
    CombinationResult result =
        gathered(k, answer, solution, loads.parts, [&](std::size_t member) { return by_member.on(member); });
    result.cuts = cut_results(building_, frame_, request_.cuts, loads.parts, loads.set, solution,
                              answer.axial.mode != solver::SecondOrder::none);
    std::vector<solver::NodeLoad> pushes = pushes_of_supports(loads.parts, result.reactions);
    loads.set.nodes.insert(loads.set.nodes.end(), pushes.begin(), pushes.end());
    leave_out_giving_sides(frame_, loads.set, result.reactions);
    hold_against_reactions(balance_of(frame_.model, loads.set), answer.axial.mode != solver::SecondOrder::none, result);
    return result;
  }

  [[nodiscard]] CombinationResult gather_sum(std::size_t k, const OneWayAnswer& answer) const {
    const PartLoads parts = loads_beside_members(building_, building_[combinations_[k]]);
    std::vector<solver::BeamLoad> sum;
    CombinationResult result = gathered(k, answer, answer.solution, parts, [&](std::size_t member) {
      case_loads_->add_up(k, member, sum);
      return std::span<const solver::BeamLoad>(sum);
    });
    if (!request_.cuts.empty()) {
      const CombinationLoads loads = loads_of(k);
      result.cuts = cut_results(building_, frame_, request_.cuts, loads.parts, loads.set, answer.solution, false);
    }
    Balance applied = balance_of(frame_.model, pushes_of_supports(parts, result.reactions));
    for (std::size_t c = 0; c < case_balances_.size(); ++c)
      applied.add(case_balances_[c], cases_.factors(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(k)));
    hold_against_reactions(applied, false, result);
    return result;
  }

  /// `loads_on(member)`: on the whole of each. Reactions are still those of the frame's supports.
  template <class LoadsOn>
  [[nodiscard]] CombinationResult gathered(std::size_t k, const OneWayAnswer& answer,
                                           const solver::StaticSolution& solution, const PartLoads& parts,
                                           LoadsOn loads_on) const {
    CombinationResult result;
    result.combination = combinations_[k];
    const auto of_mesh = solution.displacements.begin() + static_cast<std::ptrdiff_t>(building_.nodes.size());
    result.displacements.assign(solution.displacements.begin(), of_mesh);
    result.mesh_displacements.assign(of_mesh, solution.displacements.end());
    result.reactions = solution.reactions;
    result.quality = solution.quality;
    result.members = members(answer, loads_on);
    result.panels = panels(parts, solution);
    result.joints = joints(parts, solution, result);
    result.storeys = storeys_.results(result.displacements, result.members);
    if (brief_) return result;
    result.discretisation_error = recover_resultants(building_, frame_, parts, solution, result.panels);
    result.largest = largest_displacement(building_, result, [&](std::size_t m, double at) {
      Vec2 bent = Vec2::Zero();
      solver::Vec12 unused;
      with_diagram(answer, loads_on(m), m, unused, [&](double, const auto& diagram) {
        const std::array<double, 8> values = diagram.values(at);
        bent = {values[6], values[7]};
      });
      return bent;
    });
    return result;
  }

  void hold_against_reactions(const Balance& applied, bool displaced, CombinationResult& result) const {
    const Equilibrium balance = equilibrium(frame_.model, applied, result.reactions, displaced);
    result.edge_reactions = edge_reactions(building_, frame_, result.reactions);
    result.reactions.resize(building_.supports.size());
    result.total_load = balance.load;
    result.total_reaction = balance.reaction;
    result.equilibrium_error = balance.error;
  }

  /// A spring support whose far end is moved pushes its node: that is part of its reaction, not a load. Returns what
  /// takes the pushes off the loads again.
  [[nodiscard]] std::vector<solver::NodeLoad> pushes_of_supports(const PartLoads& parts,
                                                                 std::vector<Vec6>& reactions) const {
    std::vector<solver::NodeLoad> taken_off;
    for (const solver::Settlement& settlement : parts.settlements)
      for (std::size_t s = 0; s < building_.supports.size(); ++s) {
        const NodeSupport& support = building_.supports[s];
        const double stiffness = support.stiffness(settlement.component);
        if (support.node.index != settlement.node || stiffness == unlimited) continue;
        Vec6 push = Vec6::Zero();
        push(settlement.component) = stiffness * settlement.value;
        reactions[s] += push;
        taken_off.push_back({settlement.node, -push});
      }
    return taken_off;
  }

  template <class Diagram>
  void fill(MemberResult& member, double length, const Diagram& diagram) const {
    if (brief_) return;
    for (std::size_t q = 0; q < 8; ++q) {
      const auto range = diagram.extremes(static_cast<solver::BeamDiagram::Quantity>(q));
      member.min[q] = {range.least.value, range.least.at};
      member.max[q] = {range.greatest.value, range.greatest.at};
    }
    for (int s = 0; request_.stations > 0 && s <= request_.stations; ++s)
      member.stations.push_back(diagram.values(length * s / request_.stations));
    if (request_.critical_sections) add_critical_sections(member, length, diagram);
  }

  template <class Diagram>
  static void add_critical_sections(MemberResult& member, double length, const Diagram& diagram) {
    const std::vector<double> breaks = diagram.breaks();
    const auto add = [&](double at, bool beyond) {
      member.critical.push_back(diagram.values(at, beyond));
      member.critical_at.push_back(at);
    };
    for (const double at : breaks)
      for (const bool beyond : {false, true}) add(at, beyond);
    // Both sides of a break are there already: the extreme of one side does not go with the others of the other.
    const auto at_a_break = [&](double at) {
      constexpr double rounding = 1e-9;
      return std::any_of(breaks.begin(), breaks.end(),
                         [&](double place) { return std::abs(place - at) <= rounding * length; });
    };
    for (std::size_t q = 0; q < 6; ++q)
      for (const Extreme& extreme : {member.min[q], member.max[q]})
        if (!at_a_break(extreme.at)) add(extreme.at, false);
  }

  template <class LoadsOn>
  [[nodiscard]] std::vector<MemberResult> members(const OneWayAnswer& answer, LoadsOn loads_on) const {
    const std::vector<solver::Vec12>& end_forces = answer.solution.beam_end_forces;
    std::vector<MemberResult> all(building_.members.size());
    const auto one = [&](std::size_t i) {
      MemberResult& member = all[i];
      member.active = answer.active.empty() || answer.active[i] != 0;
      member.end_forces = end_forces[i];
      with_diagram(answer, loads_on(i), i, member.end_forces,
                   [&](double length, const auto& diagram) { fill(member, length, diagram); });
    };
    // Linear combinations go side by side themselves, and the sums of their loads have one place.
    constexpr std::size_t together = 256;
    const std::size_t parts = (all.size() + together - 1) / together;
    solver::parallel_for(parts, workers_for(parts, linear_ ? 1 : request_.workers), [&](std::size_t part) {
      for (std::size_t i = part * together; i < std::min(all.size(), (part + 1) * together); ++i) one(i);
    });
    return all;
  }

  /// Hands the diagram of member i, and the length it goes over, to `use`; sets its end forces where it is several
  /// beams.
  template <class Use>
  void with_diagram(const OneWayAnswer& answer, std::span<const solver::BeamLoad> on, std::size_t i,
                    solver::Vec12& member_end_forces, Use use) const {
    const std::vector<solver::Beam>& beams = answer.beams.empty() ? frame_.model.beams : answer.beams;
    const std::vector<solver::Vec12>& end_forces = answer.solution.beam_end_forces;
    const bool first_order = answer.axial.mode == solver::SecondOrder::none;
    if (frame_.pieces[i].empty() && first_order) {
      use(beams[i].length, solver::BeamDiagram(beams[i], end_forces[i], on));
      return;
    }
    const WholeMember whole = whole_member(frame_, i, beams, end_forces, {on.begin(), on.end()});
    member_end_forces = whole.end_forces;
    if (first_order)
      use(whole.beam.length, solver::BeamDiagram(whole.beam, whole.end_forces, whole.loads));
    else
      use(whole.beam.length, SecondOrderMember(frame_, i, beams, answer.axial, answer.solution));
  }

  /// Mean membrane forces of a membrane panel from its corner forces (the virial theorem), panel axes.
  [[nodiscard]] std::vector<PanelResult> panels(const PartLoads& parts, const solver::StaticSolution& solution) const {
    std::vector<PanelResult> all(building_.panels.size());
    for (std::size_t p = 0; p < all.size(); ++p) {
      if (!frame_.meshes[p].elements.empty()) {
        all[p] = shell_panel_result(building_, frame_, PanelId(p), parts, solution);
        continue;
      }
      const int shell = frame_.shell_of_panel[p];
      all[p].corner_forces.fill(Vec6::Zero());
      if (shell < 0) continue;
      const Panel& panel = building_.panels[p];
      const auto& forces = solution.shell_corner_forces[static_cast<std::size_t>(shell)];
      Mat3 virial = Mat3::Zero();
      const Vec3 origin = building_[panel.nodes[0]].position;
      for (std::size_t c = 0; c < 4; ++c) {
        all[p].corner_forces[c] = forces[c];
        virial += (panel.axes * forces[c].head<3>()) *
                  (panel.axes * (building_[panel.nodes[c]].position - origin)).transpose();
      }
      const Vec3 d1 = building_[panel.nodes[2]].position - origin;
      const Vec3 d2 = building_[panel.nodes[3]].position - building_[panel.nodes[1]].position;
      const Mat3 stress = (virial + virial.transpose()) / d1.cross(d2).norm();
      all[p].membrane = {stress(0, 0), stress(1, 1), stress(0, 1)};
    }
    return all;
  }

  [[nodiscard]] std::vector<Utilisation> joints(const PartLoads& parts, const solver::StaticSolution& solution,
                                                const CombinationResult& result) const {
    std::vector<Utilisation> used(building_.joints.size());
    for (const auto& [m, end] : breakable_ends_) {
      const JointId id = building_.joint(MemberId(m), end);
      used[static_cast<std::size_t>(id.index)] =
          utilisation(building_[id].capacity, member_joint_demand(result.members[m].end_forces, end));
    }
    for (std::size_t p = 0; p < building_.panels.size(); ++p) {
      const PanelId panel(p);
      std::array<Vec6, 4> demand{Vec6::Zero(), Vec6::Zero(), Vec6::Zero(), Vec6::Zero()};
      const bool meshed = !frame_.meshes[p].elements.empty();
      if (meshed) demand = shell_edge_demands(building_, frame_, bearing_edges_, panel, parts, solution);
      if (frame_.shell_of_panel[p] >= 0)
        demand = membrane_edge_demands(building_, panel, result.panels[p].corner_forces);
      const HandOver given = hand_over(building_, edges_, panel, parts.panels[p], {true, true, true, true});
      for (int edge = 0; edge < 4; ++edge) {
        const JointId id = building_.joint(panel, edge);
        const auto e = static_cast<std::size_t>(edge);
        if (!building_[id].capacity.breakable) continue;
        if (!meshed) demand[e] += handed_edge_demand(building_, bearings_, panel, edge, given.edge_force[e]);
        used[static_cast<std::size_t>(id.index)] = utilisation(building_[id].capacity, demand[e]);
      }
    }
    return used;
  }

  const Building& building_;
  /// Beyond it no factor is looked for.
  static constexpr double largest_buckling_factor = 1e6;

  const AnalysisRequest& request_;
  solver::KeptEquations* kept_;  ///< null: nothing is kept
  bool brief_ = false;           ///< analyse_briefly()
  Frame frame_;
  std::vector<solver::HangingShell> hanging_;
  EdgeMembers edges_;
  BearingEdges bearing_edges_;
  PanelBearings bearings_;
  Storeys storeys_;
  std::vector<std::pair<std::size_t, int>> breakable_ends_;  ///< member, end
  std::vector<CombinationId> combinations_;
  CaseLoads cases_;                              ///< where there are several combinations
  bool linear_ = false;                          ///< to the end: no second order, no buckling, no one-way members
  std::optional<CaseLoadsByMember> case_loads_;  ///< where combinations are added up from these to the end
  std::vector<Balance> case_balances_;
  std::vector<CombinationLoads> loads_;     ///< per combination; empty where each is made when it is its turn
  std::optional<UnstableAnalysis> failed_;  ///< the first combination that is not stable
  bool floats_ = false;                     ///< nothing but the shift of the modes keeps it in place
  std::optional<solver::SecondOrderAnalysis> second_order_;
  solver::AxialState tangent_;  ///< of the last combination
  std::vector<solver::Beam> tangent_beams_;
};

}  // namespace

AnalysisResult analyse(const Building& building, const AnalysisRequest& request) {
  require_request(building, request);
  require_stocky(building, request);
  return Analysis(building, request).run();
}

AnalysisResult analyse_with(solver::KeptEquations& kept, const Building& building, const AnalysisRequest& request) {
  require_request(building, request);
  require_stocky(building, request);
  return Analysis(building, request, &kept).run();
}

AnalysisResult analyse_briefly(solver::KeptEquations& kept, const Building& building, const AnalysisRequest& request) {
  require_request(building, request);
  require_stocky(building, request);
  return Analysis(building, request, &kept, true).run();
}

}  // namespace topple::structure
