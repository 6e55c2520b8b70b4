// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfTipReader.h"

#include <vtkObjectFactory.h>

#include "convert/tip.h"
#include "surf/io/tip_file.h"

vtkStandardNewMacro(vtkSemsurfTipReader);

vtkSmartPointer<vtkImageData> vtkSemsurfTipReader::Read() {
  return surf::pv::to_vtk(surf::io::read_tip(this->FileName));
}
