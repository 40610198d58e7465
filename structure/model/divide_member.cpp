#include "topple/structure/divide_member.h"

#include <algorithm>
#include <stdexcept>

#include "model/index_of.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

void refuse_taken(const Building& building, const std::string& name) {
  const auto has = [&](const auto& things) {
    return std::any_of(things.begin(), things.end(), [&](const auto& thing) { return thing.name == name; });
  };
  if (has(building.nodes) || has(building.members))
    throw InputError(building.file + ": \"" + name + "\" is the name of a place where a member is cut; " +
                     "expected nodes and members of other names");
}

/// The part of a load that lies between two distances; none when it lies outside.
std::vector<MemberLoad> on_piece(const MemberLoad& load, double begin, double end, bool last) {
  MemberLoad own = load;
  if (load.kind == MemberLoad::Kind::temperature) return {own};
  if (load.kind == MemberLoad::Kind::point) {
    if (load.from < begin || load.from > end || (load.from == end && !last)) return {};
    own.from = load.from - begin;
    return {own};
  }
  const double from = std::max(load.from, begin), to = std::min(load.to, end);
  if (!(to > from)) return {};
  const auto at = [&](double x) -> Vec6 {
    return load.first + (x - load.from) / (load.to - load.from) * (load.last - load.first);
  };
  own.first = at(from);
  own.last = at(to);
  own.from = from - begin;
  own.to = to - begin;
  return {own};
}

class Division {
 public:
  Division(Building& building, MemberId id, const std::vector<double>& places, const std::vector<Vec3>& at)
      : building_(building), id_(id), whole_(building[id]), places_{0}, at_(at) {
    places_.insert(places_.end(), places.begin(), places.end());
    places_.push_back(1);
    for (std::size_t i = 0; i + 1 < places_.size(); ++i)
      if (!(places_[i] < places_[i + 1]))
        throw std::invalid_argument("a member is divided at ascending fractions above 0 and below 1");
  }

  /// At nodes that are there.
  void use_nodes(std::vector<NodeId> nodes) { given_ = std::move(nodes); }

  std::vector<JointId> carry_out() {
    add_nodes();
    add_pieces();
    split_loads();
    split_masses();
    std::vector<JointId> cuts;
    for (std::size_t i = 0; i + 1 < pieces_.size(); ++i) cuts.push_back(building_.joint(pieces_[i], 1));
    return cuts;
  }

 private:
  [[nodiscard]] std::string cut_name(std::size_t i) const { return whole_.name + "/cut-" + std::to_string(i); }

  /// Unless they are given, on the line between the member's nodes, so that edges of panels find the pieces between
  /// their corners.
  void add_nodes() {
    const Vec3 first = building_[whole_.nodes[0]].position, second = building_[whole_.nodes[1]].position;
    nodes_.push_back(whole_.nodes[0]);
    for (std::size_t i = 1; i + 1 < places_.size(); ++i) {
      if (!given_.empty()) {
        nodes_.push_back(given_[i - 1]);
        continue;
      }
      refuse_taken(building_, cut_name(i));
      nodes_.emplace_back(building_.nodes.size());
      building_.nodes.push_back({cut_name(i), at_.empty() ? first + places_[i] * (second - first) : at_[i - 1]});
    }
    nodes_.push_back(whole_.nodes[1]);
  }

  [[nodiscard]] Vec3 on_axis(double place) const {
    const Vec3 start = building_[whole_.nodes[0]].position + whole_.offsets[0];
    const Vec3 end = building_[whole_.nodes[1]].position + whole_.offsets[1];
    return start + place * (end - start);
  }

