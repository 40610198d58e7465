#include "formats/read_distribution.h"

#include <algorithm>
#include <array>

namespace topple::structure::formats {

namespace {

constexpr std::array<std::string_view, 5> kinds{"uniform", "normal", "lognormal", "choice", "grid"};
constexpr const char* accepted_kinds = R"(one of "uniform", "normal", "lognormal", "choice", "grid")";

void read_uniform(const JsonValue& value, Distribution& d) {
  value.expect_array(2, 2);
  auto bound = value.begin();
  d.low = (*bound).number();
  ++bound;
  d.high = (*bound).number();
  if (!(d.high > d.low)) value.refuse("[low, high], the second number above the first");
}

/// {"mean": ..., "sd" or "cov": ..., "low": ..., "high": ...}
void read_normal(const JsonValue& value, Distribution& d) {
  value.only({"mean", "sd", "cov", "low", "high"});
  const bool lognormal = d.kind == Distribution::Kind::lognormal;
  const JsonValue mean = value.require("mean");
  d.mean = lognormal ? mean.positive() : mean.number();
  const auto sd = value.find("sd"), cov = value.find("cov");
  if (sd.has_value() == cov.has_value()) value.refuse("one of \"sd\", \"cov\"");
  d.sd = sd ? sd->positive() : cov->positive() * std::abs(d.mean);
  if (!(d.sd > 0)) value.refuse("a mean that is not 0, or \"sd\"");
  if (const auto low = value.find("low")) d.low = low->number();
  if (const auto high = value.find("high")) d.high = high->number();
  if (!(d.high > d.low) || (lognormal && !(d.high > 0))) value.refuse("\"low\" below \"high\"");
  constexpr double reach = 8;  // sd: beyond, what is left of the distribution is below what doubles tell apart
  if (!lognormal && (d.low > d.mean + reach * d.sd || d.high < d.mean - reach * d.sd))
    value.refuse("\"low\" and \"high\" within 8 sd of the mean");
}

}  // namespace

bool is_distribution_key(std::string_view key) {
  return key == "weights" || std::find(kinds.begin(), kinds.end(), key) != kinds.end();
}

StudyValue read_study_value(const JsonValue& value) {
  StudyValue read;
  if (value.is_number())
    read.number = value.number();
  else
    read.json = text_of(value);
  return read;
}

Distribution read_distribution(const JsonValue& object) {
  object.expect_object();
  std::optional<JsonValue> given;
  Distribution d;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const auto value = object.find(kinds[k]);
    if (!value) continue;
    if (given) object.fail("two distributions; accepted: " + std::string(accepted_kinds));
    given = value;
    d.kind = static_cast<Distribution::Kind>(k);
  }
  if (!given) object.fail("a distribution is missing; accepted: " + std::string(accepted_kinds));
  switch (d.kind) {
    case Distribution::Kind::uniform:
      read_uniform(*given, d);
      break;
    case Distribution::Kind::normal:
    case Distribution::Kind::lognormal:
      read_normal(*given, d);
      break;
    case Distribution::Kind::choice:
    case Distribution::Kind::grid:
      given->expect_array(1, std::size_t{1} << 20);
      for (const JsonValue item : *given) d.values.push_back(read_study_value(item));
      break;
  }
  if (const auto weights = object.find("weights")) {
    if (d.kind != Distribution::Kind::choice) weights->fail("nothing to weigh; accepted: with \"choice\"");
    weights->expect_array(d.values.size(), d.values.size());
    for (const JsonValue weight : *weights) d.weights.push_back(weight.not_negative());
    if (std::all_of(d.weights.begin(), d.weights.end(), [](double w) { return w == 0; }))
      weights->fail("all are 0; accepted: one above 0 at least");
  }
  return d;
}

}  // namespace topple::structure::formats
