#include "topple/structure/losses.h"

#include <algorithm>
#include <limits>
#include <map>

#include "analysis/damaged_frame.h"
#include "analysis/motion/frame_motion.h"
#include "analysis/sample_analysis.h"
#include "model/index_of.h"
#include "standing/unstable_model.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

constexpr const char* what_is_asked = "losses of members";
/// Losses whose answers are found together: more would not fit the caches beside a block of the factor.
constexpr std::size_t together = 16;

/// R0 of one combination.
struct Reference {
  std::vector<Vec6> displacements, demand;
  std::vector<solver::Vec12> end_forces;
};

class Losses {
 public:
  Losses(const Building& building, const LossRequest& request, const solver::AnalysisOptions& options)
      : whole_(building),
        divided_(building),
        building_(divided_.building()),
        request_(request),
        members_(all_of(request)),
        frame_(divided_, members_, options) {
    if (request.motion.asked && request.motion.second_order) frame_.use_second_order();
    for (const MemberId member : members_) {
      const bool named = std::find(request.named.begin(), request.named.end(), member) != request.named.end();
      result_.losses.push_back({member, named, {}});
    }
  }

  LossResult run(const std::vector<CombinationId>& combinations) {
    for (const CombinationId combination : combinations) {
      load(combination);
      keep_reference(references_[combination]);
      for (std::size_t i = 0; i < result_.losses.size(); ++i) {
        MemberLoss& loss = result_.losses[i];
        if (i % together == 0) frame_.expect(std::span(members_).subspan(i, std::min(together, members_.size() - i)));
        frame_.lose(loss.member);
        loss.states.push_back(state_after(loss.named));
        loss.states.back().combination = combination;
        if (request_.motion.asked && loss.states.back().stands()) follow_motion(loss.states.back());
        frame_.restore();
      }
    }
    sort();
    result_.counters = frame_.analysis().counters();
    return std::move(result_);
  }

  /// The state in which the factor is made: nothing lost, under this combination.
  void begin(CombinationId combination) {
    load(combination);
    begun_ = frame_.analysis().counters();
    at_first_ = frame_.analysis().displacements();
  }
  /// One member alone, beginning and ending in that state.
  [[nodiscard]] MemberLoss one(MemberId member, const std::vector<CombinationId>& combinations) {
    MemberLoss loss{member, false, {}};
    for (const CombinationId combination : combinations) {
      if (combination != combinations.front()) load(combination);
      if (references_.contains(combination))
        reference_ = &references_[combination];
      else
        keep_reference(references_[combination]);
      frame_.expect({&member, 1});
      frame_.lose(member);
      loss.states.push_back(state_after(false));
      loss.states.back().combination = combination;
      frame_.restore();
      if (combination != combinations.front()) load(combinations.front());
    }
    (void)frame_.solve();
    return loss;
  }
  [[nodiscard]] bool as_begun() const {
    const solver::ReanalysisCounters& now = frame_.analysis().counters();
    return now.refactorisations == begun_.refactorisations && now.orderings == begun_.orderings &&
           now.background_factors == begun_.background_factors && frame_.analysis().displacements() == at_first_;
  }

 private:
  void load(CombinationId combination) {
    const PartLoads loads = part_loads(building_, combination);
    refuse_loads_that_are_not_built(building_, combination, loads, what_is_asked);
    frame_.load(loads);
    if (!frame_.solve().stable) throw UnstableModel(building_.file + ": the model is unstable before anything is lost");
    if (!frame_.settled()) throw UnstableModel(building_.file + ": " + no_displaced_rest + " before anything is lost");
  }

  static std::vector<MemberId> all_of(const LossRequest& request) {
    std::vector<MemberId> members = request.named;
    members.insert(members.end(), request.each.begin(), request.each.end());
    std::sort(members.begin(), members.end());
    members.erase(std::unique(members.begin(), members.end()), members.end());
    return members;
  }

  void keep_reference(Reference& reference) {
    reference_ = &reference;
    std::vector<JointId> holding;
    frame_.read_demands(reference.demand, holding);
    reference.displacements = frame_.analysis().displacements();
    reference.end_forces.clear();
    for (std::size_t m = 0; m < building_.members.size(); ++m)
      reference.end_forces.push_back(frame_.beam_end_forces(static_cast<int>(m)));
  }

  [[nodiscard]] LossState state_after(bool in_full) {
    LossState state;
    const solver::ReanalysisAnswer& answer = frame_.solve();
    if (!answer.stable) {
      report_mechanism(answer.mechanism, state);
      return state;
    }
    if (!frame_.settled()) {
      state.mechanism = no_displaced_rest;
      return state;
    }
    check_joints(in_full, state);
    if (in_full) record_state(state);
    return state;
  }

  /// R0 + f (R1 - R0).
  template <class Vector>
  [[nodiscard]] Vector sudden(const Vector& before, const Vector& after) const {
    return before + request_.sudden * (after - before);
  }

  /// From the state before the loss, as the frame that is left swings.
  void follow_motion(LossState& state) {
    MotionStart start;
    start.displacements = reference_->displacements;
    start.held_over = request_.motion.over;
    start.rest = frame_.analysis().displacements();
    frame_.read_demands(demand_, holding_);
    MotionResult motion = FrameMotion(whole_, divided_, frame_, state.combination, request_.motion).run(start);
    std::vector<JointId> of_whole(whole_.joints.size());
    for (const JointId joint : holding_)
      if (divided_.joint(joint).valid()) of_whole[index_of(divided_.joint(joint))] = joint;
    for (JointPeak& peak : motion.joints) {
      const std::size_t j = index_of(of_whole[index_of(peak.joint)]);
      peak.amplification = amplification(peak, reference_->demand[j], demand_[j]);
    }
    state.dynamic = std::move(motion);
  }

