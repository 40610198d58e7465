// Scenarios: rules of failure, impact and debris, and tools at their times (read_tool.h).
#include <algorithm>

#include "formats/divide_cut_members.h"
#include "formats/documents.h"
#include "formats/json/json_document.h"
#include "formats/json/json_keys.h"
#include "formats/model_reader.h"
#include "formats/read_fracture.h"
#include "formats/read_tool.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/scenario_text.h"

namespace topple::structure {

namespace formats {

namespace {

bool boolean(const JsonValue& value) { return value.boolean(); }

/// Why a key that bounded a step is refused.
constexpr const char* pace_is_the_hosts =
    "a step computes all that happens in it, and the pace of the steps is the host's; leave the key out";

/// More of them in a step serve nothing: a step of a tenth of a second has them at 10 kHz.
constexpr std::int64_t most_substeps = 1000;

class ScenarioReader {
 public:
  ScenarioReader(const JsonValue& root, const Building& building, CutPlaces cuts)
      : root_(root), building_(building), tools_(building, std::move(cuts)) {}

  Scenario read() {
    scenario_.combination = read_combination();
    read_optional(root_, "title", scenario_.title, [](const JsonValue& v) { return std::string(v.text()); });
    read_optional(root_, "step", scenario_.step, within(ranges::step));
    read_optional(root_, "duration", scenario_.duration, within(ranges::duration));
    read_optional(root_, "until_rest", scenario_.until_rest, boolean);
    read_optional(root_, "seed", scenario_.seed,
                  [](const JsonValue& v) { return static_cast<std::uint64_t>(v.whole(0, std::int64_t{1} << 53)); });
    read_optional(root_, "ground", scenario_.ground, within(ranges::place));
    read_optional(root_, "standing", scenario_.standing, [](const JsonValue& v) {
      const std::string_view rule = v.text("\"static\" or \"dynamic\"");
      if (rule != "static" && rule != "dynamic") v.refuse("\"static\" or \"dynamic\"");
      return rule == "dynamic" ? StandingRule::dynamics : StandingRule::statics;
    });
    if (const auto dynamics = root_.find("dynamics")) read_dynamics(*dynamics);
    if (const auto failure = root_.find("failure")) read_failure(*failure);
    if (const auto impact = root_.find("impact")) read_impact(*impact);
    if (const auto debris = root_.find("debris")) read_debris(*debris);
    if (const auto fracture = root_.find("fracture")) scenario_.fracture = read_fracture(*fracture);
    if (const auto events = root_.find("events")) read_events(*events);
    return std::move(scenario_);
  }

 private:
  CombinationId read_combination() const {
    const auto& combinations = building_.combinations;
    std::vector<std::string_view> accepted;
    for (const Combination& combination : combinations) accepted.push_back(combination.name);
    const auto value = root_.find("combination");
    if (!value) {
      if (combinations.size() == 1) return CombinationId(0);
      root_.fail("the key \"combination\" is missing and the model has several; accepted: " + quoted_list(accepted));
    }
    const std::string_view name = value->text("the name of a combination");
    for (std::size_t i = 0; i < combinations.size(); ++i)
      if (combinations[i].name == name) return CombinationId(i);
    value->fail("there is no combination " + in_quotes(name) + "; accepted: " + quoted_list(accepted));
  }

  void read_dynamics(const JsonValue& dynamics) {
    if (scenario_.standing == StandingRule::statics)
      dynamics.fail("what stands does not move in time with \"standing\": \"static\"; accepted: one of the two");
    dynamics.only({"substeps", "damping", "spectral_radius"});
    MotionRules& rules = scenario_.motion;
    read_optional(dynamics, "substeps", rules.substeps,
                  [](const JsonValue& v) { return static_cast<int>(v.whole(1, most_substeps)); });
    read_optional(dynamics, "damping", rules.damping, within(ranges::unit));
    read_optional(dynamics, "spectral_radius", rules.spectral_radius, within(ranges::unit));
  }

  void read_failure(const JsonValue& failure) {
    if (const auto quota = failure.find("generations_per_second"))
      quota->fail("nothing limits what may break in a step any more: " + std::string(pace_is_the_hosts));
    failure.only({"bracing", "mechanism", "second_order", "sudden"});
    FailureRules& rules = scenario_.failure;
    read_optional(failure, "bracing", rules.bracing, [](const JsonValue& v) {
      const std::string_view rule = v.text("\"buckling\", \"classic\" or \"none\"");
      if (rule == "buckling") return BracingRule::buckling;
      if (rule == "classic") return BracingRule::classic;
      if (rule != "none") v.refuse("\"buckling\", \"classic\" or \"none\"");
      return BracingRule::none;
    });
    read_optional(failure, "mechanism", rules.mechanism, [](const JsonValue& v) {
      const std::string_view rule = v.text("\"hinge\" or \"detach\"");
      if (rule != "hinge" && rule != "detach") v.refuse("\"hinge\" or \"detach\"");
      return rule == "hinge" ? MechanismRule::hinge : MechanismRule::detach;
    });
    read_optional(failure, "second_order", rules.second_order, boolean);
    if (const auto sudden = failure.find("sudden"); sudden && scenario_.standing == StandingRule::dynamics)
      sudden->fail(
          "a factor of sudden losses acts with \"standing\": \"static\" alone: what moves overshoots by itself");
    read_optional(failure, "sudden", rules.sudden, within(ranges::sudden));
  }

