#include "formats/divide_cut_members.h"

#include "formats/model_reader.h"
#include "topple/structure/join_shells.h"

namespace topple::structure::formats {

namespace {

/// A piece is no shorter than this share of the member.
constexpr double shortest_piece = 0.01;

double read_place(const JsonValue& value) {
  const char* accepted = "a fraction of the member's length from 0 to 1, within 0.01 of an end only 0 or 1";
  const double place = value.number(accepted);
  const bool inside = place >= shortest_piece && place <= 1 - shortest_piece;
  if (!inside && place != 0 && place != 1) value.refuse(accepted);
  return place;
}

}  // namespace

CutPlaces divide_cut_members(const JsonValue& root, Building& building) {
  CutPlaces cuts;
  MemberPlaces places;
  const NameIndex names(building);
  const auto events = root.find("events");
  if (!events || !events->is_array()) return join_shells(building);
  for (const JsonValue event : *events) {
    const auto cut = event.is_object() ? event.find("cut") : std::nullopt;
    const auto members = cut && cut->is_object() ? cut->find("members") : std::nullopt;
    if (!members) continue;
    members->expect_array(0, ~std::size_t{0});
    for (const JsonValue entry : *members) {
      entry.expect_object();
      entry.only({"member", "where"});
      const JsonValue pattern = entry.require("member");
      const double place = read_place(entry.require("where"));
      const auto found = names.members_matching(std::string(pattern.text("a member's name, or a pattern with *")));
      if (found.empty())
        pattern.fail("there is no member " + in_quotes(pattern.text()) + "; accepted: a name or pattern of the model");
      for (const MemberId id : found) {
        const std::string& name = building[id].name;
        if (place == 0 || place == 1)
          cuts[{name, place}] = name + (place == 0 ? ":1" : ":2");
        else
          places[name].insert(place);
      }
    }
  }
  cuts.merge(join_shells(building, places));
  return cuts;
}

}  // namespace topple::structure::formats