  /// Of the demand in the governing sense.
  [[nodiscard]] static std::optional<double> amplification(const JointPeak& peak, const Vec6& before,
                                                           const Vec6& after) {
    constexpr double least_change = 0.01;  // of the capacity
    const auto sense = static_cast<Eigen::Index>(peak.utilisation.sense);
    const Eigen::Index component = std::max<Eigen::Index>(0, sense - 1);  // tension and compression share one
    const double change = after(component) - before(component);
    if (std::abs(change) < least_change * peak.utilisation.capacity) return std::nullopt;
    return (peak.demand(component) - before(component)) / change;
  }

  void check_joints(bool in_full, LossState& state) {
    frame_.read_demands(demand_, holding_);
    for (const JointId joint : holding_) {
      const Vec6 felt = sudden(reference_->demand[index_of(joint)], demand_[index_of(joint)]);
      const Utilisation used = utilisation(building_[joint].capacity, felt);
      if (in_full) state.joints.emplace_back(divided_.joint(joint), used);
      if (state.worst.valid() && !(used.value > state.utilisation.value)) continue;
      state.worst = divided_.joint(joint);
      state.utilisation = used;
    }
  }

  void record_state(LossState& state) const {
    const std::vector<Vec6>& after = frame_.analysis().displacements();
    for (std::size_t n = 0; n < whole_.nodes.size(); ++n)
      state.displacements.push_back(sudden(reference_->displacements[n], after[n]));
    for (std::size_t m = 0; m < whole_.members.size(); ++m) {
      if (!frame_.stands(MemberId(m))) continue;
      const std::vector<MemberId>& pieces = divided_.pieces(MemberId(m));
      const auto of_piece = [&](MemberId piece) {
        return sudden(reference_->end_forces[index_of(piece)], frame_.beam_end_forces(piece.index));
      };
      solver::Vec12 forces = of_piece(pieces.front());
      if (pieces.size() > 1) forces.tail<6>() = of_piece(pieces.back()).tail<6>();
      state.end_forces.emplace_back(MemberId(m), forces);
    }
  }

  void report_mechanism(const solver::Mechanism& found, LossState& state) const {
    FrameMechanism named;
    for (const int node : found.nodes) named.nodes.emplace_back(static_cast<std::size_t>(node));
    named.motion = found.motion;
    for (const NodeId node : named.nodes)
      if (divided_.given(node)) state.motion.emplace_back(node, named.motion[index_of(node)]);
    for (const int beam : found.beams) {
      const MemberId member = divided_.member(MemberId(static_cast<std::size_t>(beam)));
      if (state.loose.empty() || state.loose.back() != member) state.loose.push_back(member);
    }
    state.mechanism = describe_motion(building_, named);
    if (!named.nodes.empty()) return;
    state.mechanism = "a member is released too far to hold itself";
    if (!state.loose.empty()) state.mechanism = "member " + building_[state.loose[0]].name + " can move by itself";
  }

  void sort() {
    const auto badness = [](const MemberLoss& loss) {
      double worst = 0;
      for (const LossState& state : loss.states)
        worst = std::max(worst, state.stands() ? state.utilisation.value : std::numeric_limits<double>::infinity());
      return worst;
    };
    std::stable_sort(result_.losses.begin(), result_.losses.end(),
                     [&](const MemberLoss& a, const MemberLoss& b) { return badness(a) > badness(b); });
  }

  const Building& whole_;
  DividedBuilding divided_;
  const Building& building_;  ///< the divided one
  const LossRequest& request_;
  std::vector<MemberId> members_;
  DamagedFrame frame_;
  std::map<CombinationId, Reference> references_;
  const Reference* reference_ = nullptr;  ///< of the present combination
  std::vector<Vec6> demand_;
  std::vector<JointId> holding_;
  LossResult result_;
  solver::ReanalysisCounters begun_;
  std::vector<Vec6> at_first_;  ///< displacements of the state that begin() made
};

}  // namespace

LossResult find_losses(const Building& building, const std::vector<CombinationId>& combinations,
                       const LossRequest& request, const solver::AnalysisOptions& options) {
  refuse_what_is_not_built(building, what_is_asked);
  return Losses(building, request, options).run(combinations);
}

struct LossSweep::State {
  const Building& building;
  std::vector<CombinationId> combinations;
  LossRequest request;
  solver::AnalysisOptions options;
  std::unique_ptr<Losses> losses;
  std::size_t factors = 0;

  void begin() {
    losses.reset();  // one factor at a time
    losses = std::make_unique<Losses>(building, request, options);
    losses->begin(combinations.front());
    ++factors;
  }
};

LossSweep::LossSweep(const Building& building, std::vector<CombinationId> combinations, LossRequest request,
                     const solver::AnalysisOptions& options)
    : state_(
          std::make_unique<State>(State{building, std::move(combinations), std::move(request), options, nullptr, 0})) {
  refuse_what_is_not_built(building, what_is_asked);
  if (state_->combinations.empty())
    for (std::size_t c = 0; c < building.combinations.size(); ++c) state_->combinations.emplace_back(c);
  state_->begin();
}

LossSweep::~LossSweep() = default;

MemberLoss LossSweep::lose(MemberId member) {
  if (!state_->losses->as_begun()) state_->begin();
  return state_->losses->one(member, state_->combinations);
}

std::size_t LossSweep::factors() const { return state_->factors; }

}  // namespace topple::structure
