#pragma once
// Tools of scenarios, and of hosts: what each of their keys means in a building. Names and patterns become ids.
#include <string>
#include <vector>

#include "formats/divide_cut_members.h"
#include "formats/json/json_document.h"
#include "formats/model_reader.h"
#include "topple/structure/scenario.h"

namespace topple::structure::formats {

class ToolReader {
 public:
  /// `building` must outlive it; `cuts`: the joints that its members were divided for.
  ToolReader(const Building& building, CutPlaces cuts)
      : building_(building), names_(building), cuts_(std::move(cuts)) {}

  /// The value of a tool's key. Throws InputError with the place in the file, what is wrong and what is accepted.
  [[nodiscard]] Tool read(const JsonValue& value) const;

 private:
  [[nodiscard]] CutTool read_cut(const JsonValue& value) const;
  [[nodiscard]] RemoveTool read_remove(const JsonValue& value) const;
  [[nodiscard]] WeakenTool read_weaken(const JsonValue& value) const;
  [[nodiscard]] LoadTool read_load(const JsonValue& value) const;
  [[nodiscard]] std::vector<MemberId> all_pieces(std::vector<MemberId> members) const;
  [[nodiscard]] std::vector<NodeId> supported_nodes(const std::string& pattern) const;
  void read_groups(const JsonValue& groups, std::vector<MemberId>& members, std::vector<PanelId>& panels) const;

  const Building& building_;
  NameIndex names_;
  CutPlaces cuts_;
};

/// A document with one tool, that no scenario foresaw: it cuts members at their own joints alone.
[[nodiscard]] Tool read_one_tool(const JsonDocument& document, const Building& building);

}  // namespace topple::structure::formats
