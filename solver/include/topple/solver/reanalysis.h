#pragma once
// A standing segment's analysis that takes changes and answers at the cost of the change. Nothing changed: nothing is
// computed. Loads changed: triangular solves only. Few joints broke: an exact low-rank (Woodbury) update of the base
// factor. More: a new factor. The choice is by operation counts with constants that ship.
// The class is a facade: its functions are a line or a check each, the parts in solver/reanalysis/ own the data.
// Functions that take a beam, shell, patch, support or node throw std::invalid_argument for one that does not exist,
// and for a stiffness, factor or node load that means nothing (below zero, not a number). solve() throws no
// Instability: a mechanism is an answer.
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "topple/solver/frame_model.h"
#include "topple/solver/static_analysis.h"
#include "topple/solver/utilisation_watch.h"

namespace topple::solver {

/// Counters of what was done and what was not.
struct ReanalysisCounters {
  std::uint64_t solves = 0;              ///< answers computed
  std::uint64_t unchanged = 0;           ///< answers given without computing
  std::uint64_t load_solves = 0;         ///< only loads had changed
  std::uint64_t low_rank = 0;            ///< answered by a low-rank correction
  std::uint64_t refactorisations = 0;    ///< new numeric factor on the same ordering
  std::uint64_t orderings = 0;           ///< new fill-reducing orders
  std::uint64_t background_factors = 0;  ///< new factors made on another thread while the old one served
  std::uint64_t late_factors = 0;        ///< of them: those that had to be waited for
  std::uint64_t selective = 0;           ///< answers that left out what could not matter
  std::uint64_t beams_visited = 0;       ///< by selective answers
  std::uint64_t beams_left = 0;          ///< left out by them
};

/// What a selective answer (selective back substitution) went through and left out.
struct SelectiveEffort {
  bool selective = false;       ///< false: the answer was full
  double visited_entries = 0;   ///< of the factor, by the backward solve
  double factor_entries = 0;    ///< of the whole factor
  int beams = 0;                ///< visited
  int shells = 0;               ///< visited
  double energy = 0;            ///< strain energy of the change (J)
  double energy_left_out = 0;   ///< of it in the parts left out, at most (J)
  double largest_left_out = 0;  ///< bound of the utilisations there
};

/// The answer's state; displacements and forces are asked of Reanalysis.
struct ReanalysisAnswer {
  bool stable = true;  ///< false: a mechanism
  /// When not stable: the motion; displacements are then those of the last stable answer.
  Mechanism mechanism;
  bool nearly_unstable = false;  ///< inside the warning band of AnalysisOptions
  SolveQuality quality;          ///< of the displacements
};

/// When a new factor is made on another thread while the old one serves. It is due at the first answer after the
/// answers since then took `share` of its predicted work: a number of answers fixed by counts, whatever the clock
/// says; if it is late, that answer waits. Then it catches up with what changed since it was begun, a part of it
/// beside each answer, and takes over. So the bits do not depend on how fast the other thread is.
struct RefreshRules {
  int columns = 120;                ///< begun when the correction has more than so many
  double least_operations = 1e9;    ///< and a new factor takes at least so many; smaller ones are made at once
  double share = 1.5;               ///< of the new factor's predicted work
  std::function<void()> on_worker;  ///< runs on the other thread before it begins (tests slow it down)
};

/// One segment's equations with all that changed since it was made.
class Reanalysis {
 public:
  /// Takes the model (all joints as in `beams[i].end_stiffness`); factorises on the first solve(). Nodes that nothing
  /// holds may be given; see drop_nodes().
  explicit Reanalysis(FrameModel model, const AnalysisOptions& options = {});
  ~Reanalysis();
  /// Moves: what is moved from may only be destroyed or assigned to.
  Reanalysis(Reanalysis&&) noexcept;
  /// Moves, as the constructor does.
  Reanalysis& operator=(Reanalysis&&) noexcept;

