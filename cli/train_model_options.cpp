// SPDX-License-Identifier: GPL-3.0-or-later
#include "train_model_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "options.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/sem/fit_facet_network.h"

namespace surf::cli {
namespace {

std::vector<FacetScale> parse_scales(const std::string& text) {
  const std::vector<FacetScale> all = thesis_scales();
  std::vector<FacetScale> scales;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    const auto size = parse_whole(text.substr(from, comma - from), "--scales", 5, 255);
    const auto known =
        std::find_if(all.begin(), all.end(), [&](const FacetScale& s) { return s.size == size; });
    if (known == all.end()) {
      std::string sizes;
      for (const FacetScale& s : all) sizes += fmt::format("{}{}", sizes.empty() ? "" : ",", s.size);
      throw UsageError("--scales", fmt::format("there is no neighbourhood of {} samples", size),
                       "Choose among " + sizes);
    }
    scales.push_back(*known);
    from = comma + 1;
  }
  return scales;
}

/// "24,12" for two hidden layers, "0" for none.
std::vector<int> parse_hidden(const std::string& text) {
  std::vector<int> layers;
  if (text == "0") return layers;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    layers.push_back(static_cast<int>(parse_whole(text.substr(from, comma - from), "--hidden", 1, 256)));
    from = comma + 1;
  }
  if (layers.size() > 3)
    throw UsageError("--hidden", fmt::format("{} hidden layers are too many", layers.size()),
                     "Give 1 to 3, or 0 for none");
  return layers;
}

/// What is about images that a kind without any would leave unused.
void refuse_without_images(const TrainOptions& o, const workflow::TrainJob& job) {
  const auto kinds = workflow::learnable_kinds();
  const auto kind = std::ranges::find(kinds, job.learn.kind, &workflow::LearnableKind::name);
  if (kind == kinds.end() || kind->needs_images || o.surfaces || !o.heights.empty()) return;
  for (const auto& [given, option] :
       {std::pair{&o.surface_size, "--surface-size"}, std::pair{&o.electrons, "--electrons"},
        std::pair{&o.accuracy, "--accuracy"}, std::pair{&o.edge, "--edge"}})
    if (given->has_value())
      throw UsageError(option, fmt::format("a model '{}' needs no images, so there are none", kind->name),
                       "Leave it out, or add --surfaces N to judge the model on");
}

}  // namespace

void add_model(const TrainOptions& o, workflow::TrainJob& job) {
  workflow::LearnOptions& learn = job.learn;
  if (o.model) learn.kind = *o.model;
  if (o.scales) learn.scales = parse_scales(*o.scales);
  learn.multi_resolution = o.multi_resolution;
  if (o.cut_off) learn.cut_off = *o.cut_off == "0" ? 0 : parse_share(*o.cut_off, "--cut-off");
  if (o.hidden) learn.hidden = parse_hidden(*o.hidden);
  if (o.iterations)
    learn.iterations = static_cast<int>(parse_whole(*o.iterations, "--iterations", 1, 100000));
  if (o.decay) learn.decay = parse_number(*o.decay, "--decay");
  if (o.tolerance) learn.tolerance = *o.tolerance == "0" ? 0 : parse_share(*o.tolerance, "--tolerance");
  if (o.table_electrons)
    learn.table_electrons = parse_whole(*o.table_electrons, "--table-electrons", 2, std::int64_t{1} << 31);
  refuse_without_images(o, job);
}

std::string kinds_in_words() {
  std::string text = "Kinds of models (--model):\n";
  for (const workflow::LearnableKind& kind : workflow::learnable_kinds())
    text += fmt::format("  {:<22}  {}\n", kind.name, kind.what);
  return text + "\n";
}

void add_train_model_options(CLI::App& app, TrainOptions& o) {
  const char* model = "Model";
  const FacetNetworkFitOptions usual;
  app.add_option("--model", o.model, "Its kind, of those below (facet-network)")
      ->type_name("KIND")
      ->group(model);
  app.add_option("--scales", o.scales,
                 "Of a filter bank or network: samples across its neighbourhoods, as\n"
                 "5,7,11 (all ten; of a network those that the electrons' range covers)")
      ->type_name("N,N...")->group(model);
  app.add_option("--hidden", o.hidden, fmt::format("Of a network: units of its hidden layers, as 24,12; 0: no layer ({})",
                                             fmt::join(usual.hidden, ",")))
      ->type_name("N,N...")->group(model);
  app.add_option("--iterations", o.iterations, fmt::format("Of a network's training, at most ({})", usual.iterations))
      ->type_name("N")
      ->group(model);
  app.add_option("--decay", o.decay, fmt::format("Of a network: how strongly large weights are held back ({:g})", usual.decay))
      ->type_name("NUMBER")->group(model);
  app.add_option("--tolerance", o.tolerance,
                 fmt::format("Of a network: what it is expected to miss by besides noise ({:g}%)", 100 * usual.tolerance))
      ->type_name("SHARE")
      ->group(model);
  app.add_option("--cut-off", o.cut_off, "Of a filter bank: components of a smaller eigenvalue are left out")
      ->type_name("NUMBER")->group(model);
  app.add_flag("--multi-resolution", o.multi_resolution,
               "Of a filter bank: wide neighbourhoods on fewer samples")
      ->group(model);
  app.add_option("--table-electrons", o.table_electrons,
                 "Of tables: primaries at each angle of slopes (31000), or in all (10240)")
      ->type_name("N")->group(model);
}

}  // namespace surf::cli
