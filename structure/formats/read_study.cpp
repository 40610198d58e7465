// Studies: what is run, what varies, what is recorded.
#include <algorithm>
#include <array>
#include <set>

#include "formats/json/json_document.h"
#include "formats/read_distribution.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/input_files.h"
#include "topple/structure/study/study.h"

namespace topple::structure {

namespace formats {

namespace {

constexpr std::uint64_t most_samples = 1'000'000'000;

/// file, line and path, for messages about it later on.
std::string location_of(const JsonValue& value) {
  try {
    value.fail("");
  } catch (const InputError& error) {
    const std::string text = error.what();
    return text.substr(0, text.size() - 2);  // without ": "
  }
}

class StudyReader {
 public:
  StudyReader(const JsonDocument& document, std::filesystem::path folder)
      : root_(document.root()), folder_(std::move(folder)) {
    study_.file = document.name();
  }

  Study read() {
    if (!root_.is_object()) root_.refuse("an object");
    root_.only({"topple", "title", "base", "samples", "seed", "sampling", "vary", "groups", "record", "collapse_if",
                "fragility", "optimise"});
    const JsonValue version = root_.require("topple");
    if (!version.is_number() || version.number() != 1) version.refuse("1, the version of the format");
    if (const auto title = root_.find("title")) study_.title = title->text();
    read_base(root_.require("base"));
    if (const auto samples = root_.find("samples"))
      study_.samples = static_cast<std::uint64_t>(samples->whole(1, most_samples));
    if (const auto seed = root_.find("seed"))
      study_.seed = static_cast<std::uint64_t>(seed->whole(0, std::int64_t{1} << 53));
    if (const auto sampling = root_.find("sampling")) study_.sampling = read_sampling(*sampling);
    if (const auto vary = root_.find("vary")) study_.vary = read_variations(*vary);
    if (const auto groups = root_.find("groups")) read_groups(*groups);
    if (const auto record = root_.find("record")) read_record(*record);
    if (const auto collapse = root_.find("collapse_if")) study_.collapse_if = read_bounds(*collapse);
    if (const auto over = root_.find("fragility")) read_fragility(*over);
    if (const auto optimise = root_.find("optimise")) read_optimise(*optimise);
    if (study_.vary.empty() && !study_.optimise)
      root_.fail("nothing varies; accepted: \"vary\" with at least one entry");
    if (study_.base != Study::Base::none && study_.record.empty())
      root_.fail("nothing is recorded; accepted: \"record\" with at least one output");
    return std::move(study_);
  }

 private:
  void read_base(const JsonValue& base) {
    if (base.is_null()) return;
    base.only({"model", "scenario", "analyse"});
    const auto model = base.find("model"), scenario = base.find("scenario"), analyse = base.find("analyse");
    if (model.has_value() == scenario.has_value()) base.refuse("an object with \"model\" or \"scenario\", or null");
    const JsonValue& named = model ? *model : *scenario;
    const std::string name(named.text("a shipped one's name, or a path from the study's folder"));
    study_.base = model ? Study::Base::model : Study::Base::scenario;
    try {
      (model ? study_.model : study_.scenario) = model ? find_model(name, folder_) : found_scenario(name);
    } catch (const InputError& error) {
      named.fail(error.what());
    }
    if (!analyse) return;
    if (scenario) analyse->fail("a scenario is not analysed; accepted: with \"model\"");
    analyse->expect_array(0, 100);
    for (const JsonValue option : *analyse) study_.analyse.emplace_back(option.text("an option of topple analyse"));
  }

  [[nodiscard]] std::filesystem::path found_scenario(const std::string& name) const {
    std::error_code ignored;
    const std::filesystem::path path = folder_ / name;
    return std::filesystem::is_regular_file(path, ignored) ? path : find_scenario(name);
  }

  static Sampling read_sampling(const JsonValue& value) {
    constexpr std::array<std::string_view, 4> names{"random", "latin", "sobol", "saltelli"};
    constexpr const char* accepted = R"("random", "latin", "sobol" or "saltelli")";
    const auto found = std::find(names.begin(), names.end(), value.text(accepted));
    if (found == names.end()) value.refuse(accepted);
    return static_cast<Sampling>(found - names.begin());
  }

