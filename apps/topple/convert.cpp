// topple convert IN OUT: a model from one file format to another.
#include "topple/structure/formats/convert.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <system_error>

#include "command.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/input_files.h"
#include "topple/structure/formats/output_files.h"
#include "topple/structure/formats/plain_text.h"

namespace topple::app {

namespace {

/// A table that is left from something else would become part of the model.
void refuse_other_tables(const std::filesystem::path& folder, const structure::ConvertedModel& model) {
  std::error_code ignored;
  for (const std::string& name : structure::names_in(folder, ignored)) {
    if (std::filesystem::path(name).extension() != ".csv") continue;
    if (std::none_of(model.files.begin(), model.files.end(), [&](const auto& file) { return file.first == name; }))
      throw structure::InputError(
          structure::one_line((folder / name).string()) +
          ": is there already and would become part of the tables; accepted: a folder without it");
  }
}

/// Writes a model with its parts joined, and says what that joins.
int join(const std::filesystem::path& file, const std::filesystem::path& target, double tolerance) {
  if (structure::model_form(target) != structure::ModelForm::json)
    throw structure::InputError(target.string() +
                                ": joined models are written as JSON, by its `connect`; accepted: .json");
  structure::require_writable(target);
  const structure::JoinedModel joined = structure::joined_model(file, tolerance);
  structure::write_file(target, joined.text);
  std::printf("%zu nodes merged, members divided into %zu more pieces\n", joined.nodes_merged, joined.members_divided);
  return success;
}

int convert(const std::string& in, const std::string& out, const std::optional<double>& tolerance) {
  const std::filesystem::path target(out);
  const structure::ModelForm form = structure::model_form(target);
  const std::filesystem::path file = structure::find_model(in);
  structure::require_different(file, target);
  if (tolerance) return join(file, target, *tolerance);
  if (form != structure::ModelForm::tables) structure::require_writable(target);
  structure::ConvertedModel model = structure::convert_model(file, form);
  if (form == structure::ModelForm::tables) {
    refuse_other_tables(target, model);
    const structure::OutputFolder folder(target, {file}, {"*.csv"});
    structure::write_files(target, model.files);
  } else {
    structure::write_file(target, model.files.front().second);
  }
  return success;
}

const Registration registration(
    {"convert", "Write a model in another file format", [](CLI::App& app) -> std::function<int()> {
       auto in = std::make_shared<std::string>(), out = std::make_shared<std::string>();
       app.add_option("IN", *in, "A shipped model's name, a file (.json, .3dd), or a folder of tables (.csv)")
           ->required();
       app.add_option("OUT", *out, "The file to write (.json, .3dd), or a folder for tables")->required();
       auto tolerance = std::make_shared<std::optional<double>>();
       app.add_option(
           "--join", *tolerance,
           "Merge nodes within this distance and divide members at nodes that lie on them (the model's length; to "
           ".json)");
       return [in, out, tolerance] { return convert(*in, *out, *tolerance); };
     }});

}  // namespace

}  // namespace topple::app
