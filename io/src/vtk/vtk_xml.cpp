// SPDX-License-Identifier: GPL-3.0-or-later
// The only source that knows pugixml.
#include "vtk_xml.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <pugixml.hpp>

#include "files/damaged.h"
#include "files/text_scanner.h"
#include "surf/core/error.h"
#include "vtk_data.h"

namespace surf::io {

struct VtkXml::Impl {
  std::string file;
  std::string type;
  pugi::xml_document document;
  VtkEncoding encoding;
  std::string compressor;     // empty: none
  std::string_view appended;  // behind the underscore
  VtkEncoding::Data appended_data = VtkEncoding::Data::raw;
};

struct VtkXml::Element::Node {
  pugi::xml_node xml;
};

namespace {

bool is_array(const pugi::xml_node& node) {
  return !std::strcmp(node.name(), "DataArray") || !std::strcmp(node.name(), "Array");
}

/// Characters ended by 0, as VTK stores texts; what follows the last 0 is a text, too.
std::vector<std::string> split_texts(const std::vector<double>& characters) {
  std::vector<std::string> texts;
  std::string text;
  for (const double c : characters) {
    if (c == 0) {
      texts.push_back(text);
      text.clear();
    } else if (c >= -128 && c <= 255) {
      text += static_cast<char>(static_cast<int>(c));
    }
  }
  if (!text.empty()) texts.push_back(text);
  return texts;
}

}  // namespace

VtkXml::VtkXml(const std::string& file, std::string_view content, const std::string& type)
    : impl_(new Impl{.file = file, .type = type}) {
  // Appended raw bytes are not XML: they are taken away first.
  std::string text;
  const std::size_t appendix = content.find("<AppendedData");
  if (appendix != std::string_view::npos) {
    const std::string_view rest = content.substr(appendix);
    const std::size_t start = rest.find('>');
    const std::size_t mark = rest.find('_', start);
    if (start == rest.npos || mark == rest.npos) fail({}, "its appended data is cut off");
    const std::string_view tag = rest.substr(0, start);
    impl_->appended_data =
        tag.find("raw") != tag.npos ? VtkEncoding::Data::raw : VtkEncoding::Data::base64;
    impl_->appended = rest.substr(mark + 1);
    text = std::string(content.substr(0, appendix)) + "</VTKFile>";
    content = text;
  }
  const pugi::xml_parse_result result = impl_->document.load_buffer(content.data(), content.size());
  if (!result) {
    fail({}, fmt::format("its XML is broken at byte {}: {}", result.offset, result.description()));
  }
  const pugi::xml_node root = impl_->document.child("VTKFile");
  if (!root.child(type.c_str())) fail({}, fmt::format("it is not a VTK file of type {}", type));
  impl_->encoding.big_endian = root.attribute("byte_order").as_string() == std::string("BigEndian");
  impl_->encoding.long_header = root.attribute("header_type").as_string() == std::string("UInt64");
  impl_->compressor = root.attribute("compressor").as_string();
  impl_->encoding.compressed = !impl_->compressor.empty();
}

VtkXml::~VtkXml() = default;

void VtkXml::fail(const std::string& place, const std::string& reason) const {
  throw FileError(place.empty() ? impl_->file : fmt::format("{}, {}", impl_->file, place), reason,
                  copy_again);
}

VtkXml::Element VtkXml::data() const {
  const pugi::xml_node node = impl_->document.child("VTKFile").child(impl_->type.c_str());
  return {*this, std::make_shared<const Element::Node>(Element::Node{node})};
}

void VtkXml::Element::fail(const std::string& reason) const {
  std::string place = node_->xml.name();
  if (const std::string name = attribute("Name"); !name.empty()) {
    place += fmt::format(" '{}'", shown(name));
  }
  xml_->fail(place, reason);
}

std::vector<VtkXml::Element> VtkXml::Element::children(const char* name) const {
  std::vector<Element> found;
  for (const pugi::xml_node& child : node_->xml.children(name)) {
    found.push_back({*xml_, std::make_shared<const Node>(Node{child})});
  }
  return found;
}

std::optional<VtkXml::Element> VtkXml::Element::child(const char* name) const {
  const pugi::xml_node found = node_->xml.child(name);
  if (!found) return {};
  return Element(*xml_, std::make_shared<const Node>(Node{found}));
}

std::string VtkXml::Element::attribute(const char* name) const {
  return node_->xml.attribute(name).as_string();
}

std::string VtkXml::Element::text() const {
  const std::string_view text = node_->xml.text().get();
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  if (start == text.npos) return {};
  return std::string(text.substr(start, text.find_last_not_of(" \t\r\n") + 1 - start));
}

std::uint64_t VtkXml::Element::count(const char* name) const {
  const double value = numbers(name, {0})[0];
  if (!(value >= 0 && value <= 0x1p53 && value == std::floor(value))) {
    fail(fmt::format("{} is '{}'", name, shown(attribute(name))));
  }
  return static_cast<std::uint64_t>(value);
}

std::vector<double> VtkXml::Element::numbers(const char* name,
                                             const std::vector<double>& fallback) const {
  if (!node_->xml.attribute(name)) return fallback;
  std::vector<double> values;
  try {
    values = vtk_numbers_of_text(attribute(name));
  } catch (const BadVtkData&) {
  }
  if (values.size() != fallback.size()) {
    fail(fmt::format("{} is '{}', where {} numbers belong", name, shown(attribute(name)),
                     fallback.size()));
  }
  return values;
}

std::vector<double> VtkXml::Element::values(const std::string& type) const {
  const Impl& impl = *xml_->impl_;
  std::string_view text = node_->xml.text().get();
  const std::string format = attribute("format");
  if (format == "ascii") return vtk_numbers_of_text(text);
  if (impl.encoding.compressed && impl.compressor != "vtkZLibDataCompressor") {
    throw Unsupported(impl.file, fmt::format("it is compressed with {}", shown(impl.compressor)),
                      "Save it with the compressor ZLib, or with none");
  }
  VtkEncoding encoding = impl.encoding;
  if (format == "appended") {
    const std::uint64_t offset = count("offset");
    if (offset > impl.appended.size()) throw BadVtkData("its data is cut off");
    encoding.data = impl.appended_data;
    text = impl.appended.substr(offset);
  }
  return vtk_numbers(decode_vtk_bytes(text, encoding), type, encoding.big_endian);
}

VtkArray VtkXml::Element::decoded() const {
  VtkArray array;
  array.name = attribute("Name");
  const std::string type = attribute("type");
  const double components = numbers("NumberOfComponents", {1})[0];
  if (!(components >= 1 && components <= 1000 && components == std::floor(components))) {
    fail("its number of components is wrong");
  }
  array.components = static_cast<std::size_t>(components);
  try {
    array.values = values(type);
  } catch (const BadVtkData& error) {
    fail(error.what());
  }
  if (type == "String") {
    array.is_text = true;
    array.texts = split_texts(array.values);
    array.values.clear();
  } else if (array.values.size() % array.components != 0) {
    fail(
        fmt::format("{} values are not whole groups of {}", array.values.size(), array.components));
  }
  return array;
}

std::vector<VtkArray> VtkXml::Element::arrays() const {
  std::vector<VtkArray> result;
  for (const pugi::xml_node& child : node_->xml.children()) {
    if (!is_array(child)) continue;
    result.push_back(Element(*xml_, std::make_shared<const Node>(Node{child})).decoded());
  }
  return result;
}

std::optional<VtkArray> VtkXml::Element::array(std::string_view name) const {
  for (const pugi::xml_node& child : node_->xml.children()) {
    if (!is_array(child)) continue;
    const Element element(*xml_, std::make_shared<const Node>(Node{child}));
    if (name.empty() || element.attribute("Name") == name) return element.decoded();
  }
  return {};
}

}  // namespace surf::io
