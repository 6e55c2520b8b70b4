// SPDX-License-Identifier: GPL-3.0-or-later
// Properties that are written by hand have defaults of their own, in XML. They are those of the
// plugin's classes, and where the library has such an option those of its struct. The files are
// read as text: no ParaView is needed.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <pugixml.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "surf/io/surface_file.h"

namespace surf {
namespace {

namespace fs = std::filesystem;
using Numbers = std::vector<double>;

const fs::path plugin = SEMSURF_PARAVIEW_PLUGIN;

std::string text_of(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

Numbers numbers_in(std::string text) {
  for (char& c : text)
    if (c == ',' || c == '{' || c == '}') c = ' ';
  std::istringstream in(text);
  return {std::istream_iterator<double>(in), {}};
}

/// Numbers that a class's members begin with, by name; enumerators count as theirs.
std::map<std::string, Numbers> members_of(const std::string& class_name) {
  const std::string text = text_of(plugin / "src" / (class_name + ".h"));
  std::map<std::string, double> enumerators{{"true", 1}, {"false", 0}};
  static const std::regex lists(R"(enum \w*\s*\{([^}]*)\})"), names(R"(\w+)");
  for (std::sregex_iterator list(text.begin(), text.end(), lists), end; list != end; ++list) {
    const std::string inside = (*list)[1];
    double number = 0;
    for (std::sregex_iterator name(inside.begin(), inside.end(), names); name != end; ++name)
      enumerators[name->str()] = number++;
  }
  std::map<std::string, Numbers> members;
  static const std::regex initialised(R"(\b([A-Z]\w*)(?:\[\d\])? = (\{[^}]*\}|[^,;{"]+)(?=[,;]))");
  for (std::sregex_iterator it(text.begin(), text.end(), initialised), end; it != end; ++it) {
    const std::string value = (*it)[2];
    members[(*it)[1]] =
        enumerators.contains(value) ? Numbers{enumerators[value]} : numbers_in(value);
  }
  static const std::regex parent(R"(class VTKSEMSURF_EXPORT \w+ : public (vtkSemsurf\w+))");
  if (std::smatch found; std::regex_search(text, found, parent))
    members.merge(members_of(found[1]));
  return members;
}

struct Property {
  std::string proxy, class_name, name, member, documentation;
  Numbers values;
};

/// All with numbers that a setter of its own takes.
std::vector<Property> properties() {
  std::vector<Property> out;
  std::map<std::string, std::string> class_of_base;
  for (const auto& entry : fs::directory_iterator(plugin / "xml")) {
    pugi::xml_document document;
    EXPECT_TRUE(document.load_file(entry.path().c_str())) << entry.path();
    for (const pugi::xpath_node& found :
         document.select_nodes("//*[@default_values and starts-with(@command, 'Set')]")) {
      const pugi::xml_node node = found.node(), proxy = node.parent();
      const std::string type = node.name(), command = node.attribute("command").value();
      if ((type != "IntVectorProperty" && type != "DoubleVectorProperty") ||
          command == "SetInputArrayToProcess")
        continue;
      out.push_back({proxy.attribute("name").value(), proxy.attribute("class").value(),
                     node.attribute("name").value(), command.substr(3),
                     node.child("Documentation").text().get(),
                     numbers_in(node.attribute("default_values").value())});
    }
  }
  return out;
}

TEST(ParaViewDefaults, AreThoseOfTheClasses) {
  // A proxy may begin elsewhere than its class: the operation that it is.
  const std::set<std::string> own{"SemsurfErode.Operation", "SemsurfDilate.Operation",
                                  "SemsurfOpen.Operation", "SemsurfClose.Operation"};
  std::size_t compared = 0;
  std::map<std::string, std::map<std::string, Numbers>> members;
  for (const Property& p : properties()) {
    const std::string name = p.proxy + "." + p.name;
    if (own.contains(name)) continue;
    // A base of proxies has no class of its own.
    const std::string class_name =
        p.class_name.empty() ? "vtk" + p.proxy.substr(0, p.proxy.find("Base")) : p.class_name;
    if (!members.contains(class_name)) members[class_name] = members_of(class_name);
    const auto& of_class = members[class_name];
    if (!of_class.contains(p.member)) {
      ADD_FAILURE() << name << ": " << class_name << " has no member " << p.member
                    << " with a value";
      continue;
    }
    EXPECT_EQ(p.values, of_class.at(p.member)) << name;
    ++compared;
  }
  EXPECT_GT(compared, 50u);
}

TEST(ParaViewDefaults, AreThoseOfTheLibrary) {
  const io::Magnification magnification;
  const std::map<std::string, double> known{
      {"SemsurfSurfaceWriter.Magnification", magnification.factor},
      {"SemsurfSurfaceWriter.ZExaggeration", magnification.z_exaggeration},
  };
  std::set<std::string> seen;
  for (const Property& p : properties()) {
    const std::string name = p.proxy + "." + p.name;
    if (!known.contains(name)) continue;
    seen.insert(name);
    EXPECT_THAT(p.values, testing::ElementsAre(known.at(name))) << name;
  }
  for (const auto& [name, value] : known)
    EXPECT_TRUE(seen.contains(name)) << "there is no " << name;
}

TEST(ParaViewDefaults, TooltipsSayWhatStandsForTheUsual) {
  // "0: 600" and the like: the value that the panel begins with, and what it stands for.
  std::set<std::string> said;
  static const std::regex stands_for(R"((?:^|[ ;,])(-?\d+|none): (\d[\d.]*)(?=[ ,;.]|\.<))");
  for (const Property& p : properties()) {
    for (std::sregex_iterator it(p.documentation.begin(), p.documentation.end(), stands_for), end;
         it != end; ++it) {
      std::string number = (*it)[2];
      while (number.ends_with('.')) number.pop_back();
      said.insert(fmt::format("{}.{} {}: {}", p.proxy, p.name, (*it)[1].str(), number));
    }
  }
  // No struct holds these: choices made where they are used, and nm of files that do not say.
  EXPECT_THAT(said, testing::UnorderedElementsAre("SemsurfToSurface.Thickness 0: 5",
                                                  "SemsurfScanReader.ZUnit 0: 1",
                                                  "SemsurfScanReader.PixelSize 0: 1"));
}

}  // namespace
}  // namespace surf