  // Changes: recorded, and take effect together in the next solve(). Each may be undone by setting the old value.
  /// Vec6::Zero() breaks the joint: the beam's whole load then hangs on its other end.
  void set_end_stiffness(int beam, int end, const Vec6& stiffness);
  /// The beam is no longer there (stiffness and its loads).
  void remove_beam(int beam);
  /// Undoes remove_beam().
  void restore_beam(int beam);
  /// The shell is no longer there: stiffness and loads go.
  void remove_shell(int shell);
  /// Undoes remove_shell().
  void restore_shell(int shell);
  /// Of a shell that stands, in the global freedoms of its four nodes.
  [[nodiscard]] Eigen::Matrix<double, 24, 24> shell_stiffness(int shell) const;
  /// From now on the shell has this stiffness, in the global freedoms of its four nodes (a superelement condensed to
  /// them): symmetric, positive semidefinite.
  void set_shell_stiffness(int shell, const Eigen::Matrix<double, 24, 24>& stiffness);
  /// The same for a patch, in the freedoms of its nodes. Zero takes it away.
  void set_patch_stiffness(int patch, Eigen::MatrixXd stiffness);
  /// As it was last set, in the global freedoms of the patch's nodes.
  [[nodiscard]] const Eigen::MatrixXd& patch_stiffness(int patch) const;
  /// Factor on the beam's E and G.
  void set_beam_stiffness_factor(int beam, double factor);
  /// Replaces the stiffness of the support at its index in FrameModel::supports (0: taken away).
  void set_support_stiffness(int support, const Vec6& stiffness);
  /// These nodes, and all beams and shells that reach them, belong to the segment no longer: no stiffness, no loads,
  /// zero displacement. What still stands keeps its factor.
  void drop_nodes(std::span<const int> nodes);
  /// Loads: the values replace what was there. Changing loads never touches the factor.
  void set_node_load(int node, const Vec6& load);
  /// Replaces the loads on a beam, local axes.
  void set_beam_loads(int beam, std::vector<BeamLoad> loads);

  /// Brings the answer up to date. A mechanism is an answer (stable == false), not an exception.
  [[nodiscard]] const ReanalysisAnswer& solve();

  /// The same, brought up to date only where the watch's uses may matter: no use that was not read anew lies above
  /// (1 - margin) max(1, the largest utilisation). Nothing else may be concluded about what was left out; its
  /// displacements or forces, when asked for, are found beside the answer, which stays as it is: asking changes no bit
  /// of what follows. The first call reads every utilisation, as does one that needs a full answer. Patches have none:
  /// with any it throws std::invalid_argument; call solve().
  [[nodiscard]] const ReanalysisAnswer& solve(UtilisationWatch& watch);
  /// Makes a selective answer whole, with the backward error of a full one; the watch reads the utilisations of what
  /// was left out.
  void complete(UtilisationWatch* watch = nullptr);
  /// To be called when capacities changed: the next solve(watch) reads everything again.
  void forget_utilisations();
  /// The same when only what uses are counted from changed: what they can grow by is still known.
  void forget_references();
  /// These beams will be removed one at a time, each restored before the next, with the loads as they are: the factor
  /// is gone through once for all of them (a dozen or two at a time serve best), and each answer then only checks, and
  /// refines if it must, what was found for it. No effect when anything is removed or broken now; whatever else
  /// changes in between is answered as without this call.
  void expect_losses(std::span<const int> beams);
  /// Replaces the rules for background factors.
  void set_refresh(RefreshRules rules);
  /// The utilisations that the last solve(watch) counts on were all read. False while the structure is in the warning
  /// band: its answers are full, and nothing is read.
  [[nodiscard]] bool uses_known() const;
  /// Of the last solve().
  [[nodiscard]] const SelectiveEffort& selective_effort() const;

