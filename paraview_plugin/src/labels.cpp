// SPDX-License-Identifier: GPL-3.0-or-later
#include "labels.h"

#include <cctype>
#include <map>
#include <regex>
#include <string>

#include "surf/core/error.h"

namespace surf::pv {
namespace {

/// What a property is called that is not called as the option is.
const std::map<std::string, std::string> other_names{
    {"materials", "Material File"}, {"size", "Pixels"}, {"output", "Model File"}};

std::string label_of(const std::string& option) {
  if (const auto other = other_names.find(option); other != other_names.end()) return other->second;
  std::string label;
  for (const char c : option) {
    const bool first = label.empty() || label.back() == ' ';
    label += c == '-' ? ' ' : first ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
  }
  return label;
}

/// With every option in it as a property.
std::string labelled(const std::string& text) {
  static const std::regex option("(^|[ ,(])--([a-z]+(-[a-z]+)*)");
  std::string out;
  auto from = text.begin();
  for (std::sregex_iterator found(text.begin(), text.end(), option), none; found != none; ++found) {
    out.append(from, (*found)[0].first);
    out += (*found)[1].str() + label_of((*found)[2].str());
    from = (*found)[0].second;
  }
  return out.append(from, text.end());
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
