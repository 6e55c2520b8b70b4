// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfSceneReader.h"

#include <fmt/format.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkObjectFactory.h>

#include <filesystem>
#include <utility>

#include "attempt.h"
#include "convert/mesh.h"
#include "convert/specimen.h"
#include "pipeline.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/sim/scene_file.h"

vtkStandardNewMacro(vtkSemsurfSceneReader);

using namespace surf;

int vtkSemsurfSceneReader::RequestData(vtkInformation*, vtkInformationVector**,
                                       vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    vtkInformation* const output = outputs->GetInformationObject(0);
    if (!pv::is_first_piece(output)) return;
    if (!this->FileName || !*this->FileName)
      throw UsageError("FileName", "no file is named", "Name one");
    io::SceneFile scene;
    pv::work(this, [&](const Watch&) { scene = io::read_scene(this->FileName); });
    for (const std::string& note : scene.notes) pv::warn(this, note);
    auto* const blocks = vtkMultiBlockDataSet::GetData(output);
    mc::Specimen& specimen = scene.specimen;
    const auto name_of = [&](int material) {
      return specimen.materials.at(static_cast<std::size_t>(material)).name;
    };
    unsigned number = 0;
    const auto add = [&](vtkDataObject* data, const std::string& name, int material) {
      pv::add_texts(data, {{pv::material_text, name_of(material)}});
      blocks->SetBlock(number, data);
      blocks->GetMetaData(number)->Set(vtkCompositeDataSet::NAME(), name.c_str());
      ++number;
    };
    if (auto& field = specimen.height_field) {
      const auto image = pv::to_vtk(std::move(field->field));
      pv::add_texts(image, {{pv::edge_text, field->edge == Edge::mirror ? "mirror"
                                            : field->edge == Edge::flat ? "flat"
                                                                        : "periodic"}});
      add(image, field->name.empty() ? "height field" : field->name, field->material);
    }
    for (mc::Body& body : specimen.bodies)
      add(pv::to_vtk(std::move(body.mesh)), body.name, body.material);
    std::map<std::string, std::string> texts{
        {"title", scene.title},
        {"beam.energy_ev", format_exact(scene.beam.energy_ev)},
        {pv::scene_text, std::filesystem::absolute(this->FileName).string()}};
    if (specimen.substrate) {
      texts[pv::substrate_text] = name_of(specimen.substrate->material);
      texts[pv::substrate_top_text] = format_exact(specimen.substrate->top_nm);
    }
    pv::add_texts(blocks, texts);
  });
}
