// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/chosen_channels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "surf/core/error.h"

namespace surf {
namespace {

ModelImages chosen(ModelImages all, const std::vector<std::size_t>& which) {
  ModelImages some;
  for (const std::size_t c : which) some.push_back(std::move(all[c]));
  return some;
}

class ChosenLinearization final : public Linearization {
 public:
  ChosenLinearization(std::unique_ptr<Linearization> all, std::vector<std::size_t> which)
      : all_(std::move(all)), which_(std::move(which)), images_(chosen(all_->images(), which_)) {}
  const ModelImages& images() const override { return images_; }
  Grid<double> gradient(const ModelImages& weights) const override {
    if (weights.size() != which_.size())
      throw InvalidInput("weights",
                         fmt::format("there are {} for {} channels", weights.size(), which_.size()),
                         "Give one image for each channel");
    ModelImages whole(all_->images().size(),
                      Grid<double>(images_.front().width(), images_.front().height()));
    for (std::size_t i = 0; i < which_.size(); ++i) whole[which_[i]] = weights[i];
    return all_->gradient(whole);
  }
  ModelImages change(const Grid<double>& dz_nm) const override {
    return chosen(all_->change(dz_nm), which_);
  }

 private:
  std::unique_ptr<Linearization> all_;
  std::vector<std::size_t> which_;
  ModelImages images_;
};

class ChosenChannels final : public ImageModel {
 public:
  ChosenChannels(std::shared_ptr<const ImageModel> model, std::vector<std::string> names,
                 std::vector<std::size_t> which)
      : model_(std::move(model)), names_(std::move(names)), which_(std::move(which)) {}
  const std::vector<std::string>& channels() const override { return names_; }
  const ModelScope& scope() const override { return model_->scope(); }
  ModelImages predict(const HeightField& field, const ModelOptions& options) const override {
    return chosen(model_->predict(field, options), which_);
  }
  std::unique_ptr<Linearization> linearize(const HeightField& field,
                                           const ModelOptions& options) const override {
    return std::make_unique<ChosenLinearization>(model_->linearize(field, options), which_);
  }

 private:
  std::shared_ptr<const ImageModel> model_;
  std::vector<std::string> names_;
  std::vector<std::size_t> which_;
};

}  // namespace

std::shared_ptr<const ImageModel> with_channels(std::shared_ptr<const ImageModel> model,
                                                const std::vector<std::string>& names) {
  const std::vector<std::string>& all = model->channels();
  if (names == all) return model;
  std::vector<std::size_t> which;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(all, name);
    if (found == all.end() || std::ranges::count(names, name) > 1)
      throw InvalidInput("model",
                         fmt::format("channel '{}' is chosen{}, its channels are {}", name,
                                     found == all.end() ? "" : " twice", fmt::join(all, ", ")),
                         "Choose among them, each once");
    which.push_back(static_cast<std::size_t>(found - all.begin()));
  }
  if (which.empty())
    throw InvalidInput("model", "no channel is chosen",
                       fmt::format("Choose among {}", fmt::join(all, ", ")));
  return std::make_shared<ChosenChannels>(std::move(model), names, std::move(which));
}

}  // namespace surf
