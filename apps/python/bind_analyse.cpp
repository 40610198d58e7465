// analyse(): what is asked for in Python's words becomes a request, and runs without holding the interpreter.
#include <algorithm>
#include <chrono>
#include <thread>

#include "bindings.h"
#include "errors.h"
#include "host_blas.h"
#include "results.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/parse_cuts.h"
#include "topple/structure/member_checks.h"
#include "topple/structure/modelling_checks.h"
#include "topple/structure/time_history.h"

namespace topple::python {

using namespace structure;

namespace {

/// A str, or any iterable of them.
std::vector<std::string> names_in(const py::object& given, const char* what) {
  if (given.is_none()) return {};
  if (py::isinstance<py::str>(given)) return {utf8_of(given)};
  std::vector<std::string> names;
  for (const py::handle one : py::iter(given)) {
    if (!py::isinstance<py::str>(one))
      throw py::type_error(std::string(what) + ": accepted: a name, or a list of names");
    names.push_back(utf8_of(one));
  }
  return names;
}

[[noreturn]] void refuse(const Building& building, const std::string& what, const std::string& problem) {
  throw PlacedInputError({building.file, what}, problem);
}

std::vector<CombinationId> combinations_named(const Building& building, const std::vector<std::string>& patterns) {
  std::vector<CombinationId> ids;
  const std::vector<std::string> known = names_of(building.combinations);
  for (const std::string& pattern : patterns) {
    bool found = false;
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (!matches_pattern(pattern, known[i])) continue;
      if (std::find(ids.begin(), ids.end(), CombinationId(i)) == ids.end()) ids.emplace_back(i);
      found = true;
    }
    if (found) continue;
    std::string accepted;
    for (const std::string& name : known) accepted += (accepted.empty() ? "" : ", ") + name;
    refuse(building, "combinations",
           "no such combination: " + pattern + did_you_mean(pattern, known) + "; accepted: " + accepted);
  }
  return ids;
}

void request_losses(const Model& model, const std::vector<std::string>& lose, const std::vector<std::string>& lose_each,
                    LossRequest& request) {
  const Building& building = model.building();
  for (const std::string& name : lose) {
    const std::vector<MemberId> found = model.names().members_matching(name);
    if (found.empty())
      refuse(building, "lose",
             "no such member: " + name + did_you_mean(name, names_of(building.members)) +
                 "; accepted: a member's name, in which * stands for any run of characters");
    request.named.insert(request.named.end(), found.begin(), found.end());
  }
  for (const std::string& name : lose_each) {
    const NameIndex::Group* group = model.names().group(name);
    if (group == nullptr || group->members.empty())
      refuse(building, "lose_each",
             "no such group of members: " + name + "; accepted: posts, beams, braces and the groups of the model");
    request.each.insert(request.each.end(), group->members.begin(), group->members.end());
  }
}

void request_histories(const Model& model, const std::vector<std::string>& names, MotionRequest& motion) {
  for (const std::string& name : names) {
    const std::vector<NodeId> nodes = model.names().nodes_matching(name);
    const std::vector<JointId> joints = model.names().joints_matching(name);
    if (nodes.empty() && joints.empty())
      refuse(model.building(), "history",
             "no such node or joint: " + name + "; accepted: a name, in which * stands for any run of characters");
    motion.nodes.insert(motion.nodes.end(), nodes.begin(), nodes.end());
    motion.joints.insert(motion.joints.end(), joints.begin(), joints.end());
  }
}

template <class Value>
Value one_of(const std::string& given, const char* what, std::initializer_list<std::pair<const char*, Value>> known) {
  std::string accepted;
  for (const auto& [name, value] : known) {
    if (given == name) return value;
    accepted += (accepted.empty() ? "\"" : ", \"") + std::string(name) + "\"";
  }
  throw py::value_error(std::string(what) + ": found \"" + given + "\"; accepted: " + accepted);
}

using OptionalName = std::optional<std::string>;

/// None: what the file asks for itself (a Frame3DD file does so).
solver::SecondOrder second_order_of(const OptionalName& given, const Building& building) {
  using solver::SecondOrder;
  if (!given) return building.requested.cubic_p_delta ? SecondOrder::frame3dd : SecondOrder::none;
  return one_of<SecondOrder>(
      *given, "second_order",
      {{"none", SecondOrder::none}, {"exact", SecondOrder::exact}, {"cubic", SecondOrder::cubic}});
}

void request_modes(const Building& building, std::optional<int> modes, const OptionalName& mass,
                   const OptionalName& torsional_mass, bool rotary_inertia, AnalysisRequest& request) {
  const RequestedAnalyses& own = building.requested;
  const bool frame3dd = own.modes > 0;  // its elements spin with density x J and have rotary inertia
  request.modes = modes.value_or(own.modes);
  using solver::MassDistribution;
  using solver::TorsionalMass;
  request.mass = own.lumped_mass ? MassDistribution::lumped : MassDistribution::consistent;
  request.torsional_mass = frame3dd ? TorsionalMass::torsion_constant : TorsionalMass::polar;
  request.rotary_inertia = rotary_inertia || frame3dd;
  if (mass)
    request.mass = one_of<MassDistribution>(
        *mass, "mass", {{"consistent", MassDistribution::consistent}, {"lumped", MassDistribution::lumped}});
  if (torsional_mass)
    request.torsional_mass = one_of<TorsionalMass>(
        *torsional_mass, "torsional_mass", {{"polar", TorsionalMass::polar}, {"j", TorsionalMass::torsion_constant}});
}

/// Python's callback from whatever thread tells of progress. What it raises ends no thread: it is kept, and raised when
/// the analysis is done.
class Progress {
 public:
  explicit Progress(py::object callback) : callback_(std::move(callback)) {}
  void operator()(std::string_view stage, double share) {
    const py::gil_scoped_acquire held;
    if (raised_) return;
    try {
      callback_(py::str(stage.data(), stage.size()), share);
    } catch (py::error_already_set& error) {
      raised_.emplace(std::move(error));
    }
  }
  void raise_what_it_raised() {
    if (raised_) throw py::error_already_set(std::move(*raised_));
  }

