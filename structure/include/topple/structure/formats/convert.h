#pragma once
// Models from one file format to another: Topple JSON, Frame3DD (.3dd) and tables (a folder of CSV files). Numbers are
// carried as they stand in the file, never converted, so a round trip keeps them to the bit.
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace topple::structure {

enum class ModelForm { json, frame3dd, tables };

/// By the ending: .json, .3dd, none (a folder of tables). Throws InputError for any other.
[[nodiscard]] ModelForm model_form(const std::filesystem::path& path);

/// A model in another form, as files.
struct ConvertedModel {
  /// Names and texts: one with an empty name for .json and .3dd, one for each table.
  std::vector<std::pair<std::string, std::string>> files;
};

/// Reads a model (it must be a sound one) and writes it in another form. Throws InputError with the name of anything in
/// it that the other form cannot hold. Names of parts that a .3dd file replaces by numbers stand beside them as
/// comments.
[[nodiscard]] ConvertedModel convert_model(const std::filesystem::path& in, ModelForm to);

/// A model as JSON whose parts are joined: `"connect": tolerance` (in the model's length) is written into it, by which
/// every reading merges nodes within that distance and divides members at nodes that lie on them.
struct JoinedModel {
  std::string text;                 ///< JSON
  std::size_t nodes_merged = 0;     ///< how many nodes became one with another
  std::size_t members_divided = 0;  ///< how many more members there are
};
/// Throws InputError as convert_model() does, for a tolerance that is not above 0, and for a model that says `connect`
/// itself.
[[nodiscard]] JoinedModel joined_model(const std::filesystem::path& in, double tolerance);

}  // namespace topple::structure
