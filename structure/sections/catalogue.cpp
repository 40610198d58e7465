#include "sections/catalogue.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <map>
#include <string>

#include "sections/shape_properties.h"

namespace topple::structure {

/// Contents of catalogue.csv, built into the library.
extern const char* const catalogue_csv;

namespace {

std::string normalised(std::string_view name) {
  std::string result;
  for (const char c : name) {
    if (c == ' ') continue;
    result += c == '/' || c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return result;
}

std::string_view next_part(std::string_view& rest, char separator) {
  const auto end = rest.find(separator);
  const std::string_view part = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
  return part;
}

/// Lines of the table by normalised name.
std::map<std::string, std::string_view> index_lines() {
  std::map<std::string, std::string_view> lines;
  std::string_view rest = catalogue_csv;
  bool header = true;
  while (!rest.empty()) {
    const std::string_view line = next_part(rest, '\n');
    if (line.empty() || line.front() == '#') continue;
    if (!header) lines.emplace(normalised(line.substr(0, line.find(','))), line);
    header = false;
  }
  return lines;
}

/// name,shape,depth,width,web,flange,fillet,thickness,area,Iy,Iz,J,plastic_modulus_y,plastic_modulus_z
Section from_line(std::string_view line) {
  Section section;
  section.catalogue = next_part(line, ',');
  section.shape = next_part(line, ',') == "I" ? Section::Shape::I : Section::Shape::box;
  std::array<double, 12> value{};
  for (double& v : value) {
    const std::string_view part = next_part(line, ',');
    std::from_chars(part.data(), part.data() + part.size(), v);
  }
  section.depth = value[0];
  section.width = value[1];
  section.web = value[2];
  section.flange = value[3];
  section.fillet = value[4];
  section.thickness = value[5];
  compute_properties(section);
  section.area = value[6];
  section.Iy = value[7];
  section.Iz = value[8];
  section.J = value[9];
  section.plastic_modulus_y = value[10];
  section.plastic_modulus_z = value[11];
  if (section.shape == Section::Shape::I) section.torsion_modulus = section.J / std::max(section.flange, section.web);
  compute_plastic_shear_areas(section);
  return section;
}

}  // namespace

std::optional<Section> find_in_catalogue(std::string_view name) {
  static const std::map<std::string, std::string_view> lines = index_lines();
  const auto found = lines.find(normalised(name));
  if (found == lines.end()) return std::nullopt;
  return from_line(found->second);
}

}  // namespace topple::structure
