#pragma once
// Which mass moves with each member and node of what stands: its own, and that of the panels that lie on it, as they
// hand their weight on.
#include <utility>
#include <vector>

#include "loads/frame_loads.h"
#include "model/index_of.h"

namespace topple::structure {

class MotionMasses {
 public:
  /// kg of a panel that go with what bears it.
  struct Shares {
    std::vector<std::pair<MemberId, double>> members;
    std::vector<std::pair<NodeId, double>> nodes;
  };

  /// All must outlive it.
  MotionMasses(const Building& building, const FrameLoads& loads, const PanelBearings& bearings);

  /// A panel that lies otherwise now.
  struct Rehung {
    PanelId panel;
    Shares before;
  };
  /// Takes over what panels hand on otherwise now. What they hand on without gravity stays as it was.
  std::vector<Rehung> update();
  [[nodiscard]] double of(MemberId member) const { return own(member) + hung_members_[index(member)]; }
  [[nodiscard]] double of(NodeId node) const { return loads_.mass(node) + hung_nodes_[index(node)]; }
  /// Without panels: its load in the combination over gravity, of a member without weight its material's.
  [[nodiscard]] double own(MemberId member) const;
  [[nodiscard]] const Shares& shares(PanelId panel) const { return shares_[index(panel)]; }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [building, loads, bearings, shares, version, hung_members, hung_nodes] = *this;
    archive(shares, version, hung_members, hung_nodes);
  }
  template <class Archive>
  friend void serialize(Archive& archive, Shares& shares) {
    auto& [members, nodes] = shares;
    archive(members, nodes);
  }

 private:
  template <class Tag>
  static std::size_t index(Id<Tag> id) {
    return index_of(id);
  }
  void hang(const Shares& shares, double sign);
  [[nodiscard]] Shares read(PanelId panel) const;

  const Building& building_;
  const FrameLoads& loads_;
  const PanelBearings& bearings_;
  std::vector<Shares> shares_;                     ///< per panel
  std::vector<int> version_;                       ///< of what the panel hands on, when it was read
  std::vector<double> hung_members_, hung_nodes_;  ///< kg
};

}  // namespace topple::structure
