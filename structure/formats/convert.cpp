#include "topple/structure/formats/convert.h"

#include <algorithm>
#include <cstdio>

#include "formats/generator/written_out.h"
#include "formats/json/json_document.h"
#include "formats/model_files.h"
#include "formats/model_forms.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

namespace topple::structure {

namespace {

/// The JSON model of whatever stands at `in`; a sound one.
formats::JsonDocument json_model(const std::filesystem::path& in) {
  const std::string name = in.filename().string();
  switch (model_form(in)) {
    case ModelForm::frame3dd: {
      const std::string text = model_of_frame3dd(parse_frame3dd_file(formats::whole_text(in), name));
      return formats::JsonDocument::from_text(text, name);
    }
    case ModelForm::tables: {
      ModelOfTables model = model_of_tables(formats::read_tables(in), in.string());
      return formats::JsonDocument::from_text(model.json, in.string(), {}, std::move(model.places));
    }
    default: {
      formats::JsonDocument model = formats::JsonDocument::from_file(in);
      if (!formats::has_generator(model)) return model;
      const std::string text = formats::written_out(model);
      std::vector<std::string> places(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1,
                                      model.name() + ", its building written out");
      return formats::JsonDocument::from_text(text, model.name(), {}, std::move(places));
    }
  }
}

std::string json_text(const std::filesystem::path& in) {
  switch (model_form(in)) {
    case ModelForm::frame3dd:
      return model_of_frame3dd(parse_frame3dd_file(formats::whole_text(in), in.filename().string()));
    case ModelForm::tables:
      return model_of_tables(formats::read_tables(in), in.string()).json;
    default:
      return formats::whole_text(in);
  }
}

}  // namespace

ModelForm model_form(const std::filesystem::path& path) {
  const std::string ending = formats::ending_of(path);
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return ModelForm::tables;
  if (ending == ".json") return ModelForm::json;
  if (ending == ".3dd") return ModelForm::frame3dd;
  if (ending.empty()) return ModelForm::tables;
  throw InputError(path.string() + ": the ending " + ending +
                   " is not known; accepted: .json, .3dd, or a folder of tables (no ending)");
}

ConvertedModel convert_model(const std::filesystem::path& in, ModelForm to) {
  const Building building = read_model(in, Purpose::inspect);  // whatever is wrong with it is told here
  switch (to) {
    case ModelForm::json:
      return {{{"", json_text(in)}}};
    case ModelForm::frame3dd:
      return {{{"", frame3dd_text(frame3dd_of_model(json_model(in), building))}}};
    default:
      return {tables_of_model(json_model(in))};
  }
}

JoinedModel joined_model(const std::filesystem::path& in, double tolerance) {
  if (!(tolerance > 0)) throw InputError(in.string() + ": a model is joined within a length; accepted: above 0");
  const Building apart = read_model(in, Purpose::inspect);
  const std::string text = json_text(in), name = in.filename().string();
  if (formats::JsonDocument::from_text(text, name).root().find("connect"))
    throw InputError(in.string() + ": the model says `connect` itself; accepted: one without it");
  char key[64];
  std::snprintf(key, sizeof key, "\"connect\": %.17g, ", tolerance);
  JoinedModel joined;
  joined.text = text;
  joined.text.insert(joined.text.find('{') + 1, key);
  const Building together = parse_model(joined.text, name, Purpose::inspect);
  joined.members_divided = std::max(together.members.size(), apart.members.size()) - apart.members.size();
  // Only merging takes nodes away, and dividing at nodes that are there adds none.
  joined.nodes_merged = apart.nodes.size() - together.nodes.size();
  return joined;
}

}  // namespace topple::structure
