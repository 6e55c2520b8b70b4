// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/parameters.h"

#include <gmock/gmock.h>

#include <cmath>

#include "surf/core/error.h"

namespace surf {
namespace {

using testing::HasSubstr;

enum class Colour { red, green, blue };

/// One field of each kind.
struct Everything {
  double length_nm = 2, share = 0.01, plain = 1.5;
  int count = 3;
  std::int64_t many = 1;
  std::uint64_t seed = 1;
  bool flag = false;
  std::string text;
  std::vector<std::string> names, files;
  std::optional<double> angle_deg;
  std::optional<int> perhaps;
  Colour colour = Colour::red;
  std::optional<Colour> other;
  double hidden = 7;
};

void describe(ParameterVisitor& visit, Everything& e) {
  visit(e.length_nm,
        {.name = "all.length", .help = "Length", .unit = Unit::nm, .limits = above(0, 100)});
  visit(e.share,
        {.name = "all.share", .help = "Share", .unit = Unit::share, .limits = within(0, 1)});
  visit(e.plain, {.name = "all.plain", .help = "Number"});
  visit(e.count, {.name = "all.count", .help = "Count", .limits = within(1, 10)});
  visit(e.many, {.name = "all.many", .help = "Large count", .limits = at_least(1)});
  visit(e.seed, {.name = "all.seed", .help = "Seed"});
  visit(e.flag, {.name = "all.flag", .help = "Flag"});
  visit(e.text, {.name = "all.text", .help = "Text"});
  visit(e.names, {.name = "all.names", .help = "Names"});
  visit(e.files, {.name = "all.files", .help = "Files", .file = FileRole::read});
  visit(e.angle_deg,
        {.name = "all.angle", .help = "Angle", .unit = Unit::deg, .limits = from_to_below(0, 90)});
  visit(e.perhaps, {.name = "all.perhaps", .help = "Perhaps a count"});
  visit(e.colour, {"red", "green", "blue"}, {.name = "all.colour", .help = "Colour"});
  visit(e.other, {"red", "green", "blue"}, {.name = "all.other", .help = "Another colour"}, "none");
  visit(e.hidden, {.name = "all.hidden", .help = "Not for records", .recorded = false});
}

std::string refusal(const char* name, const char* text) {
  Everything e;
  try {
    set_parameter(e, name, text);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(Parameters, TextsBecomeValuesInNativeUnits) {
  Everything e;
  set_parameter(e, "all.length", "0.05um");
  EXPECT_EQ(e.length_nm, 50);
  set_parameter(e, "all.share", "3%");
  EXPECT_EQ(e.share, 0.03);
  set_parameter(e, "all.share", "0");
  EXPECT_EQ(e.share, 0);
  set_parameter(e, "all.many", "1e6");
  EXPECT_EQ(e.many, 1'000'000);
  set_parameter(e, "all.seed", "18446744073709551615");
  EXPECT_EQ(e.seed, 18446744073709551615u);
  set_parameter(e, "all.flag", "on");
  EXPECT_TRUE(e.flag);
  set_parameter(e, "all.names", "a, b,c");
  EXPECT_THAT(e.names, testing::ElementsAre("a", "b", "c"));
  set_parameter(e, "all.files", "a,b.stl");  // a comma may be in a name
  EXPECT_THAT(e.files, testing::ElementsAre("a,b.stl"));
  set_parameter(e, "all.angle", "30deg");
  EXPECT_EQ(e.angle_deg, 30);
  set_parameter(e, "all.colour", "blue");
  EXPECT_EQ(e.colour, Colour::blue);
  set_parameter(e, "all.other", "green");
  EXPECT_EQ(e.other, Colour::green);
  set_parameter(e, "all.other", "none");
  EXPECT_FALSE(e.other);
  EXPECT_THROW(set_parameter(e, "all.nothing", "1"), std::invalid_argument);
}

TEST(Parameters, WhatIsWrongIsNamedWithRangeAndRemedy) {
  EXPECT_EQ(refusal("all.length", "0nm"),
            "`all.length`: '0nm' is out of range. Give a length above 0nm and at most 100nm");
  EXPECT_THAT(refusal("all.length", "nan"),
              HasSubstr("`all.length`: 'nan' is not a finite number"));
  EXPECT_THAT(refusal("all.plain", "inf"), HasSubstr("is no number"));
  EXPECT_THAT(refusal("all.count", "2.5"),
              HasSubstr("'2.5' is not a whole number. Give a whole number 1 to 10"));
  EXPECT_THAT(refusal("all.count", "1e300"), HasSubstr("out of range"));
  EXPECT_THAT(refusal("all.many", "0"), HasSubstr("1 or more"));
  EXPECT_THAT(refusal("all.seed", "-1"), HasSubstr("Give a whole number 0 to "));
  EXPECT_THAT(refusal("all.flag", "perhaps"), HasSubstr("Write on or off"));
  EXPECT_THAT(refusal("all.angle", "90deg"), HasSubstr("0deg to below 90deg"));
  EXPECT_THAT(refusal("all.colour", "pink"), HasSubstr("Choose red, green or blue"));
  EXPECT_THAT(refusal("all.other", "pink"), HasSubstr("Choose none, red, green or blue"));
  EXPECT_THAT(refusal("all.names", "a,,b"), HasSubstr("empty name"));
}

TEST(Parameters, ValuesThatNobodyTypedAreCheckedToo) {
  Everything e;
  EXPECT_NO_THROW(check_parameters(e));
  e.length_nm = std::nan("");
  EXPECT_THROW(check_parameters(e), UsageError);
  e = {};
  e.plain = INFINITY;
  EXPECT_THROW(check_parameters(e), UsageError);
  e = {};
  e.angle_deg = 90;
  EXPECT_THROW(check_parameters(e), UsageError);
  e = {};
  e.colour = static_cast<Colour>(3);
  EXPECT_THROW(check_parameters(e), UsageError);
}

TEST(Parameters, RecordsReadBackAsTheyWere) {
  Everything e;
  e.length_nm = 1.0 / 3;
  e.angle_deg = 12.5;
  e.flag = true;
  e.names = {"x", "y"};
  e.other = Colour::blue;
  const Record record = record_of(e);
  EXPECT_EQ(record.at("all.angle_deg"), "12.5");
  EXPECT_EQ(record.at("all.flag"), "on");
  EXPECT_FALSE(record.contains("all.perhaps"));
  EXPECT_FALSE(record.contains("all.text"));
  EXPECT_FALSE(record.contains("all.hidden"));
  Everything again;
  for_each_parameter(again, [&](const Parameter& about, Field& field) {
    if (const auto found = record.find(about.key()); found != record.end())
      field.read(found->second, about.subject());
  });
  EXPECT_EQ(record_of(again), record);
  EXPECT_EQ(again.length_nm, e.length_nm);
}

TEST(Parameters, AreShownAsPeopleWriteThem) {
  EXPECT_EQ(format_value(1000, Unit::ev), "1keV");
  EXPECT_EQ(format_value(500, Unit::ev), "500eV");
  EXPECT_EQ(format_value(0.02, Unit::share), "2%");
  EXPECT_EQ(format_value(1e13, Unit::nm), "10000m");
  EXPECT_EQ(format_value(2.5, Unit::nm), "2.5nm");
  EXPECT_EQ(format_limits({.limits = within(0, 1)}), "0 to 1");
  EXPECT_EQ(format_limits({.limits = above(0)}), "above 0");
  EXPECT_EQ(format_limits({}), "");
}

}  // namespace
}  // namespace surf