  void read_impact(const JsonValue& impact) {
    impact.only({"restitution", "structure_mass"});
    read_optional(impact, "restitution", scenario_.impact.restitution, within(ranges::unit));
    read_optional(impact, "structure_mass", scenario_.impact.structure_mass, boolean);
  }

  void read_debris(const JsonValue& debris) {
    debris.only({"friction", "restitution", "limit", "smallest_volume"});
    read_optional(debris, "friction", scenario_.debris.friction, within(ranges::friction));
    read_optional(debris, "restitution", scenario_.debris.restitution, within(ranges::unit));
    read_optional(debris, "limit", scenario_.debris.limit, [](const JsonValue& v) -> std::optional<int> {
      if (v.is_null()) return std::nullopt;
      if (!v.is_number()) v.refuse("a whole number from 0 to 1000000, or null for none");
      return static_cast<int>(v.whole(0, 1'000'000));
    });
    read_optional(debris, "smallest_volume", scenario_.debris.smallest_volume, within(ranges::volume));
  }

  void read_events(const JsonValue& events) {
    if (!events.is_array()) events.refuse("an array of events");
    for (const JsonValue value : events) {
      value.expect_object();
      value.only({"at", "projectile", "cut", "remove", "charge", "weaken", "wrecking_ball", "gravity", "load"});
      Event event;
      event.at = value.require("at").in(ranges::instant);
      if (value.size() != 2)
        value.fail("found " + std::to_string(value.size() - 1) +
                   " tools; accepted: `at` and one of \"projectile\", \"cut\", \"remove\", \"charge\", \"weaken\", "
                   "\"wrecking_ball\", \"gravity\", \"load\"");
      for (const JsonValue tool : value)
        if (tool.key() != "at") event.tool = tools_.read(tool);
      scenario_.events.push_back(std::move(event));
    }
    std::stable_sort(scenario_.events.begin(), scenario_.events.end(),
                     [](const Event& a, const Event& b) { return a.at < b.at; });
  }

  JsonValue root_;
  const Building& building_;
  ToolReader tools_;
  Scenario scenario_;
};

/// Nothing but what a scenario may hold.
void require_scenario(const JsonDocument& document) {
  const JsonValue root = document.root();
  if (!root.is_object()) root.refuse("an object");
  if (const auto budget = root.find("budget"))
    budget->fail("nothing limits what a step may compute any more: " + std::string(pace_is_the_hosts));
  root.only({"topple", "title", "model", "combination", "step", "duration", "until_rest", "seed", "ground", "standing",
             "dynamics", "failure", "impact", "debris", "fracture", "events"});
  const JsonValue version = root.require("topple");
  if (!version.is_number() || version.number() != 1) version.refuse("1, the version of the format");
}

std::pair<Building, Scenario> read_document(const JsonDocument& document, const std::filesystem::path& folder) {
  require_scenario(document);
  return read_scenario_document(document, read_model(model_of_scenario(document, folder), Purpose::demolish));
}

}  // namespace

std::filesystem::path model_of_scenario(const JsonDocument& document, const std::filesystem::path& folder) {
  const JsonValue model = document.root().require("model");
  const std::string name(model.text("a shipped model's name, or a path from the scenario's folder"));
  try {
    return find_model(name, folder);
  } catch (const InputError& error) {
    model.fail(error.what());
  }
}

std::pair<Building, Scenario> read_scenario_document(const JsonDocument& document, Building building) {
  require_scenario(document);
  const JsonValue root = document.root();
  CutPlaces cuts = divide_cut_members(root, building);
  Scenario scenario = ScenarioReader(root, building, std::move(cuts)).read();
  scenario.file = document.name();
  const auto model = root.find("model");
  scenario.model = model ? std::string(model->text()) : building.file;
  return {std::move(building), std::move(scenario)};
}

}  // namespace formats

std::pair<Building, Scenario> read_scenario(const std::filesystem::path& file) {
  return formats::read_document(formats::JsonDocument::from_file(file), file.parent_path());
}

std::pair<Building, Scenario> parse_scenario(std::string_view text, const std::string& name,
                                             const std::filesystem::path& folder) {
  return formats::read_document(formats::JsonDocument::from_text(text, name), folder);
}

std::pair<Building, Scenario> parse_scenario(std::string_view text, const std::string& name, Building building) {
  refuse_unbuilt(building, Purpose::demolish);
  return formats::read_scenario_document(formats::JsonDocument::from_text(text, name), std::move(building));
}

Tool parse_tool(std::string_view text, const std::string& name, const Building& building) {
  return formats::read_one_tool(formats::JsonDocument::from_text(text, name), building);
}

bool is_scenario(const std::filesystem::path& file) {
  if (file.extension() != ".json") return false;
  const auto document = formats::JsonDocument::from_file(file);
  return document.root().is_object() && document.root().find("model").has_value();
}

Scenario idle_scenario(const Building& building) {
  Scenario scenario;
  scenario.title = building.title;
  scenario.model = building.file;
  // The one that a building is demolished under, where there is a choice.
  scenario.combination = CombinationId(0);
  for (std::size_t i = 0; i < building.combinations.size(); ++i)
    if (building.combinations[i].name == "collapse") scenario.combination = CombinationId(i);
  return scenario;
}

}  // namespace topple::structure
