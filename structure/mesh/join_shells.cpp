#include "topple/structure/join_shells.h"

#include <algorithm>
#include <optional>

#include "mesh/shell_edges.h"
#include "model/index_of.h"
#include "topple/structure/divide_member.h"
#include "topple/structure/error.h"
#include "topple/structure/frame.h"

namespace topple::structure {

namespace {

/// Of a member of a divided building: the one that it was a part of, and where its first end lies in that.
struct Origin {
  std::size_t member;
  double from = 0, share = 1;  ///< of the whole member's length
};

/// Fractions of a member's length with the node of the mesh there; none: on the line between the member's nodes.
using Places = std::map<double, std::optional<Vec3>>;

/// Divides every member at its places; `origin` tells of each member of the result what it was.
MemberCuts divide(Building& building, const std::vector<Places>& places, std::vector<Origin>& origin) {
  MemberCuts cuts;
  origin.clear();
  for (std::size_t m = 0; m < places.size(); ++m) origin.push_back({m});
  for (std::size_t m = 0; m < places.size(); ++m) {
    if (places[m].empty()) continue;
    const std::string name = building.members[m].name;
    const auto& nodes = building.members[m].nodes;
    const Vec3 first = building[nodes[0]].position, second = building[nodes[1]].position;
    std::vector<double> ascending;
    std::vector<Vec3> at;
    for (const auto& [place, node] : places[m]) {
      ascending.push_back(place);
      at.push_back(node.value_or(first + place * (second - first)));
    }
    const std::vector<JointId> joints = divide_member(building, MemberId(m), ascending, at);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      cuts[{name, ascending[i]}] = building[joints[i]].name;
      const double next = i + 1 < ascending.size() ? ascending[i + 1] : 1;
      origin.push_back({m, ascending[i], next - ascending[i]});
    }
    origin[m].share = ascending.front();
  }
  return cuts;
}

/// Adds where the frame's mesh divides members of the building as it is divided by now; false: nowhere.
bool add_places(const Building& divided, const Frame& frame, const std::vector<Origin>& origin,
                std::vector<Places>& places) {
  bool added = false;
  for (std::size_t m = 0; m < frame.pieces.size(); ++m) {
    const Member& member = divided.members[m];
    for (const MemberPiece& piece : frame.pieces[m]) {
      if (piece.start <= 0) continue;
      const Origin& own = origin[m];
      const int node = frame.model.beams[static_cast<std::size_t>(piece.beam)].node[0];
      places[own.member].emplace(own.from + piece.start / member.length * own.share,
                                 frame.model.nodes[static_cast<std::size_t>(node)]);
      added = true;
    }
  }
  return added;
}

/// Nodes of meshes that two panels share become nodes of the building; of those on a panel's edges, it is told.
void add_nodes_between_shells(Building& building, const Frame& frame) {
  const int given = static_cast<int>(building.nodes.size());
  std::map<int, std::set<std::size_t>> panels_at;  // per node of the frame
  for (std::size_t p = 0; p < building.panels.size(); ++p)
    for (const auto& edge : frame.meshes[p].edge_nodes)
      for (const int node : edge) panels_at[node].insert(p);
  std::map<int, NodeId> made;
  const NameIndex names(building);
  for (std::size_t p = 0; p < building.panels.size(); ++p)
    for (std::size_t edge = 0; edge < 4; ++edge) {
      std::vector<NodeId>& own = building.panels[p].edge_nodes[edge];
      own.clear();
      int count = 0;
      for (const int node : frame.meshes[p].edge_nodes[edge]) {
        const auto& corners = building.panels[p].nodes;
        if (std::find(corners.begin(), corners.end(), NodeId(static_cast<std::size_t>(node))) != corners.end())
          continue;
        ++count;
        if (node < given) {
          own.emplace_back(static_cast<std::size_t>(node));
          continue;
        }
        if (panels_at[node].size() < 2) continue;
        const auto [at, fresh] = made.try_emplace(node, building.nodes.size());
        if (fresh) {
          const std::string name =
              building.panels[p].name + ":" + std::to_string(edge + 1) + "/" + std::to_string(count);
          if (names.node(name))
            throw InputError(building.file + ": \"" + name + "\" is the name of a place on the edge of a shell; " +
                             "expected nodes of other names");
          building.nodes.push_back({name, frame.model.nodes[static_cast<std::size_t>(node)]});
        }
        own.push_back(at->second);
      }
    }
}

}  // namespace

MemberCuts join_shells(Building& building, const MemberPlaces& cuts) {
  const bool shells = std::any_of(building.panels.begin(), building.panels.end(),
                                  [](const Panel& panel) { return panel.model == PanelModel::shell; });
  std::vector<Places> places(building.members.size());
  for (std::size_t m = 0; m < places.size(); ++m)
    if (const auto given = cuts.find(building.members[m].name); given != cuts.end())
      for (const double place : given->second) places[m][place] = std::nullopt;
  Building divided = building;
  std::vector<Origin> origin;
  MemberCuts joints = divide(divided, places, origin);
  if (shells) {
    // A cut is a node of the mesh too, whose line goes on through the panel and may divide others: until none is new.
    while (true) {
      const Frame frame = make_frame(divided);
      if (!add_places(divided, frame, origin, places)) {
        add_nodes_between_shells(divided, frame);
        break;
      }
      divided = building;
      joints = divide(divided, places, origin);
    }
    const EdgeMembers edges(divided);
    for (std::size_t p = 0; p < divided.panels.size(); ++p)
      for (std::size_t edge = 0; edge < 4 && divided.panels[p].model == PanelModel::shell; ++edge)
        divided.panels[p].joined[edge] = !divided.panels[p].edge_nodes[edge].empty() ||
                                         !edges.of(PanelId(p), static_cast<int>(edge)).empty() ||
                                         borders_shell(divided, PanelId(p), static_cast<int>(edge));
  }
  building = std::move(divided);
  return joints;
}

}  // namespace topple::structure
