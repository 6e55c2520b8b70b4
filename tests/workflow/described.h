// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "surf/core/parameters.h"

namespace surf::test {

/// Another value than it has, as text; empty for what has a form of its own.
inline std::string other_value(const Parameter& about, const Field& field) {
  switch (field.kind()) {
    case FieldKind::flag:
      return field.text() == "on" ? "off" : "on";
    case FieldKind::choice: {
      const auto words = field.choices();
      return *std::ranges::find_if(words, [&](const std::string& word) {
        return word != field.text() &&
               (field.given() || word != "none");  // "none" is not to give it
      });
    }
    case FieldKind::number:
    case FieldKind::whole: {
      const double now = field.given() ? std::stod(field.text()) : 0,
                   most = std::min(about.limits.high, 1e6);
      const double least = std::max(about.limits.low, -1e6);
      const double other = now + 1 <= most ? std::max(now, least) + 1 : now - 1;
      return fmt::format("{}", other);
    }
    case FieldKind::text:
      return about.form.empty() || about.form == "NAME" ? "other" : "";
    case FieldKind::list:
      return "one,two";
  }
  return "";
}

/// Every parameter that is changed, by itself, is found in the record under its key with its new
/// value, and nothing else differs. `forms` gives texts for those that have a form of their own.
template <class Struct>
void every_change_is_recorded(const std::map<std::string, std::string>& forms = {}) {
  Struct usual;
  const Record before = record_of(usual);
  std::map<std::string, std::string> keys;
  std::map<std::string, std::string> changed_to;
  std::set<std::string> unrecorded;
  for_each_parameter(usual, [&](const Parameter& about, Field& field) {
    ASSERT_TRUE(keys.emplace(about.name, about.key()).second)
        << about.name << " is described twice";
    if (!about.recorded) unrecorded.insert(about.name);
    const auto form = forms.find(about.name);
    changed_to[about.name] = form != forms.end() ? form->second : other_value(about, field);
    EXPECT_FALSE(about.help.empty()) << about.name;
    EXPECT_FALSE(about.help.starts_with("Of ") || about.help.starts_with("Also ") ||
                 about.help.starts_with("Nor "))
        << about.help;
  });
  for (const auto& [name, text] : changed_to) {
    SCOPED_TRACE(name + " = " + text);
    if (text.empty()) {
      ADD_FAILURE() << "give it a text in forms";
      continue;
    }
    Struct changed;
    set_parameter(changed, name, text);
    Record after = record_of(changed);
    if (unrecorded.contains(name)) {
      EXPECT_EQ(after, before);
      continue;
    }
    ASSERT_TRUE(after.contains(keys[name]));
    const std::string value = after[keys[name]];
    EXPECT_TRUE(!before.contains(keys[name]) || before.at(keys[name]) != value) << value;
    Struct again;  // what is recorded says the same again
    set_parameter(again, name, value);
    EXPECT_EQ(record_of(again), after);
    Record rest = before;
    rest.erase(keys[name]), after.erase(keys[name]);
    EXPECT_EQ(after, rest);
  }
}

}  // namespace surf::test
