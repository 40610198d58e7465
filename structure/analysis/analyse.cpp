#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>

#include "analysis/answer_recovery.h"
#include "analysis/answer_warnings.h"
#include "analysis/instability.h"
#include "analysis/natural_modes.h"
#include "analysis/one_way_members.h"
#include "analysis/request_checks.h"
#include "analysis/sample_analysis.h"
#include "loads/case_loads.h"
#include "mesh/frame_mesh.h"
#include "mesh/semi_rigid_elements.h"
#include "model/short_number.h"
#include "parallel/in_order.h"
#include "topple/solver/case_sums.h"
#include "topple/solver/kept_memory.h"
#include "topple/solver/parallel_for.h"
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
        frame_(make_frame(building)),
        jointed_(jointed_shells(frame_)),
        edges_(building),
        linear_(request.second_order == solver::SecondOrder::none && request.buckling == 0 &&
                !OneWayMembers(frame_.model).any()),
        recovery_(building, frame_, edges_, request, brief, linear_) {
    combinations_ = request.combinations;
    if (combinations_.empty())
      for (std::size_t i = 0; i < building.combinations.size(); ++i) combinations_.emplace_back(i);
    if (combinations_.size() > 1) cases_ = case_loads(building, frame_, edges_, combinations_);
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
    if (request_.second_order == solver::SecondOrder::frame3dd) warn_of_heated_elements(building_, loads_, result);
    if (result.statistics.nearly_unstable)
      result.warnings.push_back("the model is nearly unstable: about " +
                                std::to_string(static_cast<int>(result.statistics.digits_left)) +
                                " digits of the answer are left");
    warn_of_answer(building_, result);
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
      report_progress("combinations", static_cast<double>(++done) / static_cast<double>(solutions.size()));
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

  void report_progress(std::string_view stage, double share = -1) const {
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
    report_progress("factorisation");
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

  [[nodiscard]] MotionRequest motion_request() const {
    MotionRequest motion = request_.losses.motion;
    motion.second_order = motion.second_order || request_.second_order != solver::SecondOrder::none;
    return motion;
  }

  void find_losses_asked_for(AnalysisResult& result) const {
    if (!request_.losses.any()) return;
    const auto start = std::chrono::steady_clock::now();
    LossRequest losses = request_.losses;
    losses.motion = motion_request();
    result.losses = find_losses(building_, combinations_, losses, request_.solver);
    result.loss_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  void find_motions_asked_for(AnalysisResult& result) const {
    if (!request_.time_history) return;
    const auto start = std::chrono::steady_clock::now();
    result.motions = find_motions(building_, combinations_, *request_.time_history, motion_request(), request_.solver);
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
      if (case_loads_)
        return recovery_.recovered_sum(combinations_[k], answer, {*case_loads_, case_balances_, cases_.factors}, k);
      return recovery_.recovered(combinations_[k], answer, loads_.empty() ? loads_of(k) : std::move(loads_[k]));
    }
    const std::string of = " of " + building_[combinations_[k]].name;
    if (second_order) report_progress("second order" + of);
    // Where no member goes slack, buckling begins with the same linear answer.
    const bool taut = !OneWayMembers(frame_.model).any();
    solver::StaticSolution first_order;
    if (request_.buckling > 0 && taut) first_order = answer.solution;
    const int iterations = second_order ? turn_to_second_order(k, answer) : 0;
    solver::FrameModel model = carrying_both(frame_.model);
    if (!answer.beams.empty()) model.beams = answer.beams;
    CombinationResult result = recovery_.recovered(combinations_[k], answer, loads_[k]);
    tangent_ = answer.axial;
    tangent_beams_ = model.beams;
    result.second_order_iterations = iterations;
    if (request_.buckling > 0) report_progress("buckling" + of);
    if (k + 1 == combinations_.size()) second_order_.reset();  // its factor is as large as the one to come
    if (request_.buckling > 0)
      result.buckling = solver::buckling_modes(model, loads_[k].set, request_.buckling, request_.solver,
                                               largest_buckling_factor, jointed_, taut ? &first_order : nullptr);
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
        second_order_.emplace(model, request_.second_order, request_.solver, jointed_);
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
      const auto modes = modes_if_any(model, k);
      const std::string message = place + ": " + beyond_buckling(modes, buckled);
      Diagnosis diagnosis = diagnose(building_, frame_, buckled, "buckling", combinations_[k], message);
      if (!modes.empty()) {
        diagnosis.shape = modes.front().shape;
        scale_shape(diagnosis.shape);
      }
      throw UnstableAnalysis(std::move(diagnosis));
    } catch (const solver::Instability& unstable) {
      const std::string message = place + ", with members slack: " + describe_instability(building_, frame_, unstable);
      throw UnstableAnalysis(diagnose(building_, frame_, unstable, "mechanism", combinations_[k], message));
    } catch (const std::runtime_error& cycle) {
      throw std::runtime_error(place + ", second order: " + cycle.what());
    }
  }

  /// How the frame buckles by linear theory, for the words of a refusal, which stands without it too.
  [[nodiscard]] std::vector<solver::BucklingMode> modes_if_any(const solver::FrameModel& model, std::size_t k) const {
    try {
      return solver::buckling_modes(model, loads_[k].set, 1, request_.solver, largest_buckling_factor, jointed_);
    } catch (const std::runtime_error&) {  // as loads of 1e20 are: no factor can be told from rounding
      return {};
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

  /// As the last combination has left the structure, where that is asked for.
  void find_modes(AnalysisResult& result) const {
    report_progress("natural modes");
    const bool second_order = request_.second_order != solver::SecondOrder::none && !floats_;
    find_natural_modes({building_, request_, frame_, edges_, jointed_, floats_},
                       second_order ? std::optional(ModalTangent{tangent_beams_, tangent_}) : std::nullopt, result);
  }
  void scale_shape(std::vector<Vec6>& shape) const { scale_to_largest(building_, frame_, {}, shape); }

  /// Beyond it no factor is looked for.
  static constexpr double largest_buckling_factor = 1e6;

  const Building& building_;
  const AnalysisRequest& request_;
  solver::KeptEquations* kept_;  ///< null: nothing is kept
  Frame frame_;
  std::vector<solver::JointedShell> jointed_;
  EdgeMembers edges_;
  bool linear_ = false;  ///< to the end: no second order, no buckling, no one-way members
  AnswerRecovery recovery_;
  std::vector<CombinationId> combinations_;
  CaseLoads cases_;                              ///< where there are several combinations
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
