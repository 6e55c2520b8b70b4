// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vtkAbstractArray.h>
#include <vtkCallbackCommand.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <string>

namespace surf::io::vtk {

/// Collects VTK's error messages, which would otherwise only be printed.
class VtkComplaints {
 public:
  VtkComplaints() {
    command_->SetClientData(&text_);
    command_->SetCallback([](vtkObject*, unsigned long, void* client, void* call) {
      auto& text = *static_cast<std::string*>(client);
      if (text.empty() && call) text = first_sentence(static_cast<const char*>(call));
    });
  }
  vtkCommand* command() { return command_; }
  const std::string& text() const { return text_; }

  /// Collects the errors of a reader or writer and of its executive.
  template <class Algorithm>
  void listen_to(Algorithm* algorithm) {
    algorithm->AddObserver("ErrorEvent", command());
    algorithm->GetExecutive()->AddObserver("ErrorEvent", command());
  }

 private:
  // From "ERROR: In file, line n\nclass (address): what went wrong\n\n". The addresses change each
  // time.
  static std::string first_sentence(std::string text) {
    if (const auto end = text.find("): "); end != std::string::npos) text.erase(0, end + 3);
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
  }

  std::string text_;
  vtkNew<vtkCallbackCommand> command_;
};

inline void add_text(vtkFieldData* fields, const std::string& name, const std::string& value) {
  vtkNew<vtkStringArray> array;
  array->SetName(name.c_str());
  array->InsertNextValue(value);
  fields->AddArray(array);
}

}  // namespace surf::io::vtk
