// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/stored_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <span>
#include <utility>

#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/core/words.h"
#include "surf/io/files.h"
#include "surf/io/model/model_file.h"
#include "surf/sem/chosen_channels.h"
#include "surf/workflow/signal_detectors.h"
#include "surf/workflow/version.h"
#include "training_time.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

constexpr double usual_energy_ev = 1000;
constexpr double same_pixel = 1e-3;  // relative; models demand the same of fields
constexpr int layout = 1;            // version of the hash's input
constexpr const char* signal_subject = "`reconstruction.signal`";

std::string material_text(const mc::Material& m) {
  std::string text =
      fmt::format("{} {} {} {} {} {} {} {}", m.name, format_exact(m.density_g_cm3),
                  format_exact(m.formula_weight_g_mol), format_exact(m.work_function_ev),
                  format_exact(m.barrier_ev), format_exact(m.valence_electrons),
                  format_exact(m.plasmon_ev), format_exact(m.loss_join_ev));
  for (const mc::Constituent& c : m.constituents)
    text += fmt::format(" {} {} {} {}", c.atomic_number, format_exact(c.atomic_weight),
                        format_exact(c.weight_fraction), format_exact(c.mean_ionization_ev));
  return text;
}

double energy_of(const ModelRequest& r) { return r.energy_ev > 0 ? r.energy_ev : usual_energy_ev; }

std::vector<mc::Detector> taught(const ModelRequest& r) {
  if (r.signal.empty()) return {};
  return taught_detectors(r.signal, signal_subject);
}

std::string key_of(const ModelRequest& r) {
  std::string text = fmt::format(
      "layout {}\nsemsurf {}\nmaterial {}\nenergy {}\nspot {}\npixel {}\nlearn {} {}\n"
      "surfaces {} {} {}\n",
      layout, version(), material_text(r.material), format_exact(energy_of(r)),
      format_exact(r.spot_nm), format_exact(r.pixel_nm), r.learn.kind,
      r.learn.iterations.value_or(0), r.surfaces.value_or(0), r.surface_px, r.electrons);
  for (const std::string& line : mc::describe(r.physics, r.material)) text += line + "\n";
  for (const mc::Detector& d : taught(r)) text += "detector " + mc::format_detector(d) + "\n";
  return text;
}

/// A name such as "Si" or "my glass" as a part of a file name.
std::string plain(std::string text) {
  for (char& c : text)
    c = std::isalnum(static_cast<unsigned char>(c))
            ? static_cast<char>(std::tolower(static_cast<unsigned char>(c)))
            : '_';
  return text;
}

/// Detectors of one name may differ.
void refuse_another(const std::string& signal, const std::string& name,
                    const std::vector<mc::Detector>& known) {
  const std::vector<mc::Detector> asked = detectors_of(signal, signal_subject);
  const auto own = std::ranges::find(known, name, &mc::Detector::name);
  if (asked.empty() || own == known.end()) return;
  if (mc::format_detector(asked.front()) != mc::format_detector(*own))
    throw UsageError(signal_subject,
                     fmt::format("the model's {} is {}, and the image's {}", name,
                                 mc::format_detector(*own), mc::format_detector(asked.front())),
                     "Give a model that was trained for the image's");
}

/// The channels of a model that an image shows. `known`: the detectors that it was taught.
std::vector<std::string> wanted_channels(const std::vector<std::string>& all,
                                         const std::vector<mc::Detector>& known,
                                         const ModelRequest& r, const fs::path& file) {
  const auto has = [&](const std::string& name) {
    return std::ranges::find(all, name) != all.end();
  };
  if (r.signal.empty()) {
    std::vector<std::string> usual;
    for (const mc::Detector& d : mc::default_detectors())
      if (has(d.name)) usual.push_back(d.name);
    return usual.empty() ? all : usual;
  }
  const std::string name = has(r.signal) ? r.signal : channel_of(r.signal, signal_subject);
  if (!has(r.signal)) refuse_another(r.signal, name, known);
  if (!has(name))
    throw UsageError(signal_subject,
                     fmt::format("{} knows {}, not {}", file.string(), fmt::join(all, ", "), name),
                     "Leave out `reconstruction.model`, so that one is trained, or train one with "
                     "`simulation.detectors`");
  return {name};
}

std::string in_minutes(double seconds) {
  constexpr double few = 90;
  if (seconds < few) return fmt::format("{:.0f} s", std::max(seconds, 1.0));
  return fmt::format("{:.0f} minutes", std::ceil(seconds / 60));
}

