// SPDX-License-Identifier: GPL-3.0-or-later
#include "labels.h"

#include <cctype>
#include <map>
#include <string>
#include <string_view>

#include "surf/core/error.h"
#include "surf/core/field_words.h"

namespace surf::pv {
namespace {

/// What a property is called that is not called as the field is.
const std::map<std::string_view, std::string> other_names{{"specimen.material", "Materials"},
                                                          {"specimen.materials", "Material File"},
                                                          {"specimen.substrate_z", "Substrate Top"},
                                                          {"scan.size", "Pixels"},
                                                          {"output", "Model File"},
                                                          {"prediction.model", "Model File"},
                                                          {"tip.kind", "Shape"},
                                                          {"tip.size", "Tip Size"},
                                                          {"reconstruction.model", "Model File"},
                                                          {"reconstruction.afm", "AFM"},
                                                          {"clean.spikes", "Spike Width"},
                                                          {"clean.median", "Median Width"},
                                                          {"clean.closing", "Closing Width"}};

std::string label_of(std::string_view field) {
  if (const auto other = other_names.find(field); other != other_names.end()) return other->second;
  std::string label = last_part(field, ' ');
  char before = ' ';
  for (char& c : label) {
    if (before == ' ') c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    before = c;
  }
  return label;
}

std::string named(const std::string& subject, const Labels& names) {
  for (const auto& [beginning, label] : names)
    if (subject.starts_with(beginning)) return label;
  return labelled(subject);
}

template <class Kind>
[[noreturn]] void again(const Kind& error, const Labels& names) {
  throw Kind(named(error.subject(), names), labelled(error.reason()), labelled(error.remedy()));
}

}  // namespace

std::string labelled(const std::string& text) {
  return with_field_words(text, [](std::string_view field, std::string_view value) {
    return label_of(field) + (value.empty() ? "" : " ") + std::string(value);
  });
}

void with_labels(const std::function<void()>& request, const Labels& names) {
  try {
    request();
  } catch (const UsageError& error) {
    again(error, names);
  } catch (const InvalidInput& error) {
    again(error, names);
  }
}

}  // namespace surf::pv
