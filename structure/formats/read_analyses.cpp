// `analyses`: what the file itself asks for; `frame3dd`: what it keeps for that program alone.
#include "formats/frame3dd/frame3dd.h"
#include "formats/model_reader.h"

namespace topple::structure::formats {

namespace {

constexpr std::int64_t most_modes = 10'000'000;

void check_whole_list(const JsonValue& list, std::int64_t least) {
  list.expect_array(0, ~std::size_t{0});
  for (const JsonValue number : list) (void)number.whole(least, most_modes);
}

/// Checked, and told: no result depends on it.
void read_condensation(const JsonValue& value, ModelDraft& draft) {
  value.only({"method", "nodes", "modes"});
  const std::int64_t method = value.require("method").whole(0, 3);
  if (const auto nodes = value.find("nodes")) {
    nodes->expect_object();
    for (const JsonValue flags : *nodes) {
      (void)draft.node_of_key(flags);
      flags.expect_array(6, 6);
      for (const JsonValue flag : flags) (void)flag.whole(0, 1);
    }
  }
  if (const auto modes = value.find("modes")) check_whole_list(*modes, 0);
  if (method != 0) draft.building.warnings.emplace_back(frame3dd_condensation_warning);
}

}  // namespace

void read_analyses(const JsonValue& root, ModelDraft& draft) {
  const auto value = root.find("analyses");
  if (!value) return;
  value->only({"p_delta", "modes", "mass", "shift"});
  RequestedAnalyses& requested = draft.building.requested;
  if (const auto p_delta = value->find("p_delta")) {
    if (p_delta->text("\"cubic\"") != "cubic") p_delta->refuse("\"cubic\"");
    requested.cubic_p_delta = true;
  }
  const auto modes = value->find("modes");
  if (!modes) {
    for (const char* key : {"mass", "shift"})
      if (const auto idle = value->find(key)) idle->fail("it means nothing without `modes`; accepted: both or none");
    return;
  }
  requested.modes = static_cast<int>(modes->whole(1, most_modes));
  requested.modes_of_last_combination = requested.cubic_p_delta;
  if (const auto mass = value->find("mass")) {
    const std::string_view kind = mass->text("\"consistent\" or \"lumped\"");
    if (kind != "consistent" && kind != "lumped") mass->refuse("\"consistent\" or \"lumped\"");
    requested.lumped_mass = kind == "lumped";
  }
  if (const auto shift = value->find("shift")) requested.frequency_shift = shift->number();
}

void read_frame3dd_remarks(const JsonValue& root, ModelDraft& draft) {
  const auto value = root.find("frame3dd");
  if (!value) return;
  value->only({"exaggeration", "zoom", "increment", "method", "tolerance", "mode_exaggeration", "animated", "pan",
               "condensation"});
  for (const char* key : {"exaggeration", "zoom", "increment", "mode_exaggeration", "pan"})
    if (const auto number = value->find(key)) (void)number->number();
  if (const auto method = value->find("method")) (void)method->whole(1, 2);
  if (const auto tolerance = value->find("tolerance")) (void)tolerance->positive();
  if (const auto animated = value->find("animated")) check_whole_list(*animated, 1);
  if (const auto condensation = value->find("condensation")) read_condensation(*condensation, draft);
}

}  // namespace topple::structure::formats
