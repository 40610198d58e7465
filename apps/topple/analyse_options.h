#pragma once
// Options of `topple analyse`, and the requests that they make.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "motion_options.h"
#include "topple/structure/analysis.h"
#include "topple/structure/member_checks.h"

namespace topple::app {

/// What the command line of `topple analyse` says.
struct AnalyseOptions {
  std::string model, output;
  std::vector<std::string> combinations;
  std::string code;
  std::optional<double> drift_limit;
  std::string effective_lengths, warping, project, author;
  std::vector<std::string> stiffeners;
  bool rigid_end_posts = false;
  std::string direct_analysis;
  int stations = 0, threads = 0;
  std::string p_delta;
  int buckling = 0, modes = 0, divide = 1;
  std::string mass, torsional_mass, factor;
  bool rotary_inertia = false;
  std::vector<std::string> lose, lose_each;
  std::optional<double> sudden;
  MotionOptions motion;
  std::string cuts;
  bool html = false, csv = false, vtu = false, diagnose = false;
};

/// Throws InputError for options that do not go together.
void require_sound(const AnalyseOptions& options);

/// Combinations that are named, else all. Throws InputError for a name that none has.
[[nodiscard]] std::vector<structure::CombinationId> combinations_of(const structure::Building& building,
                                                                    const AnalyseOptions& options);

/// `model`: the file, which may have cuts of its own. Throws InputError with the option and what it accepts.
[[nodiscard]] structure::AnalysisRequest analysis_request(const AnalyseOptions& options,
                                                          const std::filesystem::path& model,
                                                          const structure::Building& building);

/// Lengths that the command line gives are in the model's units.
[[nodiscard]] structure::DesignInput design_input(const AnalyseOptions& options, const structure::Building& building);

}  // namespace topple::app
