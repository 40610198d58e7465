#include "topple/structure/building.h"

namespace topple::structure {

namespace {

template <class Id>
std::optional<Id> find(const std::map<std::string, Id>& names, const std::string& name) {
  const auto found = names.find(name);
  if (found == names.end()) return std::nullopt;
  return found->second;
}

template <class Id>
std::vector<Id> find_matching(const std::map<std::string, Id>& names, const std::string& pattern) {
  if (pattern.find('*') == std::string::npos) {
    const auto id = find(names, pattern);
    return id ? std::vector<Id>{*id} : std::vector<Id>{};
  }
  std::vector<Id> found;
  for (const auto& [name, id] : names)
    if (matches_pattern(pattern, name)) found.push_back(id);
  return found;
}

const char* group_of(MemberKind kind) {
  switch (kind) {
    case MemberKind::post:
      return "posts";
    case MemberKind::beam:
      return "beams";
    default:
      return "braces";
  }
}

}  // namespace

bool matches_pattern(std::string_view pattern, std::string_view text) {
  std::size_t p = 0, t = 0, star = std::string_view::npos, resume = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = t;
    } else if (p < pattern.size() && pattern[p] == text[t]) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++resume;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

NameIndex::NameIndex(const Building& building) {
  for (std::size_t i = 0; i < building.nodes.size(); ++i) nodes_.emplace(building.nodes[i].name, NodeId(i));
  for (std::size_t i = 0; i < building.joints.size(); ++i) joints_.emplace(building.joints[i].name, JointId(i));
  for (const char* kind : {"posts", "beams", "braces", "slabs", "walls"}) groups_[kind];
  for (std::size_t i = 0; i < building.members.size(); ++i) {
    const Member& member = building.members[i];
    members_.emplace(member.name, MemberId(i));
    groups_[group_of(member.kind)].members.push_back(MemberId(i));
    for (const std::string& group : member.groups) groups_[group].members.push_back(MemberId(i));
  }
  for (std::size_t i = 0; i < building.panels.size(); ++i) {
    const Panel& panel = building.panels[i];
    panels_.emplace(panel.name, PanelId(i));
    groups_[panel.kind == PanelKind::slab ? "slabs" : "walls"].panels.push_back(PanelId(i));
    for (const std::string& group : panel.groups) groups_[group].panels.push_back(PanelId(i));
  }
}

std::optional<NodeId> NameIndex::node(const std::string& name) const { return find(nodes_, name); }
std::optional<MemberId> NameIndex::member(const std::string& name) const { return find(members_, name); }
std::optional<PanelId> NameIndex::panel(const std::string& name) const { return find(panels_, name); }
std::optional<JointId> NameIndex::joint(const std::string& name) const { return find(joints_, name); }

std::vector<NodeId> NameIndex::nodes_matching(const std::string& pattern) const {
  return find_matching(nodes_, pattern);
}
std::vector<MemberId> NameIndex::members_matching(const std::string& pattern) const {
  return find_matching(members_, pattern);
}
std::vector<PanelId> NameIndex::panels_matching(const std::string& pattern) const {
  return find_matching(panels_, pattern);
}
std::vector<JointId> NameIndex::joints_matching(const std::string& pattern) const {
  return find_matching(joints_, pattern);
}

const NameIndex::Group* NameIndex::group(const std::string& name) const {
  const auto found = groups_.find(name);
  return found == groups_.end() ? nullptr : &found->second;
}

}  // namespace topple::structure
