// SPDX-License-Identifier: GPL-3.0-or-later
// Makes the properties of proxies from the descriptions of parameters, when the plugin is built:
// expand_proxies IN.xml OUT.xml. In a proxy,
//   <Parameters of="simulation" command="SetParameter"/>      is replaced by a property for each
//   parameter of that struct, <Parameter name="beam.tilt" .../>                         by that
//   one, and the struct's list then leaves it out.
// A Parameter may say what differs for ParaView: property (its name), label, default, numbers (how
// many), whole="1", min, max, level, omit="1", help (in place of the description's), entries (of a
// choice, in their order), the widget's condition show_with="Budget=1 2", documentation, which goes
// before the description's, none (the number that says nothing) and otherwise (what holds then).
// What it contains goes into the property: hints, say. Parameters may say the level of all that it
// stands for. An optional number without any of default and none has 0 for nothing, or -1 where it
// may be 0; where it may be both, it is a text.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <vector>

#include "surf/core/parameters.h"
#include "surf/core/words.h"
#include "surf/io/sim/materials.h"
#include "surf/io/sim/specimen_request.h"
#include "surf/mesh/repair_mesh.h"
#include "surf/mesh/simplify_mesh.h"
#include "surf/workflow/calibrate_job.h"
#include "surf/workflow/certainty_job.h"
#include "surf/workflow/clean_job.h"
#include "surf/workflow/compare_job.h"
#include "surf/workflow/estimate_job.h"
#include "surf/workflow/level_job.h"
#include "surf/workflow/morphology_job.h"
#include "surf/workflow/noise_job.h"
#include "surf/workflow/predict_job.h"
#include "surf/workflow/profile_job.h"
#include "surf/workflow/reconstruct_job.h"
#include "surf/workflow/register_job.h"
#include "surf/workflow/simulate_job.h"
#include "surf/workflow/tip_job.h"
#include "surf/workflow/train_job.h"

namespace {

using namespace surf;

/// What is said of a parameter, out of reach of the struct that it is of.
struct Described {
  Parameter about;
  FieldKind kind;
  std::vector<std::string> choices;
  std::string text;
};

template <class Struct>
std::vector<Described> described_as(Struct of) {
  std::vector<Described> all;
  for_each_parameter(of, [&](const Parameter& about, Field& field) {
    all.push_back({about, field.kind(), field.choices(), field.text()});
  });
  return all;
}

template <class Struct>
std::vector<Described> described() {
  return described_as(Struct{});
}

/// With a part for each image.
std::vector<Described> described_reconstruction() {
  workflow::ReconstructJob job;
  job.afm.emplace();
  job.sem.emplace();
  return described_as(job);
}

const std::map<std::string, std::function<std::vector<Described>()>>& structs() {
  static const std::map<std::string, std::function<std::vector<Described>()>> all{
      {"simulation", described<mc::SimulationRequest>},
      {"material", described<io::MaterialChoice>},
      {"train", described<workflow::TrainJob>},
      {"predict", described<workflow::PredictJob>},
      {"estimate", described<workflow::EstimateJob>},
      {"estimate_options", described<workflow::EstimateOptions>},
      {"register", described<workflow::RegisterJob>},
      {"reconstruct", described_reconstruction},
      {"profile", described<workflow::ProfileJob>},
      {"calibrate", described<workflow::CalibrateParameters>},
      {"compare", described<workflow::CompareParameters>},
      {"repair", described<RepairOptions>},
      {"simplify", described<SimplifyOptions>},
      {"tip_shape", described<workflow::TipShape>},
      {"tip_by_shape", described<workflow::TipShapeParameters>},
      {"specimen", described<io::SpecimenRequest>},
      {"extras", described<workflow::Extras>},
      {"level", described<workflow::LevelParameters>},
      {"clean", described<workflow::CleanParameters>},
      {"noise", described<workflow::ScanNoiseParameters>},
      {"tip", described<workflow::TipParameters>},
      {"certainty", described<workflow::CertaintyParameters>},
      {"morphology", described<workflow::MorphologyParameters>}};
  return all;
}

[[noreturn]] void fail(const std::string& text) {
  fmt::print(stderr, "{}\n", text);
  std::exit(1);
}

std::string with_spaces(std::string_view name) {
  std::string label;
  for (const char c : name) {
    const bool first = label.empty() || label.back() == ' ';
    label += c == '_' ? ' '
             : first  ? static_cast<char>(std::toupper(static_cast<unsigned char>(c)))
                      : c;
  }
  return label;
}

std::string joined(std::string label) {
  std::erase(label, ' ');
  return label;
}

const char* unit_word(Unit unit) {
  switch (unit) {
    case Unit::nm:
      return "nm";
    case Unit::ev:
      return "eV";
    case Unit::deg:
      return "degrees";
    case Unit::pa:
      return "pA";
    case Unit::us:
      return "us";
    case Unit::s:
      return "s";
    default:
      return "";
  }
}

/// "nm, 0 to 100, below 90": numbers as ParaView shows them, without units.
std::string range_words(const Parameter& about) {
  Parameter plain = about;
  plain.unit = Unit::none;
  const std::string limits = format_limits(plain), unit = unit_word(about.unit);
  return unit.empty() || limits.empty() ? unit + limits : unit + ", " + limits;
}

void set_range(pugi::xml_node domain, const Parameter& about, bool whole) {
  // ParaView's whole numbers end earlier than some of ours.
  const auto text = [&](double value) {
    return whole ? fmt::format("{:.0f}", value) : fmt::format("{}", value);
  };
  const auto is_there = [&](double value) {
    return std::isfinite(value) && (!whole || std::abs(value) <= std::numeric_limits<int>::max());
  };
  if (is_there(about.limits.low)) domain.append_attribute("min") = text(about.limits.low).c_str();
  if (is_there(about.limits.high)) domain.append_attribute("max") = text(about.limits.high).c_str();
}

std::string sentence(const Described& d, const std::string& own, const std::string& none) {
  std::string text = own.empty() ? d.about.help : own + " " + d.about.help;
  if (const std::string range = range_words(d.about); !range.empty() && d.kind != FieldKind::choice)
    text += "; " + range;
  if (!none.empty() && !d.about.otherwise.empty())
    text += fmt::format("; {}: {}", none, d.about.otherwise);
  return text + ".";
}

/// "0" or "-1": the number that says nothing, which the parameter cannot be; empty where it can be
/// both.
std::string none_of(const Limits& limits) {
  for (const int number : {0, -1})
    if (!limits.holds(number)) return std::to_string(number);
  return {};
}

struct Widget {
  const char* element;
  bool whole, number;
};

Widget widget_of(const Described& d, bool whole, int numbers) {
  if (d.kind == FieldKind::choice || d.kind == FieldKind::flag)
    return {"IntVectorProperty", false, false};
  if (d.kind == FieldKind::whole || whole) return {"IntVectorProperty", true, false};
  if (d.kind == FieldKind::number || numbers > 0) return {"DoubleVectorProperty", false, true};
  return {"StringVectorProperty", false, false};
}

std::string repeated(const std::string& text, int times) {
  std::string out = text;
  for (int i = 1; i < times; ++i) out += " " + text;
  return out;
}

void add_choices(pugi::xml_node property, const std::vector<std::string>& choices) {
  pugi::xml_node domain = property.append_child("EnumerationDomain");
  domain.append_attribute("name") = "enum";
  int value = 0;
  for (const std::string& choice : choices) {
    pugi::xml_node entry = domain.append_child("Entry");
    entry.append_attribute("value") = value++;
    std::string shown = choice;
    shown[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(shown[0])));
    entry.append_attribute("text") = shown.c_str();
  }
}