  void add_pieces() {
    const Joint first = building_[building_.joint(id_, 0)], second = building_[building_.joint(id_, 1)];
    std::vector<Joint> added;
    for (std::size_t i = 0; i + 1 < places_.size(); ++i) {
      const MemberId id = i == 0 ? id_ : MemberId(building_.members.size());
      Member piece = whole_;
      piece.nodes = {nodes_[i], nodes_[i + 1]};
      piece.offsets = {on_axis(places_[i]) - building_[nodes_[i]].position,
                       on_axis(places_[i + 1]) - building_[nodes_[i + 1]].position};
      piece.length = (places_[i + 1] - places_[i]) * whole_.length;
      if (i > 0) {
        piece.name = whole_.name + "/" + std::to_string(i + 1);
        refuse_taken(building_, piece.name);
      }
      std::array<Joint, 2> joints{first, second};
      if (i > 0) joints[0] = rigid(cut_name(i) + ":2");
      if (i + 2 < places_.size()) joints[1] = rigid(cut_name(i + 1) + ":1");
      for (int end = 0; end < 2; ++end) {
        Joint& joint = joints[static_cast<std::size_t>(end)];
        joint.member = id;
        joint.end = end;
        if (i == 0)
          building_.joints[index_of(building_.joint(id_, end))] = joint;
        else
          added.push_back(joint);
      }
      if (i == 0)
        building_.members[index_of(id_)] = piece;
      else
        building_.members.push_back(piece);
      pieces_.push_back(id);
    }
    const auto panels = building_.joints.end() - static_cast<std::ptrdiff_t>(4 * building_.panels.size());
    building_.joints.insert(panels, added.begin(), added.end());
  }

  static Joint rigid(std::string name) {
    Joint joint;
    joint.name = std::move(name);
    return joint;
  }

  void split_loads() {
    for (LoadCase& load_case : building_.cases) {
      std::vector<MemberLoad> loads;
      for (const MemberLoad& load : load_case.members) {
        if (load.member != id_) {
          loads.push_back(load);
          continue;
        }
        for (std::size_t i = 0; i < pieces_.size(); ++i)
          for (MemberLoad own :
               on_piece(load, places_[i] * whole_.length, places_[i + 1] * whole_.length, i + 1 == pieces_.size())) {
            own.member = pieces_[i];
            loads.push_back(own);
          }
      }
      load_case.members = std::move(loads);
    }
  }

  void split_masses() {
    std::vector<std::pair<MemberId, double>> masses;
    for (const auto& [member, mass] : building_.masses.members) {
      if (member != id_) {
        masses.emplace_back(member, mass);
        continue;
      }
      for (std::size_t i = 0; i < pieces_.size(); ++i)
        masses.emplace_back(pieces_[i], (places_[i + 1] - places_[i]) * mass);
    }
    building_.masses.members = std::move(masses);
  }

  Building& building_;
  MemberId id_;
  Member whole_;
  std::vector<double> places_;
  std::vector<Vec3> at_;
  std::vector<NodeId> nodes_, given_;
  std::vector<MemberId> pieces_;
};

}  // namespace

std::vector<JointId> divide_member(Building& building, MemberId member, const std::vector<double>& places,
                                   const std::vector<Vec3>& nodes) {
  if (!nodes.empty() && nodes.size() != places.size())
    throw std::invalid_argument("a member is divided with a node for each place, or none");
  return Division(building, member, places, nodes).carry_out();
}

std::vector<JointId> divide_member_at(Building& building, MemberId member,
                                      const std::vector<std::pair<double, NodeId>>& nodes) {
  std::vector<double> places;
  std::vector<NodeId> given;
  for (const auto& [place, node] : nodes) {
    places.push_back(place);
    given.push_back(node);
  }
  Division division(building, member, places, {});
  division.use_nodes(std::move(given));
  return division.carry_out();
}

void divide_all_members(Building& building, int pieces) {
  std::vector<double> places;
  for (int i = 1; i < pieces; ++i) places.push_back(static_cast<double>(i) / pieces);
  const std::size_t count = building.members.size();
  for (std::size_t m = 0; m < count && !places.empty(); ++m) divide_member(building, MemberId(m), places);
}

}  // namespace topple::structure
