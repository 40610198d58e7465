// Samples as lines of journal.jsonl, and as a table.
#include <cstdio>
#include <limits>

#include "formats/json/json_document.h"
#include "formats/json/json_writer.h"
#include "formats/tables/formula_guard.h"
#include "study/study_value.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace study {

std::string number_text(double number) {
  JsonWriter writer;
  return writer.value(number).release();
}

std::string hexadecimal(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

}  // namespace study

namespace {

using formats::JsonValue;

constexpr std::string_view before_check = ",\"check\":\"", after_check = "\"}";

std::uint64_t check_of(const StudyTask& task, std::string_view text) {
  return study::fnv1a(text, study::fnv1a(study::hexadecimal(task.fingerprint)));
}

/// A cell of a table: quoted where it has to be.
std::string cell(std::string_view given) {
  const std::string text = formats::guarded(given);
  if (text.find_first_of(",\"\n\r;\t") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

Sample sample_of(const JsonValue& line) {
  Sample sample;
  constexpr std::int64_t most = std::int64_t{1} << 53;
  sample.number = static_cast<std::uint64_t>(line.require("sample").whole(0, most));
  for (const JsonValue value : line.require("inputs")) {
    StudyValue& input = sample.inputs.emplace_back();
    value.is_number() ? void(input.number = value.number()) : void(input.json = text_of(value));
  }
  if (const auto failed = line.find("failed")) {
    sample.failed = failed->text();
    return sample;
  }
  for (const JsonValue value : line.require("outputs"))
    sample.outputs.push_back(value.is_number() ? value.number() : std::numeric_limits<double>::quiet_NaN());
  if (const auto parts = line.find("parts")) sample.parts = parts->text();
  return sample;
}

}  // namespace

std::string journal_line(const StudyTask& task, const Sample& sample) {
  JsonWriter line;
  line.open('{').key("sample").value(static_cast<std::size_t>(sample.number)).key("inputs").open('{');
  const auto& variables = task.sampler.variables();
  for (std::size_t v = 0; v < variables.size(); ++v) {
    line.key(variables[v].name);
    const StudyValue& value = sample.inputs[v];
    value.is_number() ? line.value(value.number) : line.raw_value(value.json).follow();
  }
  line.close('}');
  if (sample.failed.empty()) {
    line.key("outputs").open('{');
    for (std::size_t i = 0; i < task.outputs.size(); ++i) line.key(task.outputs[i]).value(sample.outputs[i]);
    line.close('}');
    if (!sample.parts.empty()) line.key("parts").value(sample.parts);
  } else {
    line.key("failed").value(sample.failed);
  }
  std::string text = line.release();
  const std::uint64_t check = check_of(task, text);
  return text.append(before_check).append(study::hexadecimal(check)).append(after_check);
}

std::optional<Sample> read_journal_line(const StudyTask& task, std::string_view line) {
  constexpr std::size_t tail = before_check.size() + 16 + after_check.size();
  if (line.size() < tail) return std::nullopt;
  const std::string_view body = line.substr(0, line.size() - tail), end = line.substr(line.size() - tail);
  const std::string expected = study::hexadecimal(check_of(task, body));
  if (!end.starts_with(before_check) || !end.ends_with(after_check) ||
      end.substr(before_check.size(), expected.size()) != expected)
    return std::nullopt;
  try {
    Sample sample = sample_of(formats::JsonDocument::from_text(std::string(body) + "}", "journal").root());
    const bool all = sample.inputs.size() == task.sampler.variables().size() &&
                     (!sample.failed.empty() || sample.outputs.size() == task.outputs.size());
    return all ? std::optional(std::move(sample)) : std::nullopt;
  } catch (const InputError&) {  // a line of something else
    return std::nullopt;
  }
}

std::string samples_csv(const StudyTask& task, std::span<const Sample> samples) {
  std::string text = "sample";
  for (const StudyVariable& variable : task.sampler.variables()) text += "," + cell(variable.name);
  for (const std::string& output : task.outputs) text += "," + cell(output);
  text += ",failed\n";
  for (const Sample& sample : samples) {
    text += std::to_string(sample.number);
    for (const StudyValue& value : sample.inputs) {
      std::string_view shown = value.json;
      if (shown.size() >= 2 && shown.front() == '"') shown = shown.substr(1, shown.size() - 2);
      text += "," + (value.is_number() ? study::number_text(value.number) : cell(shown));
    }
    for (std::size_t i = 0; i < task.outputs.size(); ++i) {
      text += ',';
      if (sample.failed.empty() && std::isfinite(sample.outputs[i])) text += study::number_text(sample.outputs[i]);
    }
    text += "," + cell(sample.failed) + "\n";
  }
  return text;
}

}  // namespace topple::structure
