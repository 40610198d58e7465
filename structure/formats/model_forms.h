#pragma once
// The forms that a model can have in files, each to and from the text of a JSON model.
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/frame3dd/frame3dd_file.h"
#include "formats/json/json_document.h"

namespace topple::structure {

using TextsByName = std::vector<std::pair<std::string, std::string>>;

/// The JSON model of a .3dd file: consistent units, parts named by their numbers, the flags as `analyses`, and what has
/// no meaning for Topple as `frame3dd`.
[[nodiscard]] std::string model_of_frame3dd(const Frame3ddFile& file);
/// `building` is what the model describes: what a .3dd file holds as numbers only (sections by shape, moduli, loads in
/// global axes) comes from there. Throws InputError that names what a .3dd file cannot hold.
[[nodiscard]] Frame3ddFile frame3dd_of_model(const formats::JsonDocument& model, const Building& building);

/// A JSON model in which each row of the tables has a line of its own, and where that row stands ("members.csv, line
/// 5").
struct ModelOfTables {
  std::string json;
  std::vector<std::string> places;  ///< of line k + 1 of the JSON text
};
/// Tables by file name ("nodes.csv") and text; `folder` stands for it in messages. Throws InputError.
[[nodiscard]] ModelOfTables model_of_tables(const TextsByName& tables, const std::string& folder);
/// Throws InputError that names what tables cannot hold.
[[nodiscard]] TextsByName tables_of_model(const formats::JsonDocument& model);

}  // namespace topple::structure
