// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfWriter.h"

#include <vtkErrorCode.h>
#include <vtkInformation.h>
#include <vtkMultiProcessController.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include "attempt.h"
#include "pipeline.h"
#include "upstream.h"

void vtkSemsurfWriter::SetFileName(const char* name) {
  const std::string value = name ? name : "";
  if (value == this->FileName) return;
  this->FileName = value;
  this->Modified();
}

vtkTypeBool vtkSemsurfWriter::ProcessRequest(vtkInformation* request, vtkInformationVector** inputs,
                                             vtkInformationVector* outputs) {
  if (!request->Has(vtkStreamingDemandDrivenPipeline::REQUEST_UPDATE_EXTENT()))
    return this->Superclass::ProcessRequest(request, inputs, outputs);
  surf::pv::request_whole(inputs, this->GetNumberOfInputPorts());
  return 1;
}

void vtkSemsurfWriter::WriteData() {
  auto* const ranks = vtkMultiProcessController::GetGlobalController();
  if (ranks && ranks->GetLocalProcessId() != 0) return;
  const auto write = [&] {
    std::vector<surf::io::FileUse> outputs;
    for (const auto& file : surf::io::files_written_with(this->FileName))
      outputs.push_back({"File Name", file, {}});
    surf::pv::refuse_overlaps(this, outputs);
    this->WriteFile();
  };
  if (!surf::pv::attempt(this, write)) this->SetErrorCode(vtkErrorCode::UnknownError);
}
