// SPDX-License-Identifier: GPL-3.0-or-later
#include "convert/specimen.h"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "convert/image.h"
#include "convert/mesh.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/sim/materials.h"
#include "surf/io/sim/scene_file.h"

namespace surf::pv {
namespace {

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words{""};
  for (const char c : text) {
    if (c == ',' || c == ';') words.emplace_back();
    else if (c != ' ' || !words.back().empty()) words.back() += c;
  }
  for (std::string& word : words) word.erase(word.find_last_not_of(' ') + 1);
  std::erase(words, "");
  return words;
}

class Maker {
 public:
  explicit Maker(const SpecimenWish& wish) : wish_(wish), names_(words_of(wish.materials)) {
    std::vector<std::string> notes;
    if (!wish.material_file.empty()) library_.read(wish.material_file, notes);
    if (names_.empty()) throw UsageError("Materials", "no material is named", "Name one, as Si");
  }

  /// Materials that only the scene knows come from its file.
  void set_scene(const std::map<std::string, std::string>& texts) {
    if (const auto file = texts.find(scene_text); file != texts.end()) scene_file_ = file->second;
  }

  void add(vtkDataObject* data, const std::string& name, vtkDataArray* heights) {
    if (auto* const image = vtkImageData::SafeDownCast(data)) add_field(image, name, heights);
    else if (auto* const surface = vtkPolyData::SafeDownCast(data)) add_bodies(surface, name);
    else
      throw InvalidInput(name, fmt::format("it is a {}, no surface", data->GetClassName()),
                         "'Extract Surface' makes one of cells");
  }

  void add_substrate(const std::map<std::string, std::string>& texts) {
    const auto said = [&](const char* key) {
      return texts.contains(key) ? texts.at(key) : std::string();
    };
    const bool own = wish_.substrate.empty();
    const std::string name = own ? said(substrate_text) : wish_.substrate;
    if (name.empty()) return;
    const std::string top = said(substrate_top_text);
    specimen.substrate = mc::Substrate{
        index_of(name, "Substrate"),
        own && !top.empty() ? parse_length_nm(top, "substrate") : wish_.substrate_top_nm};
  }

  mc::Specimen specimen;

 private:
  void add_field(vtkImageData* image, const std::string& name, vtkDataArray* heights) {
    if (specimen.height_field)
      throw InvalidInput(name, "there is an image of heights already",
                         "Give one at most, or make surfaces of them");
    if (!heights) heights = image->GetPointData()->GetArray(heights_name);
    if (!heights) heights = image->GetPointData()->GetScalars();
    specimen.height_field = mc::HeightFieldBody{name, to_height_field(image, heights, name.c_str()),
                                                material_of(texts_of(image), ""), wish_.edge};
    const auto texts = texts_of(image);
    if (const auto edge = texts.find(edge_text); edge != texts.end())
      specimen.height_field->edge = edge->second == "flat"       ? Edge::flat
                                    : edge->second == "periodic" ? Edge::periodic
                                                                 : Edge::mirror;
  }

  void add_bodies(vtkPolyData* data, const std::string& name) {
    if (data->GetNumberOfPolys() + data->GetNumberOfStrips() == 0)
      return;  // lines, or a block without a part here
    const auto texts = texts_of(data);
    vtkDataArray* const numbers = data->GetCellData()->GetArray("surface");
    std::set<double> which;
    if (numbers && numbers->GetNumberOfComponents() == 1 &&
        data->GetNumberOfPolys() == data->GetNumberOfCells())
      for (vtkIdType i = 0; i < numbers->GetNumberOfTuples(); ++i)
        which.insert(numbers->GetComponent(i, 0));
    // Corners at equal places are one: ParaView's sources give each face its own.
    if (which.size() < 2) {
      specimen.bodies.push_back(
          {name, merge_equal_vertices(to_mesh(data, name.c_str())), material_of(texts, "")});
      return;
    }
    for (const double number : which) {
      vtkNew<vtkPolyData> part;
      part->SetPoints(data->GetPoints());
      vtkNew<vtkCellArray> polygons;
      vtkNew<vtkIdList> corners;
      for (vtkIdType i = 0; i < data->GetNumberOfPolys(); ++i) {
        if (numbers->GetComponent(i, 0) != number) continue;
        data->GetPolys()->GetCellAtId(i, corners);
        polygons->InsertNextCell(corners);
      }
      part->SetPolys(polygons);
      const std::string of = fmt::format("{} {:g}", name, number);
      specimen.bodies.push_back({of, merge_equal_vertices(to_mesh(part, of.c_str())),
                                 material_of(texts, fmt::format(":{:g}", number))});
    }
  }

  /// What the data say, else the next name of the wish.
  int material_of(const std::map<std::string, std::string>& texts, const std::string& which) {
    const auto said = texts.find(material_text + which);
    if (said != texts.end()) return index_of(said->second, "Materials");
    const std::size_t next = std::min(unsaid_++, names_.size() - 1);
    return index_of(names_[next], "Materials");
  }

  int index_of(const std::string& name, const char* subject) {
    auto& all = specimen.materials;
    const auto found = std::ranges::find(all, name, &mc::Material::name);
    if (found != all.end()) return static_cast<int>(found - all.begin());
    const auto knows = [&] {
      return std::ranges::count(library_.all(), name, &mc::Material::name) > 0;
    };
    if (!knows() && !scene_file_.empty()) library_ = io::read_scene(scene_file_).materials;
    all.push_back(library_.find(name, subject));
    return static_cast<int>(all.size()) - 1;
  }

  const SpecimenWish& wish_;
  io::MaterialLibrary library_;
  std::string scene_file_;
  std::vector<std::string> names_;
  std::size_t unsaid_ = 0;
};

}  // namespace

mc::Specimen to_specimen(vtkDataObject* data, vtkDataArray* heights, const SpecimenWish& wish) {
  Maker maker(wish);
  maker.set_scene(texts_of(data));
  if (auto* const blocks = vtkCompositeDataSet::SafeDownCast(data)) {
    const auto each = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
    int number = 0;
    for (each->InitTraversal(); !each->IsDoneWithTraversal(); each->GoToNextItem()) {
      vtkInformation* const about =
          each->HasCurrentMetaData() ? each->GetCurrentMetaData() : nullptr;
      const bool named = about && about->Has(vtkCompositeDataSet::NAME());
      maker.add(each->GetCurrentDataObject(),
                named ? about->Get(vtkCompositeDataSet::NAME()) : fmt::format("block {}", number),
                nullptr);
      ++number;
    }
  } else {
    maker.add(data, "Input", heights);
  }
  maker.add_substrate(texts_of(data));
  const mc::Specimen& s = maker.specimen;
  if (s.bodies.empty() && !s.height_field && !s.substrate)
    throw InvalidInput("Input", "it has no surface",
                       "Give one, an image of heights, or blocks of them");
  return std::move(maker.specimen);
}

}  // namespace surf::pv