 private:
  py::object callback_;
  std::optional<py::error_already_set> raised_;
};

struct DesignOptions {
  OptionalName code;
  std::optional<double> drift_limit;
  DesignInput input;
};

DesignOptions design_options(const OptionalName& code, std::optional<double> drift_limit,
                             const std::string& effective_lengths, const std::optional<bool>& warping_held,
                             const std::map<std::string, double>& stiffeners, bool rigid_end_posts) {
  DesignOptions design{code, drift_limit, {}};
  design.input.lengths = one_of<EffectiveLengths>(effective_lengths, "effective_lengths",
                                                  {{"automatic", EffectiveLengths::automatic},
                                                   {"charts", EffectiveLengths::charts},
                                                   {"assumed", EffectiveLengths::assumed}});
  if (warping_held) design.input.warping_held = {*warping_held, *warping_held};
  design.input.stiffeners.assign(stiffeners.begin(), stiffeners.end());
  design.input.rigid_end_posts = rigid_end_posts;
  return design;
}

/// The smallest multiple of `stations` that is not below `wanted`.
int whole_multiple(int stations, int wanted) {
  return stations <= 0 ? wanted : stations * std::max(1, (wanted + stations - 1) / stations);
}

/// Without the interpreter: only numbers from here on.
std::shared_ptr<AnalysisResult> compute(const Building& building, AnalysisRequest& request,
                                        const DesignOptions& design) {
  const HostBlas host;
  auto result = std::make_shared<AnalysisResult>(structure::analyse(building, request));
  if (design.code) {
    const DesignCode code =
        one_of<DesignCode>(*design.code, "code", {{"en1993", DesignCode::en1993}, {"aisc360", DesignCode::aisc360}});
    check_design(building, code, design.drift_limit ? 1 / *design.drift_limit : usual_drift_limit, *result,
                 design.input);
  }
  return result;
}

std::shared_ptr<Analysis> run(const std::shared_ptr<Model>& model, AnalysisRequest request, const DesignOptions& design,
                              const py::object& callback) {
  auto analysis = std::make_shared<Analysis>();
  analysis->model = model;
  analysis->request = request;  // as it was asked for; a design check needs more stations
  if (design.code) {
    request.stations = whole_multiple(request.stations, design_stations);
    request.critical_sections = true;
  }
  std::optional<Progress> progress;
  if (!callback.is_none()) {
    progress.emplace(callback);
    request.progress = std::ref(*progress);
  }
  const auto start = std::chrono::steady_clock::now();
  try {
    const py::gil_scoped_release others_run;
    analysis->result = compute(model->building(), request, design);
  } catch (const UnstableAnalysis& unstable) {
    if (progress) progress->raise_what_it_raised();
    if (!unstable.partial) raise_unstable(model->building(), unstable, py::none());
    analysis->result = unstable.partial;
    raise_unstable(model->building(), unstable, py::cast(analysis));
  }
  if (progress) progress->raise_what_it_raised();
  const solver::AnalysisStatistics& statistics = analysis->result->statistics;
  analysis->seconds = {{"analyse", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()},
                       {"order", statistics.order_seconds},
                       {"assemble", statistics.assemble_seconds},
                       {"factor", statistics.factor_seconds},
                       {"solve", statistics.solve_seconds}};
  return analysis;
}

/// A path, or a dict of a column `time` and others, as a CSV file has them.
TimeHistory time_history_of(const py::object& given, const Building& building) {
  if (const auto path = path_of(given)) return read_time_history(*path, building);
  if (!py::isinstance<py::dict>(given))
    throw py::type_error("time_history: accepted: a path, or a dict of arrays: time, and ax, ay, az or load cases");
  const auto columns = given.cast<std::map<std::string, std::vector<double>>>();
  return make_time_history(columns, building);
}

std::vector<SectionCut> cuts_of(const py::object& given, const Building& building) {
  if (const auto path = path_of(given)) return read_section_cuts(*path, building);
  if (!py::isinstance<py::dict>(given)) throw py::type_error("cuts: accepted: a path, or a dict of cuts by name");
  return parse_section_cuts("{\"cuts\": " + json_text(given) + "}", "cuts", building);
}

std::shared_ptr<Analysis> analyse(const py::object& source, const py::object& combinations, int stations,
                                  const OptionalName& second_order, int buckling, std::optional<int> modes,
                                  const OptionalName& mass, const OptionalName& torsional_mass, bool rotary_inertia,
                                  const py::object& lose, const py::object& lose_each, double sudden, bool dynamic,
                                  double over, std::optional<double> duration, double damping,
                                  const py::object& history, const py::object& time_history, const py::object& cuts,
                                  const OptionalName& code, std::optional<double> drift_limit,
                                  const std::string& effective_lengths, std::optional<bool> warping_held,
                                  const std::map<std::string, double>& stiffeners, bool rigid_end_posts, int threads,
                                  const py::object& progress) {
  const std::shared_ptr<Model> model = model_of(source);
  const Building& building = model->building();
  AnalysisRequest request;
  request.combinations = combinations_named(building, names_in(combinations, "combinations"));
  request.stations = stations;
  request.workers = threads;
  request.solver.threads = threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  request.second_order = second_order_of(second_order, building);
  request.buckling = buckling;
  request_modes(building, modes, mass, torsional_mass, rotary_inertia, request);
  request.losses.sudden = sudden;
  request_losses(*model, names_in(lose, "lose"), names_in(lose_each, "lose_each"), request.losses);
  MotionRequest& motion = request.losses.motion;
  motion.asked = dynamic;
  motion.over = over;
  motion.duration = duration;
  motion.damping = damping;
  request_histories(*model, names_in(history, "history"), motion);
  if (!time_history.is_none()) request.time_history = time_history_of(time_history, building);
  request.cuts = model->cuts();
  if (!cuts.is_none())
    for (SectionCut& cut : cuts_of(cuts, building)) request.cuts.push_back(std::move(cut));
  if (dynamic && !request.losses.any())
    throw py::value_error("dynamic: nothing is lost; accepted: with lose or lose_each");
  if (request.time_history && request.losses.any())
    throw py::value_error("time_history: a loss is not followed under it; accepted: without lose and lose_each");
  return run(model, std::move(request),
             design_options(code, drift_limit, effective_lengths, warping_held, stiffeners, rigid_end_posts), progress);
}

constexpr const char* analyse_doc = R"(Analyses a building statically (what `topple analyse` does).

Other Python threads run meanwhile. The same model gives the same bits at any number of threads.

model: a Model, or what Model() takes: a shipped model's name, a path, a dict.
combinations: names or patterns of load combinations; None: all.
stations: even intervals along each member for CombinationResult.diagram(); with `code` a multiple that is 20 or more.
second_order: "none", "exact" (beam-columns) or "cubic"; None: what the file asks for itself, else "none".
buckling: lowest buckling factors to find for each combination.
modes: lowest natural frequencies to find; None: what the file asks for itself.
mass, torsional_mass, rotary_inertia: of the modes: "consistent" or "lumped"; "polar" or "j".
lose: members (names, patterns), each lost alone, with its whole state after it; lose_each: groups of members, each lost alone.
sudden: factor f of the loss: 2 is the peak of an undamped elastic system, 1 the static state.
dynamic: follow each loss through time; over: seconds through which the member is lost; duration: seconds to follow;
    damping: share of the critical damping; history: nodes and joints whose course is kept.
time_history: how the ground shakes or loads act: a CSV file, or a dict of arrays: time (s), and ax, ay, az (m/s2) or names of
    load cases (factors).
cuts: planes through the building: a JSON file as --cuts has it, or a dict of what stands under its key "cuts":
    {name: {"at": [x, y, z], "normal": [x, y, z], "along": [x, y, z], "parts": [names]}}; CombinationResult.cuts has what
    passes them, after those of the model itself (its key "cuts").
code: "en1993" or "aisc360": design checks of steel members; drift_limit: N of height/N; effective_lengths: "automatic",
    "charts" or "assumed"; warping_held; stiffeners: spacing (m) by member, pattern or group; rigid_end_posts.
threads: 0: one for each processor.
progress: called with (stage, share from 0 to 1, below 0 where nothing can tell), from any thread. What it raises is raised
    when the analysis is done.

Returns an Analysis. Raises InputError, UnstableModel (with the motion), ValueError, TypeError.)";

}  // namespace

void bind_analyse(py::module_& module) {
  module.def("analyse", &analyse, analyse_doc, py::arg("model"), py::arg("combinations") = py::none(), py::kw_only(),
             py::arg("stations") = 0, py::arg("second_order") = py::none(), py::arg("buckling") = 0,
             py::arg("modes") = py::none(), py::arg("mass") = py::none(), py::arg("torsional_mass") = py::none(),
             py::arg("rotary_inertia") = false, py::arg("lose") = py::none(), py::arg("lose_each") = py::none(),
             py::arg("sudden") = 2.0, py::arg("dynamic") = false, py::arg("over") = 0.0,
             py::arg("duration") = py::none(), py::arg("damping") = 0.02, py::arg("history") = py::none(),
             py::arg("time_history") = py::none(), py::arg("cuts") = py::none(), py::arg("code") = py::none(),
             py::arg("drift_limit") = py::none(), py::arg("effective_lengths") = "automatic",
             py::arg("warping_held") = py::none(), py::arg("stiffeners") = std::map<std::string, double>{},
             py::arg("rigid_end_posts") = false, py::arg("threads") = 0, py::arg("progress") = py::none());
}

}  // namespace topple::python
