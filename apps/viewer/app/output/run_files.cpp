#include "app/output/run_files.h"

#include <chrono>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include "app/output/gltf_scene.h"
#include "app/output/html_replay.h"
#include "app/output/usd_scene.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/output_files.h"

namespace topple::viewer {
namespace {

using Export = std::function<void(const structure::Building&, const Recording&, const std::string&)>;
Export export_for(const std::string& file) {
  const std::string ending = std::filesystem::path(file).extension().string();
  if (ending == ".html") return write_html_replay;
  if (ending == ".usda")
    return [](const auto& building, const auto& run, const auto& to) { write_usd(building, run, to); };
  if (ending == ".glb")
    return [](const auto& building, const auto& run, const auto& to) { write_gltf(building, run, to); };
  throw structure::InputError("export to '" + file + "': accepted endings: .html, .usda, .glb");
}

}  // namespace

void RunFiles::save(const std::string& file) {
  const auto bytes = std::make_shared<std::promise<std::string>>();
  auto saved = bytes->get_future();
  driver_.order([bytes](Session& session) { bytes->set_value(session.save()); });
  // A run that has stopped with an error carries out no orders.
  if (saved.wait_for(std::chrono::seconds(30)) != std::future_status::ready)
    throw std::runtime_error("the run does not answer: nothing is saved");
  structure::write_file(file, saved.get());
  message_ = "saved to " + file;
}

void RunFiles::load(const std::string& file) {
  const structure::Snapshot saved = structure::read_snapshot(file);
  playback_.seek_present();
  driver_.order_and_show([saved](Session& session) { session.load(saved); });
  message_ = "taken up from " + file;
}

void RunFiles::export_run(const std::string& file) {
  const Export write = export_for(file);
  if (exporting_.valid()) finish_export();
  const auto written = std::make_shared<std::promise<std::string>>();
  exporting_ = written->get_future();
  message_ = "writing " + file + " ...";
  // Between two steps: nothing is added to the recording meanwhile.
  driver_.order([written, write, file](Session& session) {
    try {
      write(session.building(), *session.recording(), file);
      written->set_value(file);
    } catch (...) {
      written->set_exception(std::current_exception());
    }
  });
}

void RunFiles::finish_export() {
  if (exporting_.valid()) message_ = "run written to " + exporting_.get();
}

void RunFiles::print_exported() {
  if (!exporting_.valid() || exporting_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  try {
    finish_export();
  } catch (const std::exception& failed) {
    message_ = failed.what();
  }
}

}  // namespace topple::viewer