/// Shows the property only where another one has one of some values: "Budget=1 2".
void add_condition(pugi::xml_node property, const std::string& condition) {
  pugi::xml_node widget = property.append_child("Hints").append_child("PropertyWidgetDecorator");
  widget.append_attribute("type") = "GenericDecorator";
  widget.append_attribute("mode") = "visibility";
  widget.append_attribute("property") = condition.substr(0, condition.find('=')).c_str();
  const std::string values = condition.substr(condition.find('=') + 1);
  widget.append_attribute(values.find(' ') == values.npos ? "value" : "values") = values.c_str();
}

/// The property in place of `placeholder`, which says what differs.
void add_property(pugi::xml_node placeholder, Described d, const char* command) {
  const pugi::xml_node said = placeholder;
  const auto attribute = [&](const char* name, const std::string& usual) {
    const pugi::xml_attribute given = said.attribute(name);
    return given ? std::string(given.value()) : usual;
  };
  if (said.attribute("min")) d.about.limits.low = said.attribute("min").as_double();
  if (said.attribute("max")) d.about.limits.high = said.attribute("max").as_double();
  d.about.otherwise = attribute("otherwise", d.about.otherwise);
  d.about.help = attribute("help", d.about.help);
  const std::string label = attribute("label", with_spaces(d.about.last_name()));
  const int numbers = said.attribute("numbers").as_int(0);
  Widget widget = widget_of(d, said.attribute("whole").as_bool(), numbers);
  std::string usual = d.text, none, name = d.about.name;
  Parameter range = d.about;
  if ((widget.whole || widget.number) && usual.empty() && !said.attribute("default")) {
    none = attribute("none", d.kind == FieldKind::text ? "0" : none_of(d.about.limits));
    if (none.empty()) widget = {"StringVectorProperty", false, false};
    else range.limits.low = std::min(range.limits.low, std::stod(none));
    usual = repeated(none, numbers);
    std::string nothing = usual;
    std::ranges::replace(nothing, ' ', ',');
    if (!none.empty()) name += "=" + nothing;
  }
  if (d.kind == FieldKind::flag) usual = d.text == "on" ? "1" : "0";
  if (d.kind == FieldKind::choice) {
    const auto found = std::ranges::find(d.choices, d.text);
    usual = std::to_string(found == d.choices.end() ? 0 : found - d.choices.begin());
  }
  pugi::xml_node property = placeholder.parent().insert_child_before(widget.element, placeholder);
  property.append_attribute("name") = attribute("property", joined(label)).c_str();
  property.append_attribute("label") = label.c_str();
  property.append_attribute("command") = command;
  property.append_attribute("initial_string") = name.c_str();
  property.append_attribute("number_of_elements") = std::max(1, numbers);
  property.append_attribute("default_values") = attribute("default", usual).c_str();
  const bool advanced =
      attribute("level", d.about.level == Level::advanced ? "advanced" : "basic") == "advanced";
  if (advanced) property.append_attribute("panel_visibility") = "advanced";
  if (d.kind == FieldKind::choice) {
    std::vector<std::string> entries = d.choices;
    for (std::string& entry : entries) std::ranges::replace(entry, '-', ' ');
    if (const std::string own = said.attribute("entries").value(); !own.empty()) {
      entries.clear();
      for (const std::string_view entry : split(own, ",")) entries.emplace_back(entry);
      if (entries.size() != d.choices.size())
        fail("entries of " + d.about.name + " are not as many as its choices");
    }
    add_choices(property, entries);
  } else if (d.kind == FieldKind::flag) {
    property.append_child("BooleanDomain").append_attribute("name") = "bool";
  } else if (widget.whole || widget.number) {
    pugi::xml_node domain =
        property.append_child(widget.whole ? "IntRangeDomain" : "DoubleRangeDomain");
    domain.append_attribute("name") = "range";
    set_range(domain, range, widget.whole);
  } else if (d.about.file == FileRole::read) {
    property.append_child("FileListDomain").append_attribute("name") = "files";
  }
  const bool empty_text = std::string(widget.element) == "StringVectorProperty" && usual.empty() &&
                          !said.attribute("default");
  const std::string nothing = empty_text                     ? "empty"
                              : numbers > 1 && !none.empty() ? "all " + none
                                                             : none;
  property.append_child("Documentation")
      .append_child(pugi::node_pcdata)
      .set_value(sentence(d, said.attribute("documentation").value(), nothing).c_str());
  for (pugi::xml_node child : placeholder.children()) property.append_copy(child);
  if (const std::string condition = said.attribute("show_with").value(); !condition.empty())
    add_condition(property, condition);
}

