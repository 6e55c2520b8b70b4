// SPDX-License-Identifier: GPL-3.0-or-later
#include "complete.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "surf/core/words.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/physics/physics_words.h"
#include "surf/workflow/chart_job.h"
#include "surf/workflow/train_job.h"
#include "sweep.h"

namespace surf::cli {
namespace {

struct Candidate {
  std::string word, description;
};

struct Offer {
  std::string kind = ":nothing";
  std::vector<Candidate> candidates;
  bool list = false;  // more of them may follow after a comma

  void add(const std::string& word, const std::string& description = {}) {
    candidates.push_back({word, description});
  }
};

std::string first_line(std::string text) {
  text.resize(std::min(text.find('\n'), text.size()));
  return text;
}

/// What help shows for an option's value, without what CLI11 adds of its checks:
/// "auto|rows:{auto,rows}".
std::string form_of_value(const CLI::Option& option) {
  std::string form = option.get_option_text();
  if (form.empty()) form = option.get_type_name();
  form.resize(std::min({form.find(":{"), form.find(' '), form.size()}));
  return form;
}

/// A shell that ends words at "=" and ":" gives "a=b" as "a", "=", "b".
std::vector<std::string> rejoined(const std::vector<std::string>& words) {
  std::vector<std::string> out;
  bool open = false;
  for (const std::string& word : words) {
    const bool separator = word == "=" || word == ":";
    if (!out.empty() && (open || separator)) out.back() += word;
    else out.push_back(word);
    open = separator;
  }
  if (out.empty()) out.emplace_back();
  return out;
}

bool is_shown(const CLI::Option& option) { return !option.get_group().empty(); }

const CLI::App* command_named(const CLI::App& app, const std::string& name) {
  for (const CLI::App* sub : app.get_subcommands(nullptr))
    if (sub->get_name() == name) return sub;
  return nullptr;
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// Words for values whose form names a kind of thing.
void add_words_of(const CLI::Option& option, const std::string& form, Offer& offer) {
  const std::string name = option.nonpositional() ? option.get_lnames().front() : option.get_name();
  if (form == "KIND") {
    for (const workflow::LearnableKind& kind : workflow::learnable_kinds()) offer.add(kind.name);
  } else if (name == "channels" && form == "NAME,...") {
    for (const char* word : {"z_nm", "normal", "material", "electrons", "model", "variance_left"})
      offer.add(word);
  } else if (name == "methods") {
    for (const workflow::ChartFamily& family : workflow::chart_families()) offer.add(family.name);
  }
}

/// "FILE.json" and "SCENE.toml" are names of files, "FOLDER|off" a folder or a word,
/// "SE|BSE|...|valid" words among others. A single name in capitals stands for what nobody can
/// list.
Offer values_of(const CLI::Option& option) {
  Offer offer;
  const std::string form = form_of_value(option);
  offer.list = form.find(',') != std::string::npos && form.find("...") != std::string::npos;
  const bool choice = form.find('|') != std::string::npos;
  for (const std::string_view part : split(form, "|")) {
    if (part == "FILE" || part.starts_with("FILE.") || part == "SCENE.toml") offer.kind = ":files";
    else if (part == "FOLDER") offer.kind = ":folders";
    else if (part == "MATERIAL")
      for (const mc::Material& m : io::builtin_materials()) offer.add(m.name);
    else if (choice && part != "..." && part != "SHAPE") offer.add(std::string(part));
  }
  add_words_of(option, form, offer);
  return offer;
}

/// Puts `before` in front of all, and leaves out what does not begin with `begun`.
Offer prefixed(Offer offer, const std::string& before, const std::string& begun) {
  std::erase_if(offer.candidates, [&](const Candidate& c) { return !c.word.starts_with(begun); });
  for (Candidate& c : offer.candidates) c.word = before + c.word;
  return offer;
}

/// What may stand after the last comma, but for what stands before it.
Offer continued(Offer offer, const std::string& before, const std::string& word) {
  const std::size_t begin = offer.list ? word.rfind(',') + 1 : 0;  // npos + 1 is 0
  const std::set<std::string> used = [&] {
    const std::string before_it = word.substr(0, begin);
    const auto names = split(before_it, ",");
    return std::set<std::string>(names.begin(), names.end());
  }();
  std::erase_if(offer.candidates, [&](const Candidate& c) { return used.contains(c.word); });
  return prefixed(std::move(offer), before + word.substr(0, begin), word.substr(begin));
}

Offer physics(const std::string& before, const std::string& word) {
  const std::size_t begin = word.rfind(',') + 1, equals = word.find('=', begin);
  Offer offer;
  for (const mc::PhysicsWords& key : mc::physics_words()) {
    if (equals == std::string::npos) offer.add(key.key + "=");
    else if (word.substr(begin, equals - begin) == key.key)
      for (const std::string& value : key.values) offer.add(value);
  }
  const std::size_t from = equals == std::string::npos ? begin : equals + 1;
  return prefixed(std::move(offer), before + word.substr(0, from), word.substr(from));
}

Offer varied(const CLI::App& command, const std::string& before, const std::string& word) {
  const std::size_t equals = word.find('=');
  if (equals == std::string::npos) {
    Offer names;
    for (const std::string& name : names_to_vary()) names.add(name + "=");
    return prefixed(std::move(names), before, word);
  }
  const CLI::Option* const option = command.get_option_no_throw("--" + word.substr(0, equals));
  if (!option) return {};
  Offer offer = values_of(*option);
  offer.list = true;
  return continued(std::move(offer), before + word.substr(0, equals + 1), word.substr(equals + 1));
}

Offer complete_value(const CLI::App& command, const CLI::Option& option, const std::string& before,
                     const std::string& word) {
  const std::string form = form_of_value(option);
  if (form == "KEY=VALUE,...") return physics(before, word);
  if (form == "NAME=VALUES") return varied(command, before, word);
  return continued(values_of(option), before, word);
}

Offer complete_option(const CLI::App& command, const std::string& word) {
  if (const std::size_t equals = word.find('='); equals != std::string::npos) {
    const CLI::Option* const option = command.get_option_no_throw(word.substr(0, equals));
    if (!option || !takes_value(*option)) return {};
    return complete_value(command, *option, word.substr(0, equals + 1), word.substr(equals + 1));
  }
  Offer offer;
  for (const CLI::Option* option : command.get_options()) {
    if (!is_shown(*option)) continue;
    const std::string description = first_line(option->get_description());
    for (const std::string& name : option->get_snames()) offer.add("-" + name, description);
    for (const std::string& name : option->get_lnames()) offer.add("--" + name, description);
  }
  return prefixed(std::move(offer), "", word);
}

/// The inputs of a command stand for words by their order; the last may take all that follow.
Offer complete_input(const CLI::App& command, std::size_t inputs, const std::string& word) {
  Offer offer;
  std::size_t first = 0;
  for (const CLI::Option* option : command.get_options()) {
    if (option->nonpositional() || !is_shown(*option)) continue;
    const auto most = static_cast<std::size_t>(std::max(1, option->get_items_expected_max()));
    if (inputs >= first && inputs - first < most) {
      offer = complete_value(command, *option, "", word);
      break;
    }
    first += most;
  }
  if (inputs > 0) return offer;
  Offer commands;
  for (const CLI::App* sub : command.get_subcommands(nullptr))
    if (!sub->get_group().empty())
      commands.add(sub->get_name(), first_line(sub->get_description()));
  commands = prefixed(std::move(commands), "", word);
  offer.candidates.insert(offer.candidates.begin(), commands.candidates.begin(),
                          commands.candidates.end());
  return offer;
}

}  // namespace

std::string completions(const CLI::App& app, const std::vector<std::string>& words) {
  const std::vector<std::string> all = rejoined(words);
  const CLI::App* command = &app;
  const CLI::Option* awaits = nullptr;  // whose value comes next
  int values = 0;                       // how many of them
  std::size_t inputs = 0;
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    const std::string& word = all[i];
    if (values > 0) {
      --values;
    } else if (word.size() > 1 && word[0] == '-') {
      awaits = command->get_option_no_throw(word);
      values = awaits && takes_value(*awaits) ? std::max(1, awaits->get_items_expected_min()) : 0;
    } else if (const CLI::App* sub = inputs ? nullptr : command_named(*command, word)) {
      command = sub;
    } else {
      ++inputs;
    }
  }
  const std::string& word = all.back();
  const Offer offer = values > 0              ? complete_value(*command, *awaits, "", word)
                      : word.starts_with('-') ? complete_option(*command, word)
                                              : complete_input(*command, inputs, word);
  std::string text = offer.kind + "\n";
  for (const Candidate& c : offer.candidates)
    text += c.word + (c.description.empty() ? "" : "\t" + c.description) + "\n";
  return text;
}

}  // namespace surf::cli
