// SPDX-License-Identifier: GPL-3.0-or-later
// Work without Python's lock. The caller's thread, which alone receives signals, keeps waking up to
// see whether there was one, and passes on what the job reports.
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "errors.h"
#include "function.h"
#include "surf/core/error.h"

namespace surf::python {
namespace {

constexpr std::chrono::milliseconds patience{50};  // between looks for signals

struct Progress {
  double done = 0, total = 0;
  std::string things;
};

/// What the job's thread tells the caller's.
struct Exchange {
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::string> notes, warnings;
  std::optional<Progress> progress;  // the latest
  std::string stage;
  bool ended = false;
  std::exception_ptr error;
  CancelToken cancel;

  workflow::Reporter reporter() {
    workflow::Reporter r;
    r.on_stage = [this](const std::string& name) {
      const std::lock_guard lock(mutex);
      stage = name;
    };
    r.on_progress = [this](double done, double total, std::string_view things) {
      const std::lock_guard lock(mutex);
      progress = {done, total, things.empty() ? stage : std::string(things)};
    };
    r.on_note = [this](const std::string& text) {
      const std::lock_guard lock(mutex);
      notes.push_back(text);
    };
    r.on_warning = [this](const std::string& text) {
      const std::lock_guard lock(mutex);
      warnings.push_back(text);
    };
    r.cancel = &cancel;
    return r;
  }
};

/// The user's function, a bar, or nothing.
py::object shower_of(const py::object& asked) {
  if (asked.is_none() || asked.is(py::bool_(false))) return py::none();
  if (asked.is(py::bool_(true))) return py::module_::import("semsurf._bar").attr("Bar")();
  if (PyCallable_Check(asked.ptr())) return asked;
  throw UsageError("progress", "it is no function", "Give True, or a function of three arguments");
}

/// Passes on what was reported since the last time. Throws what Python's functions throw.
void pass_on(Exchange& exchange, const py::object& shower) {
  std::vector<std::string> notes, warnings;
  std::optional<Progress> progress;
  {
    const std::lock_guard lock(exchange.mutex);
    notes.swap(exchange.notes), warnings.swap(exchange.warnings);
    progress.swap(exchange.progress);
  }
  for (const std::string& text : notes) Call::note(text);
  for (const std::string& text : warnings) Call::warn(text);
  if (progress && !shower.is_none()) shower(progress->done, progress->total, progress->things);
}

/// Waits for the job's end. An exception of Python (Ctrl-C, of a callback) stops the job first.
std::optional<py::error_already_set> watch_over(Exchange& exchange, const py::object& shower) {
  std::optional<py::error_already_set> stopped;
  for (bool ended = false; !ended;) {
    {
      const py::gil_scoped_release unlocked;
      std::unique_lock lock(exchange.mutex);
      ended = exchange.changed.wait_for(lock, patience, [&] { return exchange.ended; });
    }
    if (stopped) continue;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      pass_on(exchange, shower);
    } catch (py::error_already_set& error) {
      stopped.emplace(error);
      exchange.cancel.cancel();
    }
  }
  return stopped;
}

[[noreturn]] void raise_interrupted(const py::object& partial) {
  const py::object type = error_class("Interrupted");
  py::object error = type("interrupted");
  error.attr("partial") = partial;
  PyErr_SetObject(type.ptr(), error.ptr());
  throw py::error_already_set();
}

}  // namespace

void Call::work(const std::function<void(const workflow::Reporter&)>& job,
                const std::function<py::object()>& partial) const {
  Exchange exchange;
  const py::object shower = shower_of((*this)["progress"]);
  std::thread thread([&] {
    try {
      job(exchange.reporter());
    } catch (...) {
      exchange.error = std::current_exception();
    }
    const std::lock_guard lock(exchange.mutex);
    exchange.ended = true;
    exchange.changed.notify_all();
  });
  std::optional<py::error_already_set> stopped;
  try {
    stopped = watch_over(exchange, shower);
  } catch (...) {
    exchange.cancel.cancel();
    const py::gil_scoped_release unlocked;
    thread.join();
    throw;
  }
  {
    const py::gil_scoped_release unlocked;
    thread.join();
  }
  if (!shower.is_none() && py::hasattr(shower, "close")) shower.attr("close")();
  if (!stopped) {
    if (exchange.error) std::rethrow_exception(exchange.error);
    return;
  }
  if (!stopped->matches(PyExc_KeyboardInterrupt)) throw *stopped;
  raise_interrupted(!exchange.error && partial ? partial() : py::object(py::none()));
}

void Call::note(const std::string& text) {
  py::module_::import("semsurf._errors").attr("note")(with_keywords(text));
}

void Call::notes(const std::vector<std::string>& texts, const std::string& of) {
  for (const std::string& text : texts) note(of.empty() ? text : of + ": " + text);
}

void Call::warn(const std::string& text) {
  py::module_::import("semsurf._errors").attr("warn")(with_keywords(text));
}

}  // namespace surf::python