StoredModel load(const fs::path& file, const ModelRequest& r) {
  StoredModel stored;
  stored.trained = io::read_model(file);
  stored.file = file;
  stored.sha256 = io::sha256_of_file(file);
  const ModelScope& scope = stored.trained.scope;
  ModelScope wanted;
  wanted.material = r.material.name;
  wanted.energy_ev = r.energy_ev;
  if (r.spot_given) wanted.spot_nm = r.spot_nm;
  check_conditions(scope, wanted);
  if (scope.pixel_nm > 0 && std::abs(scope.pixel_nm - r.pixel_nm) > same_pixel * scope.pixel_nm)
    throw InvalidInput(
        file.string(),
        fmt::format("it is for pixels of {:.6g} nm, and those of the SEM image are {:.6g} nm",
                    scope.pixel_nm, r.pixel_nm),
        "Leave out `reconstruction.model`, so that one is trained, or check `sem_pixel_size`");
  const std::shared_ptr<const ImageModel> all = make_model(stored.trained);
  std::vector<mc::Detector> known = mc::default_detectors();
  for (mc::Detector& d : taught_by(stored.trained)) known.push_back(std::move(d));
  const std::vector<std::string> channels = wanted_channels(all->channels(), known, r, file);
  stored.model = with_channels(all, channels);
  for (const mc::Detector& d : known)
    stored.sided = stored.sided || (mc::looks_from_a_side(d) && channels.front() == d.name);
  return stored;
}

TrainJob training(const ModelRequest& r, const fs::path& file) {
  TrainJob job;
  job.surfaces = r.surfaces;
  job.surface_px = r.surface_px;
  job.pixel_nm = r.pixel_nm;
  job.material = r.material;
  job.energy_ev = energy_of(r);
  job.spot_nm = r.spot_nm;
  job.detectors = taught(r);
  job.physics = r.physics;
  job.simulation.budget = mc::ElectronsPerPixel{r.electrons};
  job.simulation.threads = r.threads;
  job.learn = r.learn;
  job.output = file;
  return job;
}

}  // namespace

std::string kept_name(const ModelRequest& r) {
  const std::string key = key_of(r);
  const std::string hash = io::sha256_of(std::as_bytes(std::span(key)));
  return fmt::format("{}-{:.4g}ev-{:.4g}nm-{}.json", plain(r.material.name), energy_of(r),
                     r.pixel_nm, hash.substr(0, 16));
}

double training_primaries(const ModelRequest& r) {
  const TrainJob job = training(r, {});
  return static_cast<double>(job.surfaces.value_or(usual_training_surfaces)) * job.surface_px *
         job.surface_px * static_cast<double>(r.electrons);
}

std::vector<mc::Detector> taught_by(const TrainedModel& model) {
  std::vector<mc::Detector> all;
  const auto note = model.record.notes.find(detectors_note);
  if (note == model.record.notes.end()) return all;
  for (const std::string_view one : split(note->second, ";")) {
    if (one.find_first_not_of(' ') == std::string_view::npos) continue;
    for (mc::Detector& d :
         mc::parse_detectors(std::string(one.substr(one.find_first_not_of(' '))), "model"))
      all.push_back(std::move(d));
  }
  return all;
}

StoredModel find_model(const ModelRequest& r, const Reporter& reporter) {
  if (!r.file.empty()) return load(r.file, r);
  if (r.material.name.empty())
    throw UsageError("`specimen.material`", "it is missing, and so is `reconstruction.model`",
                     "Say what the specimen is made of, as `specimen.material=Si`");
  if (r.folder.empty())
    throw UsageError("`reconstruction.model`",
                     "it is missing, and there is no cache to keep a trained one in",
                     "Train one with 'semsurf train', or name a folder with `job.cache`");
  const auto note = [&](const std::string& text) { reporter.note(text); };
  const fs::path file = r.folder / kept_name(r);
  std::error_code ignored;
  if (fs::exists(file, ignored)) {
    try {
      return load(file, r);
    } catch (const FileError& error) {
      note(fmt::format("{}; the model is trained again", error.what()));
    }
  }
  note(fmt::format(
      "no model of {} at {:g} eV with pixels of {} is kept: one is trained, and stays in {}",
      r.material.name, energy_of(r), format_length(r.pixel_nm), file.string()));
  const TrainJob job = training(r, file);
  note(
      fmt::format("the training takes about {} more, as its first images tell; stop it when you "
                  "like: the same command goes on from there",
                  in_minutes(expected_training_s(job, reporter))));
  if (!run(job, reporter).complete) throw Interrupted();
  fs::path images = file;
  // The images are no longer needed.
  fs::remove_all(images.replace_extension(".training"), ignored);
  StoredModel stored = load(file, r);
  stored.made = true;
  return stored;
}

}  // namespace surf::workflow
