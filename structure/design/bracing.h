#pragma once
// What holds a member sideways, found from the model: the nodes that hold it, how far it goes on beyond them, what
// restrains its ends against rotation, and whether its storey is braced.
#include <array>
#include <map>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

/// A member with those of its own axis that it goes on in, from one node that holds it to the next.
struct HeldLength {
  double length = 0;                ///< of all of it, m
  std::array<NodeId, 2> nodes;      ///< its ends
  std::array<MemberId, 2> members;  ///< that lie at its ends
  bool own = true;                  ///< it is the member alone
  bool free_end = false;            ///< an end that nothing holds
};

/// Heights of a post's ends, in millimetres: posts between the same ones are a storey.
using StoreyLevels = std::pair<long, long>;
[[nodiscard]] StoreyLevels storey_levels(const Building& building, const Member& member);
/// Whether an end turns with its node about a global axis, by the weakest of the member's own axes that take part.
[[nodiscard]] bool turns_with(const Building& building, MemberId member, int end, const Vec3& about);

class Bracing {
 public:
  explicit Bracing(const Building& building);

  /// `direction`: in which the member would move sideways, its local y or z (1, 2).
  [[nodiscard]] HeldLength held_length(MemberId member, int direction) const;
  /// sum(E I/L) of columns over that of beams at an end of what buckles along `direction`; a support that turns counts
  /// as alignment_chart.h says.
  [[nodiscard]] double end_stiffness(const HeldLength& held, int end, int direction) const;
  /// The storey's braces and walls are at least four times as stiff against sidesway along `direction` as its posts
  /// bending: they take 80 % of it off (ENV 1993-1-1 5.2.5.3(2)).
  [[nodiscard]] bool braced(MemberId post, int direction) const;

 private:
  [[nodiscard]] Vec3 direction_of(MemberId member, int direction) const {
    return building_[member].axes.row(direction).transpose();
  }
  [[nodiscard]] bool holds(NodeId node, MemberId member, const Vec3& along) const;
  /// The member beyond the node in the same line, stiffly joined to it; not valid without one.
  [[nodiscard]] MemberId beyond(NodeId node, MemberId member, int direction) const;
  [[nodiscard]] bool supported(NodeId node, const Vec3& direction) const;
  void find_storeys();

  struct Storey {
    Eigen::Matrix2d braces = Eigen::Matrix2d::Zero(), posts = Eigen::Matrix2d::Zero();
  };
  const Building& building_;
  std::vector<std::vector<MemberId>> members_at_;  ///< per node
  std::vector<std::vector<PanelId>> panels_at_;    ///< stiff ones
  std::vector<int> support_of_, diaphragms_at_;    ///< per node: index of its support or -1; count
  std::map<StoreyLevels, Storey> storeys_;
};

}  // namespace topple::structure
