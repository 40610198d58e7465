#pragma once
// Static analysis of a building: what `topple analyse` does, as a library call.
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "topple/solver/buckling.h"
#include "topple/solver/modes.h"
#include "topple/solver/second_order.h"
#include "topple/solver/static_analysis.h"
#include "topple/structure/building.h"
#include "topple/structure/design_check.h"
#include "topple/structure/error.h"
#include "topple/structure/joint_check.h"
#include "topple/structure/losses.h"

namespace topple::structure {

/// A plane through the structure, and what counts of all that it passes.
struct SectionCut {
  std::string name;               ///< the key in the cuts file
  Vec3 at = Vec3::Zero();         ///< a point of the plane; moments are about it
  Mat3 axes = Mat3::Identity();   ///< rows: the plane's normal, along, across; right-handed
  bool everything = true;         ///< else these members and panels alone
  std::vector<MemberId> members;  ///< ascending
  std::vector<PanelId> panels;    ///< ascending
};
/// What the part of the structure that the normal looks to does to the part behind the plane, so that tension is
/// positive: normal force, shears along and across, torsion, moments about along and across, in the cut's axes about
/// its point. Each part is cut as a free body: the forces of its nodes behind the plane, and the loads on what of it
/// lies behind, exactly. So the cut through everything balances all loads and reactions behind it, to rounding. What
/// lies in the plane counts as behind it.
struct CutResult {
  Vec6 force = Vec6::Zero();                             ///< N and N m, in the cut's axes
  std::vector<std::pair<MemberId, Vec6>> members;        ///< what each of them has of it
  std::vector<std::pair<PanelId, Vec6>> panels;          ///< likewise
  std::vector<std::pair<std::size_t, Vec6>> diaphragms;  ///< likewise, by index in Building::diaphragms
};

/// What is to be computed. Each part that is left at its default costs nothing.
struct AnalysisRequest {
  std::vector<CombinationId> combinations;  ///< empty: all
  int stations = 0;  ///< even intervals along each member at which internal forces are told; 0: extremes alone
  bool critical_sections = false;  ///< asked for by design checks
  solver::AnalysisOptions solver;  ///< threads, factorisation and limits
  solver::SecondOrder second_order =
      solver::SecondOrder::none;            ///< whether and how axial forces act on the displaced structure
  int buckling = 0;                         ///< lowest factors to find for each combination
  std::vector<SectionCut> cuts;             ///< planes whose resultants are wanted
  LossRequest losses;                       ///< members to remove, one at a time
  std::optional<TimeHistory> time_history;  ///< followed as losses.motion says, from the state of each combination
  int modes = 0;   ///< lowest natural frequencies; with second order about the tangent of the last combination
  int divide = 1;  ///< in the modes: elements of every member that is one otherwise and carries both signs
  solver::MassDistribution mass = solver::MassDistribution::consistent;  ///< of members and panels, in the modes
  solver::TorsionalMass torsional_mass = solver::TorsionalMass::polar;   ///< of members, in the modes
  bool rotary_inertia = false;  ///< of members' sections in bending, in the modes
  /// Told what is done, and how far it is (0 to 1; below 0 where nothing can tell).
  std::function<void(std::string_view stage, double share)> progress;
  /// Threads that recover and write combinations side by side; 0: one for each processor. Changes no number.
  int workers = 0;
};

/// [value, distance from the first end]
struct Extreme {
  double value = 0;  ///< of the quantity
  double at = 0;     ///< distance from the first end, m
};
/// Internal forces and deflections along a member, in the order axial, shear_y, shear_z, torsion, moment_y, moment_z,
/// deflection_y, deflection_z.
inline constexpr std::array<const char*, 8> diagram_names{"axial",    "shear_y",  "shear_z",      "torsion",
                                                          "moment_y", "moment_z", "deflection_y", "deflection_z"};
/// One member under one combination, SI, member axes. Quantities are in the order of diagram_names.
struct MemberResult {
  solver::Vec12 end_forces = solver::Vec12::Zero();  ///< what the nodes do to the member, first end then second
  std::array<Extreme, 8> min;                        ///< most negative of each quantity
  std::array<Extreme, 8> max;                        ///< most positive of each
  std::vector<std::array<double, 8>> stations;       ///< AnalysisRequest::stations + 1 of them, from the first end
  /// Where asked for: on both sides of every place between the ends where a load begins, ends or acts, and where an
  /// internal force is at its extreme.
  std::vector<std::array<double, 8>> critical;
  std::vector<double> critical_at;  ///< distances of these from the first end
  bool active = true;               ///< false: a tie or strut that carries nothing under this combination
};
/// One element of a shell panel's mesh: stress resultants per length at its centre, in the panel's axes.
struct PanelElement {
  std::array<int, 4> nodes{};        ///< of the building, and beyond those of AnalysisResult::mesh_nodes
  std::array<double, 3> membrane{};  ///< N/m: xx, yy, xy
  std::array<double, 3> moments{};   ///< N m/m: xx, yy, xy
  std::array<double, 2> shears{};    ///< N/m: xz, yz
};
/// At a node of a shell panel's mesh: resultants recovered from those of the elements round it (linear fields over
/// patches of elements), in the panel's axes. Panels that share the node have their own each.
struct PanelNode {
  int node = -1;                     ///< as PanelElement's
  std::array<double, 3> membrane{};  ///< as PanelElement's
  std::array<double, 3> moments{};   ///< as PanelElement's
  std::array<double, 2> shears{};    ///< as PanelElement's
};
/// One panel under one combination.
struct PanelResult {
  std::array<double, 3> membrane{};     ///< mean over the panel, as PanelElement's
  std::array<double, 3> moments{};      ///< mean over the panel
  std::array<double, 2> shears{};       ///< mean over the panel
  std::array<Vec6, 4> corner_forces{};  ///< what the nodes do to the panel, per corner, global axes
  std::vector<PanelElement> elements;   ///< of a shell panel
  std::vector<PanelNode> nodes;         ///< of a shell panel's mesh, in order of their numbers
  /// Of a shell panel: estimated error of its mesh, in the energy norm, relative to the structure's shells together.
  double discretisation_error = 0;
};
/// One storey under one combination.
struct StoreyResult {
  double drift = 0;  ///< largest horizontal displacement of a post's top against its bottom, over its height
  std::array<double, 2> shear{};  ///< N, along x and y
};
/// Where something moves most: a node, a place along a member, or a node of a shell's mesh.
struct LargestDisplacement {
  double value = 0;           ///< its size, m
  Vec3 moved = Vec3::Zero();  ///< the displacement, global axes, m
  NodeId node;                ///< valid for a node ...
  MemberId member;            ///< ... or for a member, at this distance from its first end ...
  double at = 0;              ///< m
  int mesh_node = -1;         ///< ... or an entry of AnalysisResult::mesh_nodes
};
/// All answers under one combination, SI.
struct CombinationResult {
  CombinationId combination;             ///< the one that is meant
  std::vector<Vec6> displacements;       ///< per node
  std::vector<Vec6> mesh_displacements;  ///< per AnalysisResult::mesh_nodes
  std::vector<Vec6> reactions;           ///< per Building::supports
  std::vector<Vec6> edge_reactions;      ///< per Building::edge_supports; moments about the middle of the edge
  std::vector<MemberResult> members;     ///< per member
  std::vector<PanelResult> panels;       ///< per panel
  std::vector<Utilisation> joints;       ///< per Building::joints; value 0 where it has no capacity
  std::vector<StoreyResult> storeys;     ///< from the lowest up
  std::vector<CutResult> cuts;           ///< per AnalysisResult::cuts
  std::vector<DesignResult> designs;     ///< per member, empty without a design check; no `governing`: not checked
  Vec6 total_load = Vec6::Zero();        ///< all loads, about the model's centroid, N and N m
  Vec6 total_reaction = Vec6::Zero();    ///< about the model's centroid
  LargestDisplacement largest;           ///< over nodes, members and meshes
  /// Estimated error of the shells' meshes: energy norm of the error of stresses over that of the stresses (Zienkiewicz
  /// and Zhu). That of deflections is smaller, about its square or less. 0 without shells.
  double discretisation_error = 0;
  double equilibrium_error = 0;                ///< of total_load plus total_reaction, relative
  int second_order_iterations = 0;             ///< 0 in a first-order analysis
  std::vector<solver::BucklingMode> buckling;  ///< lowest first; fewer than asked for when there are no more
  solver::SolveQuality quality;                ///< how far to trust the displacements
};
/// What analyse() returns.
struct AnalysisResult {
  std::vector<CombinationResult> combinations;                  ///< in the order of the request
  std::vector<Vec3> mesh_nodes;                                 ///< of shell panels, beside the building's nodes
  std::vector<SectionCut> cuts;                                 ///< AnalysisRequest::cuts
  LossResult losses;                                            ///< of AnalysisRequest::losses
  double loss_seconds = 0;                                      ///< wall time that the losses took
  std::vector<std::pair<CombinationId, MotionResult>> motions;  ///< under the time history
  std::vector<solver::VibrationMode> modes;  ///< lowest first; fewer than asked for when the mass has no more
  /// Where AnalysisRequest::divide is above 1: of each member that the modes divide its inner nodes, evenly along it
  /// from the first end, by their index in the modes' shapes, behind all others. Else empty.
  std::vector<std::vector<int>> mode_cuts;
  Vec3 moving_mass = Vec3::Zero();        ///< along x, y, z: what takes part in the modes
  solver::AnalysisStatistics statistics;  ///< sizes and times of the factorisation
  std::vector<std::string> warnings;      ///< sentences for a person
  std::vector<std::string> unfinished;    ///< what was asked for and not computed, and why
  std::optional<DesignCode> design_code;  ///< set by check_design() (member_checks.h)
  double drift_limit = 0;                 ///< with it: storey drift that counts as a use of 1
};

/// What moves when a model is not stable, for reports and drawings.
struct Diagnosis {
  std::string message;        ///< what() of the exception
  CombinationId combination;  ///< the first one analysed, where the loads have no part in it
  const char* kind = "";      ///< "mechanism": moves without strain; "buckling": the loads are beyond the critical ones
  std::vector<NodeId> nodes;  ///< that move, most first
  std::vector<MemberId> members;  ///< that move
  std::vector<Vec6> shape;  ///< per node; largest translation 1, all zero when a member moves between nodes at rest
};
/// Thrown for a model that is not stable under a combination.
class UnstableAnalysis : public UnstableModel {
 public:
  /// The message becomes what().
  explicit UnstableAnalysis(Diagnosis found) : UnstableModel(found.message), diagnosis(std::move(found)) {}
  Diagnosis diagnosis;  ///< what moves
  /// What was computed before, where that was something: its `unfinished` says what is missing.
  std::shared_ptr<AnalysisResult> partial;
};

/// Cuts from a JSON file ({"cuts": {NAME: {"at", "normal", "along", "parts"}}}, docs/results-format.md), in the
/// model's length. Throws InputError.
[[nodiscard]] std::vector<SectionCut> read_section_cuts(const std::string& path, const Building& building);

/// Throws UnstableAnalysis, with names: a model that can move without strain, or loads beyond what it bears before it
/// buckles (second order), with the critical factor.
[[nodiscard]] AnalysisResult analyse(const Building& building, const AnalysisRequest& request = {});

/// How the building moves from its state under each combination, as AnalysisRequest::time_history asks. Throws
/// InputError for what losses do not go with either.
[[nodiscard]] std::vector<std::pair<CombinationId, MotionResult>> find_motions(
    const Building& building, const std::vector<CombinationId>& combinations, const TimeHistory& history,
    const MotionRequest& request, const solver::AnalysisOptions& options);

/// results.json as the format has it, in the model's units, every number to its last bit. The result may hold a whole
/// multiple of the stations that `request` asks for.
[[nodiscard]] std::string results_json(const Building& building, const AnalysisRequest& request,
                                       const AnalysisResult& result, const std::map<std::string, double>& seconds);
/// The same, handed to `sink` in pieces as it is made.
void write_results_json(const Building& building, const AnalysisRequest& request, const AnalysisResult& result,
                        const std::map<std::string, double>& seconds,
                        const std::function<void(std::string_view)>& sink);
/// results.json of a model that is not stable: the header and the one key `diagnosis`.
[[nodiscard]] std::string diagnosis_json(const Building& building, const AnalysisRequest& request,
                                         const Diagnosis& diagnosis);
/// Files by name and text.
using NamedTexts = std::vector<std::pair<std::string, std::string>>;
/// displacements.csv, reactions.csv, members.csv, joints.csv, panels.csv, with cuts cuts.csv: a header line with units,
/// one row for each combination and part, numbers to their last bit in the model's units.
[[nodiscard]] NamedTexts results_csv(const Building& building, const AnalysisResult& result);
/// history-MEMBER.csv for each loss that was followed through time, and history-time-history.csv: the nodes and joints
/// that request.losses.motion names, a row for each substep.
[[nodiscard]] NamedTexts motion_csv(const Building& building, const AnalysisRequest& request,
                                    const AnalysisResult& result);
/// Stations along each member that a drawing goes through: ask for at least this many before results_vtu().
inline constexpr int drawing_stations = 10;
/// COMBINATION.vtu for ParaView, in the model's units: members as lines through their stations, panels as
/// quadrilaterals; displacement (warp by it for the deformed shape), shapes of the modes and of buckling, and internal
/// forces at points, utilisation of the joints on cells. Throws std::invalid_argument when the result has no stations.
[[nodiscard]] NamedTexts results_vtu(const Building& building, const AnalysisResult& result);
/// The motion as a drawing, members straight.
[[nodiscard]] NamedTexts diagnosis_vtu(const Building& building, const Diagnosis& diagnosis);
/// The summary a person reads.
[[nodiscard]] std::string summary_text(const Building& building, const AnalysisResult& result,
                                       const std::map<std::string, double>& seconds);

}  // namespace topple::structure
