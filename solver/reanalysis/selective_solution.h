#pragma once
// Selective back substitution: answers that are brought up to date only where they may matter. The change of an answer
// obeys L' du = y with y nonzero on the elimination paths of what changed alone, so that a subtree of the elimination
// tree away from these paths follows its separator: du inside is L^-T (-L_sep' du_sep), at any later time. It is left
// out as long as no utilisation (demand over capacity) inside can matter.
//
// What the change can do there is bounded by strain energy. With r the residual that the change left, the energy of
// the whole change is r.du / 2 (r lives on a few rows), every element's is positive, and those of all elements that
// were visited are known: what is left out holds at most the rest (the sum of du_sep' S du_sep / 2 over the subtrees
// left out). An element of stiffness K takes energy E only with end forces |dF_i| <= sqrt(2 E K_ii) (Cauchy and
// Schwarz in the energy norm); over several changes these add up.
#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "assembly/frame_system.h"
#include "elements/beam_strain_forces.h"
#include "factor/triangular.h"
#include "reanalysis/block_contents.h"
#include "topple/solver/utilisation_watch.h"

namespace topple::solver {

class SelectiveSolution {
 public:
  using BeamStiffness = std::function<const BeamStrainForces&(int beam)>;
  /// `solver` holds the factor of the system's matrix at some time; both must outlive this. The answer is whole.
  SelectiveSolution(const FrameSystem& system, const TriangularSolver& solver, BeamStiffness stiffness);

  /// Replaces the factor by another one of the same pattern. Known utilisations stay. The answer must be whole. Returns
  /// false, and changes nothing, when its blocks are others.
  [[nodiscard]] bool set_factor(const TriangularSolver& solver);

  /// The answer: scaled, in the matrix's order, and what is read from it.
  struct Answer {
    Eigen::VectorXd& solution;
    std::vector<Vec6>& displacements;
  };

  /// Brings everything up to date, and reads every use that was only bounded. With a null `watch` none is read.
  void complete(Answer answer, UtilisationWatch* watch);
  /// Reads every use; the answer must be whole.
  void read_all(UtilisationWatch& watch);
  [[nodiscard]] bool uses_known() const { return uses_known_; }
  void forget_utilisations() { uses_known_ = false; }
  /// To be called when elements may be stiffer than before, so that their uses can grow faster.
  void forget_growths() { uses_known_ = growths_known_ = false; }
  /// How many numbers a copy of this holds.
  [[nodiscard]] std::size_t size() const { return behind_.size(); }
  /// True when some displacements are not up to date.
  [[nodiscard]] bool partial() const { return partial_; }
  /// True when utilisations of elements that are up to date were not read.
  [[nodiscard]] bool unread() const { return any_unread_; }
  [[nodiscard]] bool beam_is_current(int beam) const { return is_current(contents_.block_of_beam(beam)); }
  [[nodiscard]] bool node_is_current(int node) const { return is_current(contents_.block_of_node(node)); }
  [[nodiscard]] bool shell_is_current(int shell) const { return is_current(contents_.block_of_shell(shell)); }

  /// Prepares a change at these rows (of the matrix): they, all rows that share an element with them, and their
  /// ancestors are brought up to date. Returns the blocks on their paths.
  const std::vector<char>& begin(std::span<const int> rows, Answer answer);
  /// Carries a change through, as far as the watch needs it: y (in elimination order) was made from `residual`, which
  /// is nonzero in the rows of begin() alone.
  void advance(std::span<const int> rows, const Eigen::VectorXd& residual, const Eigen::VectorXd& y,
               UtilisationWatch& watch, Answer answer);

  struct Effort {
    double entries = 0;  ///< of the factor that the backward solve went through
    int beams = 0, shells = 0;
    double energy = 0;    ///< of the change, in all (J)
    double left_out = 0;  ///< the bound of what is in the parts left out (J)
    template <class Archive>
    void serialize(Archive& archive) {
      auto& [of_factor, of_beams, of_shells, of_change, at_most] = *this;
      archive(of_factor, of_beams, of_shells, of_change, at_most);
    }
  };
  /// Of the last advance().
  [[nodiscard]] const Effort& effort() const { return effort_; }
  /// Upper bound of the utilisations of all elements that are not up to date.
  [[nodiscard]] double bound_left_out() const { return bound_left_out_; }

  template <class Archive>
  void serialize(Archive& archive) {
    // System, factor and what lies in its blocks are those it was made with; `now` is the change under way.
    auto& [system, solver, contents, older, unread, below_start, behind, own_use, bound, growth, slack, waiting, now,
           beam_stiffness, partial, any_unread, uses_known, growths_known, bound_left_out, effort] = *this;
    archive(older, unread, behind, own_use, bound, growth, slack, waiting, partial, any_unread, uses_known,
            growths_known, bound_left_out, effort);
  }

 private:
  [[nodiscard]] bool is_current(int block) const;
  void reach_neighbours(std::span<const int> rows);
  void bring_older(int block, Answer answer);
  void step_now(int block, const Eigen::VectorXd& y, Answer answer);
  void add_to_solution(int block, Answer answer);
  void read_nodes(int block, Answer answer) const;
  void read_utilisations(int block, UtilisationWatch& watch);
  [[nodiscard]] double twice_energy_of_elements(int block) const;
  void update_bound(int block);
  void note(double use);
  void read_growths(UtilisationWatch& watch);
  void read_unread(UtilisationWatch& watch);
  void descend(const Eigen::VectorXd& y, UtilisationWatch& watch, Answer answer);
  void leave_out(int block);
  void finish(const Eigen::VectorXd& y);
  [[nodiscard]] double energy_left_out() const;
  [[nodiscard]] Vec6 node_change(int node) const;
  [[nodiscard]] double twice_energy_of_beam(int beam) const;
  [[nodiscard]] double twice_energy_of_shell(int shell) const;

  const FrameSystem& system_;
  const TriangularSolver* solver_;
  BlockContents contents_;
  // Per block.
  std::vector<char> older_;   ///< it is behind by what `behind_` and `waiting_` hold
  std::vector<char> unread_;  ///< its utilisations are bounds
  std::vector<std::int64_t> below_start_;
  std::vector<double> behind_;  ///< change of the rows below the block since it was visited
  std::vector<double> own_use_;
  std::vector<double> bound_, growth_;  ///< of the whole subtree: of its utilisations; most growth
  std::vector<double> slack_;           ///< sqrt(2 energy) that the subtree may have taken since it was visited
  Eigen::VectorXd waiting_;             ///< y of blocks that are behind
  /// The change under way.
  struct Change {
    Eigen::VectorXd du;    ///< where visited
    Eigen::VectorXd past;  ///< scratch: older changes on one block's rows
    std::vector<char> path, visited;
    std::vector<int> visits, open, left_out, near_rows, elements;
    std::vector<double> below;
    double remaining = 0;  ///< twice the energy that it may have left in what was not visited
    double worst = 0;
  } now_;
  BeamStiffness beam_stiffness_;
  bool partial_ = false, any_unread_ = false, uses_known_ = false, growths_known_ = false;
  double bound_left_out_ = 0;
  Effort effort_;
};

}  // namespace topple::solver
