// SPDX-License-Identifier: GPL-3.0-or-later
#include "attempt.h"

#include <vtkAlgorithm.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationVector.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <thread>

#include "labels.h"
#include "surf/core/error.h"

namespace surf::pv {
namespace {

using namespace std::chrono_literals;

/// Made with the plugin, so that Python finds it by name (vtkInformationKeyLookup) before any work
/// is done.
vtkInformationDoubleKey* const library_seconds =
    vtkInformationDoubleKey::MakeKey("LIBRARY_SECONDS", "vtkSemsurf");

/// What the two threads share.
struct Run {
  std::atomic<double> share{0};  // of the work that is done
  CancelToken cancel;
  std::mutex mutex;
  std::condition_variable ended;
  bool done = false;
  std::exception_ptr error;
  double seconds = 0;  // that the job took
};

void do_job(Run& run, const std::function<void(const Watch&)>& job) {
  std::exception_ptr error;
  const auto start = std::chrono::steady_clock::now();
  try {
    job({[&run](double done, double total) { run.share.store(total > 0 ? done / total : 0); },
         &run.cancel});
  } catch (...) {
    error = std::current_exception();
  }
  const std::lock_guard lock(run.mutex);
  run.error = error;
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  run.done = true;
  run.ended.notify_one();
}

}  // namespace

int attempt(vtkAlgorithm* self, const std::function<void()>& request) {
  try {
    request();
    return 1;
  } catch (const Interrupted&) {
    return 1;
  } catch (const std::bad_alloc&) {
    vtkErrorWithObjectMacro(
        self, << "memory: there is not enough for this. Use fewer samples or a smaller mesh");
  } catch (const std::exception& error) {
    vtkErrorWithObjectMacro(self, << labelled(error.what()));
  }
  return 0;
}

int attempt_information(vtkAlgorithm* self, vtkInformationVector* outputs,
                        const std::function<void()>& request) {
  if (attempt(self, request)) return 1;
  const int nothing[6] = {0, -1, 0, -1, 0, -1};
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
    outputs->GetInformationObject(port)->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(),
                                             nothing, 6);
  return 0;
}

void work(vtkAlgorithm* self, const std::function<void(const Watch&)>& job) {
  Run run;
  std::thread worker(do_job, std::ref(run), std::cref(job));
  int told = 0;  // hundredths, so that nobody is told more than a hundred times
  std::unique_lock lock(run.mutex);
  while (!run.ended.wait_for(lock, 50ms, [&] { return run.done; })) {
    lock.unlock();
    const int now = static_cast<int>(100 * run.share.load());
    if (now > told && now < 100) {
      told = now;
      self->UpdateProgress(0.01 * told);
    }
    if (self->CheckAbort()) run.cancel.cancel();
    lock.lock();
  }
  lock.unlock();
  worker.join();
  self->GetInformation()->Set(library_seconds, run.seconds);
  if (run.error) std::rethrow_exception(run.error);
  if (run.cancel.cancelled()) throw Interrupted();
}

void warn(vtkAlgorithm* self, const std::string& text) {
  vtkWarningWithObjectMacro(self, << labelled(text));
}

}  // namespace surf::pv