  // The current answer.
  /// Per node, global axes: m and rad.
  [[nodiscard]] const std::vector<Vec6>& displacements() const;
  /// Displacements that hold at these nodes, and perhaps nowhere else: as much less work as the answer has left out.
  [[nodiscard]] const std::vector<Vec6>& displacements_at(std::span<const int> nodes) const;
  [[nodiscard]] Vec12 beam_end_forces(int beam) const;  ///< local, as in StaticSolution
  /// What the nodes do to the shell, per corner, global axes.
  [[nodiscard]] std::array<Vec6, 4> shell_corner_forces(int shell) const;
  [[nodiscard]] std::vector<Vec6> patch_forces(int patch) const;  ///< per node: what it does to the patch, global
  /// What the support at this index does to its node, global axes.
  [[nodiscard]] Vec6 reaction(int support) const;
  [[nodiscard]] double strain_energy() const;  ///< 1/2 f.u of what stands (with the loads as they are)

  /// Response of the structure as it stands (last solve()) to an extra load set alone, all other loads zero; beam loads
  /// included exactly. Used for compliances under contacts and for the direction of impact forces. One solve each.
  /// A moment on a node that nothing keeps from turning is left out: the node turns until it is none. Throws
  /// Instability when the structure does not stand.
  struct Response {
    std::vector<Vec6> displacements;               ///< per node, global axes
    std::vector<std::pair<int, Vec12>> fixed_end;  ///< of the beams that bear one of the loads, in order of the beam
    double backward_error = 0;                     ///< as SolveQuality's
  };
  /// The answer for one load set.
  [[nodiscard]] Response respond(const LoadSet& loads) const;
  /// The same for the nodes alone that lie on the elimination paths of those that bear the loads, these and both of
  /// every loaded beam's among them: a part of the work. Not refined, so that no backward error is told. `known` (per
  /// node): where the answer holds; zero elsewhere.
  [[nodiscard]] Response respond_near(const LoadSet& loads, std::vector<char>& known) const;
  /// Both for several load sets, the factor gone through once for all; `known` on the paths of all of them.
  [[nodiscard]] std::vector<Response> respond(std::span<const LoadSet> loads) const;
  /// The near answers for several load sets; `known` holds where every one of them does.
  [[nodiscard]] std::vector<Response> respond_near(std::span<const LoadSet> loads, std::vector<char>& known) const;
  /// Diagonal of a beam's stiffness as it stands (local axes, its joints included): what one freedom of an end meets
  /// while all others are held.
  [[nodiscard]] Vec12 beam_stiffness_diagonal(int beam) const;
  [[nodiscard]] Vec12 beam_end_forces(int beam, const Response& response) const;  ///< local
  /// Displacement of a point of a beam (local coordinate along it) under the given state: exact, from the end
  /// displacements and the beam's own flexibility under `own` (the loads on that beam that belong to the state).
  [[nodiscard]] Vec3 point_displacement(int beam, double distance, const std::vector<Vec6>& node_displacements,
                                        std::span<const BeamLoad> own) const;

  /// What was done since construction.
  [[nodiscard]] const ReanalysisCounters& counters() const;
  /// As it stands now, with all changes.
  [[nodiscard]] const FrameModel& model() const;
  /// Predicted operations of the last solve().
  [[nodiscard]] double last_operations() const;

  /// Writes all that later answers depend on, changes recorded since the last solve() included; nothing here changes. A
  /// factor under way in the background is not waited for. Bytes are for the same program alone.
  void save_state(std::ostream& to) const;
  /// Takes what was saved from one made with the same model and options, whatever this one has been through: both then
  /// answer alike, to the bit. RefreshRules::on_worker stays its own; what a watch has read is its owner's to keep.
  /// Throws std::runtime_error where bytes are missing; after that this may be destroyed only.
  void load_state(std::istream& from);

 private:
  friend class FrameDynamics;  // moves on the same equations: its matrix is K + s M, changed and factorised as here
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::solver
