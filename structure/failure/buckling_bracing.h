#pragma once
// Loss of bracing by buckling: which post of a standing component gives way sideways under what it bears.
//
// Three sieves, the finest last:
//   1. a post's compression against a lower bound of what it can bear, pi2 E I/(2 Lu)2, Lu the length over which
//   nothing
//      braces it: below `tested_share` of it nothing is looked at, nor while no post bears more than when it was tested
//      last;
//   2. the second-order iteration over the standing elastic factor, K u' = -Kg(N) u: its Rayleigh quotient comes to the
//      inverse of the buckling factor from below;
//   3. the full tangent (solver::buckling_modes: exact members, counted eigenvalues) decides, and gives the shape.
// The post that the critical shape bends most gives way where it does so (solver/buckling_bend.h): at an end, or
// inside.
#include <array>
#include <map>
#include <optional>
#include <vector>

#include "failure/segmentation.h"
#include "standing/statics/frame_statics.h"
#include "topple/solver/buckling.h"
#include "topple/solver/buckling_bend.h"

namespace topple::structure {

class PanelBearings;

struct BuckledPost {
  MemberId post;                         ///< invalid when none is compressed
  JointId joint;                         ///< where it bends most; invalid when that is inside
  double inside = 0;                     ///< of its length from the first end: where it bends most then
  double factor = 0;                     ///< by which the loads would have to be smaller: below 1
  double compression = 0, bearable = 0;  ///< N; `bearable`: compression times factor
  Vec3 bulge = Vec3::Zero();             ///< where the critical shape moves it most, undeformed
};
template <class Archive>
void serialize(Archive& archive, BuckledPost& buckled) {
  auto& [post, joint, inside, factor, compression, bearable, bulge] = buckled;
  archive(post, joint, inside, factor, compression, bearable, bulge);
}

class BucklingBracing {
 public:
  BucklingBracing(const Building& building, const FrameStatics& statics, const Segmentation& segments,
                  const PanelBearings& bearings, const std::vector<std::vector<solver::BeamLoad>>& applied,
                  const std::vector<Vec6>& node_applied, const std::vector<char>& node_solved);

  /// Of the state solved last. Nothing: the component is stable. `certain`: the tangent is asked in any case.
  [[nodiscard]] std::optional<BuckledPost> find(int component, bool certain = false);

  struct Counters {
    int screened = 0, iterated = 0, judged = 0;  ///< components that each sieve was asked about
  };
  [[nodiscard]] const Counters& counters() const { return counters_; }

  /// Length over which nothing braces the post sideways.
  [[nodiscard]] double unbraced_length(MemberId post) const;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [building, statics, segments, bearings, applied, node_applied, node_solved, members_at, plates_at, supported,
           tested, counters] = *this;
    archive(tested, counters);  // what meets at nodes follows from the building
  }
  template <class Archive>
  friend void serialize(Archive& archive, Counters& asked) {
    auto& [screened, iterated, judged] = asked;
    archive(screened, iterated, judged);
  }

 private:
  [[nodiscard]] bool braced(NodeId node) const;
  [[nodiscard]] bool suspicious(int component);
  /// The second-order iteration over the elastic factor, under way.
  struct Iteration {
    FrameStatics::ResponseLoads loads;
    double quotient = 0;
    int steps = 0;
  };
  [[nodiscard]] Iteration begin(int component) const;
  [[nodiscard]] bool iterate(int component, Iteration& iteration) const;
  [[nodiscard]] double quotient(int component) const;
  [[nodiscard]] bool buckles_inside(int component) const;
  [[nodiscard]] std::optional<BuckledPost> judge(int component) const;
  /// What stands of a component, its nodes numbered anew; `members`: those of its beams.
  struct Standing {
    solver::FrameModel model;
    solver::LoadSet loads;
    std::vector<int> number;  ///< per node of the building; -1: it is not there
    std::vector<MemberId> members;
  };
  [[nodiscard]] Standing what_stands(int component) const;
  void add_members(int component, Standing& standing) const;
  void add_panels(int component, Standing& standing) const;
  /// A compressed post in the critical shape.
  struct Bent {
    MemberId post;
    double compression = 0;
    std::array<Vec6, 2> motion{};  ///< of its nodes
    bool rests = false;            ///< they do not move
    double share = 0;              ///< of what it bears between nodes that rest
    solver::BucklingBend bend;
  };
  [[nodiscard]] std::vector<Bent> bent_posts(const Standing& standing, const solver::BucklingMode& mode) const;
  [[nodiscard]] static std::vector<Bent> most_bent(std::vector<Bent> bent);
  [[nodiscard]] BuckledPost give_way(const std::vector<Bent>& bent, double factor) const;

  const Building& building_;
  const FrameStatics& statics_;
  const Segmentation& segments_;
  const PanelBearings& bearings_;
  const std::vector<std::vector<solver::BeamLoad>>& applied_;
  const std::vector<Vec6>& node_applied_;
  const std::vector<char>& node_solved_;
  std::vector<std::vector<MemberId>> members_at_;  ///< per node
  std::vector<std::vector<PanelId>> plates_at_;
  std::vector<char> supported_;  ///< per node
  std::vector<double> tested_;   ///< per member: utilisation of the lower bound when it was tested last
  Counters counters_;
};

}  // namespace topple::structure