  std::vector<Variation> read_variations(const JsonValue& list) {
    list.expect_array(1, 100'000);
    std::vector<Variation> all;
    for (const JsonValue entry : list) {
      entry.expect_object();
      Variation& variation = all.emplace_back(read_variation(entry));
      variation.place = location_of(entry);
      if (const auto name = entry.find("name")) variation.name = name->text("a name");
      if (variation.name.empty()) entry.fail("the name is empty; accepted: a name");
      const bool lost = variation.target == Variation::Target::loss;
      if (lost && study_.base == Study::Base::model && ++losses_ > 1)
        entry.fail("another entry loses members as well; accepted of a model: one, whose samples lose one each");
      if (!names_.insert(variation.name).second)
        entry.fail("another entry is called " + in_quotes(variation.name) +
                   " as well; accepted: a \"name\" of its own");
    }
    return all;
  }

  Variation read_variation(const JsonValue& entry) {
    if (entry.find("at")) return read_pointer(entry);
    if (entry.find("joints")) return read_joints(entry);
    if (entry.find("lose_each")) return read_loss(entry);
    if (entry.find("charges")) return read_charges(entry);
    entry.fail(R"(what varies is missing; accepted: one of "at", "joints", "lose_each", "charges")");
  }

  /// Keys of the entry's own, and those of a distribution.
  static void only(const JsonValue& entry, std::initializer_list<std::string_view> keys) {
    for (const JsonValue value : entry)
      if (!is_distribution_key(value.key()) && std::find(keys.begin(), keys.end(), value.key()) == keys.end())
        value.fail("unknown key; accepted: " + quoted_list(std::vector<std::string_view>(keys)) +
                   " and a distribution's");
  }

  void require_base(const JsonValue& entry) const {
    if (study_.base == Study::Base::none) entry.fail("there is no base to change; accepted: a \"base\"");
  }

  Variation read_pointer(const JsonValue& entry) const {
    only(entry, {"at", "add", "times", "name"});
    Variation variation;
    const JsonValue at = entry.require("at");
    const std::string_view given = at.text("a JSON pointer, \"/materials/S355/yield_strength\"");
    constexpr std::string_view of_model = "model:";
    variation.name = given;
    variation.of_model = given.starts_with(of_model);
    variation.pointer = variation.of_model ? given.substr(of_model.size()) : given;
    if (study_.base == Study::Base::model) variation.of_model = true;
    if (study_.base != Study::Base::none && !variation.pointer.starts_with('/'))
      at.refuse("a JSON pointer, which begins with /, or one into the scenario's model, which begins with model:/");
    const bool add = flag(entry, "add"), times = flag(entry, "times");
    if (add && times) entry.fail("\"add\" and \"times\" both; accepted: one of them");
    variation.change = add ? Variation::Change::add : times ? Variation::Change::times : Variation::Change::replace;
    variation.distribution = read_distribution(entry);
    if ((add || times) && std::any_of(variation.distribution.values.begin(), variation.distribution.values.end(),
                                      [](const StudyValue& value) { return !value.is_number(); }))
      entry.fail("what is no number cannot be added or multiplied; accepted: numbers");
    return variation;
  }

  static bool flag(const JsonValue& entry, std::string_view key) {
    const auto value = entry.find(key);
    return value && value->boolean();
  }

  Variation read_joints(const JsonValue& entry) const {
    entry.only({"joints", "each", "strength", "name"});
    require_base(entry);
    Variation variation;
    variation.target = Variation::Target::joints;
    variation.selector = entry.require("joints").text("a group, a joint's name or pattern, or *");
    variation.name = "strength of " + variation.selector;
    variation.each = flag(entry, "each");
    variation.distribution = read_distribution(entry.require("strength"));
    require_numbers(entry.require("strength"), variation.distribution);
    return variation;
  }

  static void require_numbers(const JsonValue& value, const Distribution& distribution) {
    for (const StudyValue& one : distribution.values)
      if (!one.is_number()) value.fail("found " + one.json + "; accepted: numbers");
  }

  Variation read_loss(const JsonValue& entry) const {
    entry.only({"lose_each", "name"});
    require_base(entry);
    Variation variation;
    variation.target = Variation::Target::loss;
    variation.selector = entry.require("lose_each").text("a group of members, or a member's name or pattern");
    variation.name = "lost";
    variation.distribution.kind = Distribution::Kind::grid;
    return variation;
  }

  Variation read_charges(const JsonValue& entry) const {
    entry.only({"charges", "when", "used", "together", "name"});
    if (study_.base != Study::Base::scenario) entry.fail("charges go off in a scenario; accepted: a scenario as base");
    Variation variation;
    variation.target = Variation::Target::charges;
    variation.name = "charge";
    const JsonValue charges = entry.require("charges");
    charges.expect_array(1, 100'000);
    for (const JsonValue name : charges) variation.charges.emplace_back(name.text("a member's name or pattern"));
    const JsonValue when = entry.require("when");
    variation.distribution = read_distribution(when);
    require_numbers(when, variation.distribution);
    for (const StudyValue& value : variation.distribution.values)
      if (!ranges::instant.contains(value.number)) when.fail("a time is " + ranges::instant.text());
    variation.each = !flag(entry, "together");
    if (const auto used = entry.find("used")) {
      variation.used = read_distribution(*used);
      for (const StudyValue& value : variation.used->values)
        if (value.json != "true" && value.json != "false") used->fail("accepted: a choice or grid of true and false");
      if (variation.used->values.empty()) used->fail("accepted: a choice or grid of true and false");
    }
    return variation;
  }

  void read_groups(const JsonValue& groups) {
    groups.expect_array(0, 10'000);
    std::set<std::string> taken;
    for (const JsonValue value : groups) {
      value.only({"of", "correlation"});
      Study::Group& group = study_.groups.emplace_back();
      group.place = location_of(value);
      const JsonValue of = value.require("of");
      of.expect_array(1, 10'000);
      for (const JsonValue name : of) {
        group.of.emplace_back(name.text("the name of an entry of vary"));
        require_varied(name, group.of.back());
        if (!taken.insert(group.of.back()).second) name.fail("it is in a group already; accepted: each in one group");
      }
      const JsonValue correlation = value.require("correlation");
      if (correlation.is_number())
        group.alike = correlation.in({-1, 1});
      else
        read_matrix(correlation, group);
    }
  }

  static void read_matrix(const JsonValue& correlation, Study::Group& group) {
    const std::size_t n = group.of.size();
    correlation.expect_array(n, n);
    for (const JsonValue row : correlation) {
      row.expect_array(n, n);
      for (const JsonValue number : row) group.matrix.push_back(number.in({-1, 1}));
    }
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j <= i; ++j)
        if (group.matrix[i * n + j] != (i == j ? 1 : group.matrix[j * n + i]))
          correlation.fail("it is no correlation; accepted: a symmetric matrix with 1 along its diagonal");
  }

  void require_varied(const JsonValue& value, const std::string& name) const {
    if (names_.contains(name)) return;
    value.fail("there is no entry " + in_quotes(name) +
               " of vary; accepted: " + quoted_list(std::vector<std::string_view>(names_.begin(), names_.end())));
  }

  void read_record(const JsonValue& record) {
    record.expect_object();
    for (const JsonValue entry : record) {
      Recorded& recorded = study_.record.emplace_back();
      recorded.name = entry.key();
      recorded.place = location_of(entry);
      const std::string given(entry.text("\"summary:/...\", \"results:/...\", or the name of an output"));
      constexpr std::string_view summary = "summary:", results = "results:";
      if (given.starts_with(summary)) {
        if (study_.base != Study::Base::scenario) entry.fail("no summary.json is made; accepted: a scenario as base");
        recorded.from = Recorded::From::summary;
        recorded.pointer = given.substr(summary.size());
      } else if (given.starts_with(results)) {
        if (study_.base != Study::Base::model) entry.fail("no results.json is made; accepted: a model as base");
        recorded.from = Recorded::From::results;
        recorded.pointer = given.substr(results.size());
      } else {
        recorded.pointer = given;
        const auto known = ready_outputs();
        if (std::find(known.begin(), known.end(), given) == known.end())
          entry.refuse("\"summary:/...\", \"results:/...\", or one of " +
                       quoted_list(std::vector<std::string_view>(known.begin(), known.end())));
        continue;
      }
      if (!recorded.pointer.starts_with('/')) entry.refuse("a JSON pointer behind the colon, which begins with /");
    }
    if (study_.base == Study::Base::none && !study_.record.empty())
      record.fail("nothing is run; accepted: no \"record\" where \"base\" is null");
  }

  [[nodiscard]] std::vector<OutputBounds> read_bounds(const JsonValue& value) const {
    value.expect_object();
    std::vector<OutputBounds> all;
    for (const JsonValue entry : value) {
      entry.only({"above", "below"});
      require_recorded(entry, std::string(entry.key()));
      OutputBounds& bounds = all.emplace_back();
      bounds.output = entry.key();
      if (const auto above = entry.find("above")) bounds.above = above->number();
      if (const auto below = entry.find("below")) bounds.below = below->number();
      if (entry.size() == 0 || !(bounds.above < bounds.below))
        entry.refuse("\"above\", \"below\", or both in this order");
    }
    return all;
  }

  void require_recorded(const JsonValue& value, const std::string& name) const {
    std::vector<std::string_view> known;
    for (const Recorded& recorded : study_.record) known.emplace_back(recorded.name);
    if (std::find(known.begin(), known.end(), name) == known.end())
      value.fail("there is no output " + in_quotes(name) + " in \"record\"; accepted: " + quoted_list(known));
  }

  void read_fragility(const JsonValue& over) {
    study_.fragility = over.text("the name of an entry of vary");
    require_varied(over, study_.fragility);
    if (study_.collapse_if.empty()) over.fail("nothing says what a collapse is; accepted: with \"collapse_if\"");
  }

  void read_optimise(const JsonValue& value) {
    value.only({"least", "greatest", "subject_to", "runs", "repeats", "finalists", "unseen", "method", "choose"});
    OptimiseRequest request;
    const auto least = value.find("least"), greatest = value.find("greatest");
    if (least.has_value() == greatest.has_value()) value.refuse("one of \"least\", \"greatest\"");
    request.greatest = greatest.has_value();
    const JsonValue& objective = least ? *least : *greatest;
    request.objective = objective.text("an output");
    require_recorded(objective, request.objective);
    if (const auto subject_to = value.find("subject_to")) request.subject_to = read_bounds(*subject_to);
    request.runs = static_cast<int>(value.require("runs").whole(1, 10'000'000));
    if (const auto repeats = value.find("repeats")) request.repeats = static_cast<int>(repeats->whole(1, 100'000));
    if (const auto finalists = value.find("finalists")) {
      finalists->only({"designs", "repeats"});
      request.finalists = static_cast<int>(finalists->require("designs").whole(1, 100'000));
      request.finalist_repeats = static_cast<int>(finalists->require("repeats").whole(1, 100'000));
    }
    if (const auto unseen = value.find("unseen")) request.unseen = static_cast<int>(unseen->whole(0, 100'000));
    if (const auto method = value.find("method")) {
      request.method = method->text();
      if (request.method != "cobyla" && request.method != "isres" && request.method != "cross-entropy" &&
          request.method != "random")
        method->refuse(R"("cobyla", "isres", "cross-entropy" or "random")");
    }
    // What is chosen: entries of their own, or all of `vary`.
    if (const auto choose = value.find("choose"))
      request.choose = read_variations(*choose);
    else
      request.choose = std::exchange(study_.vary, {});
    if (request.choose.empty()) value.fail("nothing is chosen; accepted: \"choose\" or \"vary\" with an entry");
    study_.optimise = std::move(request);
  }

  JsonValue root_;
  std::filesystem::path folder_;
  Study study_;
  std::set<std::string> names_;
  int losses_ = 0;  ///< entries that lose members
};

}  // namespace

}  // namespace formats

Study read_study(const std::filesystem::path& file) {
  return parse_study(read_whole_file(file), file.string(), file.parent_path());
}

Study parse_study(std::string_view text, const std::string& name, const std::filesystem::path& folder) {
  const auto document = formats::JsonDocument::from_text(text, name);
  Study study = formats::StudyReader(document, folder).read();
  study.text = text;
  return study;
}

bool is_study(const std::filesystem::path& file) {
  if (file.extension() != ".json") return false;
  const auto document = formats::JsonDocument::from_file(file);
  return document.root().is_object() && document.root().find("base").has_value();
}

}  // namespace topple::structure
