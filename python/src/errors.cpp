// SPDX-License-Identifier: GPL-3.0-or-later
#include "errors.h"

#include <exception>
#include <string>

#include "function.h"
#include "keywords.h"
#include "surf/core/error.h"

namespace surf::python {
namespace {

void set(const char* name, const Error& error) {
  const std::string& subject = error.subject();
  const bool of_field =
      subject.size() > 2 && subject.front() == '`' && subject.find('`', 1) == subject.size() - 1;
  py::object field = py::none();
  if (of_field) {
    const std::string whole = subject.substr(1, subject.size() - 2);
    field = py::str(keyword_of(whole.substr(0, whole.find('='))));
  }
  if (field.is_none() && is_argument(subject)) field = py::str(subject);
  const py::object type = error_class(name);
  const py::object value = type(with_keywords(subject), with_keywords(error.reason()),
                                with_keywords(error.remedy()), field);
  PyErr_SetObject(type.ptr(), value.ptr());
}

}  // namespace

py::object error_class(const char* name) {
  return py::module_::import("semsurf._errors").attr(name);
}

void translate_errors() {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const UsageError& e) {
      set("UsageError", e);
    } catch (const InvalidInput& e) {
      set("InvalidInput", e);
    } catch (const FileError& e) {
      set("FileError", e);
    } catch (const Unsupported& e) {
      set("Unsupported", e);
    } catch (const Error& e) {
      set("Error", e);
    } catch (const Interrupted& e) {
      PyErr_SetString(error_class("Interrupted").ptr(), e.what());
    }
  });
}

}  // namespace surf::python