const Described& find(const std::string& name, const std::vector<std::string>& of) {
  static std::map<std::string, std::vector<Described>> all;
  for (const std::string& one : of) {
    if (!structs().contains(one)) fail("no parameters of " + one);
    auto& list = all[one];
    if (list.empty()) list = structs().at(one)();
    for (const Described& d : list)
      if (d.about.name == name) return d;
  }
  fail("no parameter " + name);
}

void expand(pugi::xml_node proxy) {
  std::vector<pugi::xml_node> single, lists;
  // A parameter is looked for in the proxy's own structs first.
  std::vector<std::string> order;
  for (pugi::xml_node child : proxy.children()) {
    if (std::string(child.name()) == "Parameter") single.push_back(child);
    if (std::string(child.name()) != "Parameters") continue;
    lists.push_back(child);
    order.emplace_back(child.attribute("of").value());
  }
  for (const auto& [name, make] : structs()) order.push_back(name);
  std::set<std::string> done;
  for (pugi::xml_node placeholder : single) {
    const Described& d = find(placeholder.attribute("name").value(), order);
    done.insert(d.about.name);
    if (!placeholder.attribute("omit").as_bool()) add_property(placeholder, d, "SetParameter");
  }
  for (pugi::xml_node placeholder : lists) {
    const bool advanced = std::string(placeholder.attribute("level").value()) == "advanced";
    for (Described d : structs().at(placeholder.attribute("of").value())()) {
      if (advanced) d.about.level = Level::advanced;
      if (d.about.last_name() != "threads" && done.insert(d.about.name).second)
        add_property(placeholder, d, "SetParameter");
    }
  }
  for (pugi::xml_node placeholder : single) proxy.remove_child(placeholder);
  for (pugi::xml_node placeholder : lists) proxy.remove_child(placeholder);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) fail("usage: expand_proxies IN.xml OUT.xml");
  pugi::xml_document document;
  const auto read = document.load_file(arguments[1]);
  if (!read) fail(fmt::format("{}: {}", arguments[1], read.description()));
  for (pugi::xml_node group : document.child("ServerManagerConfiguration").children())
    for (pugi::xml_node proxy : group.children()) expand(proxy);
  if (!document.save_file(arguments[2], "  "))
    fail(fmt::format("{}: cannot be written", arguments[2]));
  return 0;
}
