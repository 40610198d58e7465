#include "study/analysis_options.h"

#include <algorithm>
#include <array>

#include "formats/json/json_document.h"
#include "topple/structure/error.h"
#include "topple/structure/number_range.h"

namespace topple::structure::study {

namespace {

class Options {
 public:
  Options(const Study& study, const Building& building) : study_(study), building_(building), names_(building) {}

  AnalysisOfSample read() {
    for (std::size_t i = 0; i < study_.analyse.size(); ++i) {
      std::string option = study_.analyse[i], value;
      const std::size_t equals = option.find('=');
      const bool given = equals != std::string::npos;
      if (given) {
        value = option.substr(equals + 1);
        option.resize(equals);
      }
      if (option == "--p-delta") {
        second_order(given ? value : "exact");
        continue;
      }
      if (!given) {
        if (i + 1 == study_.analyse.size()) refuse(option, known(option) ? "a value behind it" : accepted);
        value = study_.analyse[++i];
      }
      if (!known(option)) refuse(option, accepted);
      one(option, value);
    }
    return std::move(result_);
  }

 private:
  static constexpr const char* accepted =
      "--combination, --p-delta, --buckling, --modes, --lose, --lose-each, --sudden, --code";

  [[noreturn]] void refuse(const std::string& option, const std::string& instead) const {
    throw InputError(study_.file + ", base.analyse: " + formats::in_quotes(option) + "; accepted: " + instead);
  }
  static bool known(const std::string& option) {
    constexpr std::array<std::string_view, 7> with_value{"--combination", "--buckling", "--modes", "--lose",
                                                         "--lose-each",   "--sudden",   "--code"};
    return std::find(with_value.begin(), with_value.end(), option) != with_value.end();
  }

  void second_order(const std::string& value) {
    if (value != "exact" && value != "cubic")
      refuse("--p-delta=" + value, "--p-delta, --p-delta=exact, --p-delta=cubic");
    result_.request.second_order = value == "exact" ? solver::SecondOrder::exact : solver::SecondOrder::cubic;
  }

  [[nodiscard]] double number(const std::string& option, const std::string& value, const NumberRange& range) const {
    const auto read = number_of(value);
    if (!read || !range.contains(*read)) refuse(option + " " + value, range.text());
    return *read;
  }

  void one(const std::string& option, const std::string& value) {
    AnalysisRequest& request = result_.request;
    constexpr NumberRange counts{0, 10'000};
    if (option == "--combination") return combination(value);
    if (option == "--buckling") {
      request.buckling = static_cast<int>(number(option, value, counts));
    } else if (option == "--modes") {
      request.modes = static_cast<int>(number(option, value, counts));
    } else if (option == "--sudden") {
      request.losses.sudden = number(option, value, ranges::sudden);
    } else if (option == "--lose") {
      const std::vector<MemberId> found = names_.members_matching(value);
      if (found.empty()) refuse(option + " " + value, "a member's name or pattern");
      request.losses.named.insert(request.losses.named.end(), found.begin(), found.end());
    } else if (option == "--lose-each") {
      const NameIndex::Group* group = names_.group(value);
      if (group == nullptr || group->members.empty()) refuse(option + " " + value, "a group of members");
      request.losses.each.insert(request.losses.each.end(), group->members.begin(), group->members.end());
    } else {
      if (value != "en1993" && value != "aisc360") refuse(option + " " + value, "en1993 or aisc360");
      result_.code = value == "en1993" ? DesignCode::en1993 : DesignCode::aisc360;
      request.stations = design_stations;
      request.critical_sections = true;
    }
  }

  void combination(const std::string& pattern) {
    bool found = false;
    std::vector<std::string_view> known_names;
    for (std::size_t i = 0; i < building_.combinations.size(); ++i) {
      known_names.emplace_back(building_.combinations[i].name);
      if (!matches_pattern(pattern, building_.combinations[i].name)) continue;
      result_.request.combinations.emplace_back(i);
      found = true;
    }
    if (!found) refuse("--combination " + pattern, formats::quoted_list(known_names));
  }

  const Study& study_;
  const Building& building_;
  NameIndex names_;
  AnalysisOfSample result_;
};

}  // namespace

AnalysisOfSample analysis_of(const Study& study, const Building& building) {
  AnalysisOfSample result = Options(study, building).read();
  // Samples run side by side: each has one thread.
  result.request.workers = 1;
  result.request.solver.threads = 1;
  return result;
}

}  // namespace topple::structure::study
