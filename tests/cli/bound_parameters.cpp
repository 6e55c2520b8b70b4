// SPDX-License-Identifier: GPL-3.0-or-later
#include "bound_parameters.h"

#include <gmock/gmock.h>

#include <functional>

#include "app.h"
#include "surf/core/error.h"

namespace surf::cli {
namespace {

struct Sample {
  double width_nm = 3;
  std::optional<int> count;
  bool quick = false;
  std::string plan;
};

void describe(ParameterVisitor& visit, Sample& s) {
  visit(s.width_nm, {.name = "sample.width",
                     .help = "Width of the sample",
                     .unit = Unit::nm,
                     .limits = above(0)});
  visit(s.count,
        {.name = "sample.count", .help = "Things", .limits = within(1, 9), .otherwise = "all"});
  visit(s.quick, {.name = "sample.quick", .help = "Hurry"});
  visit(s.plan, {.name = "sample.plan", .help = "What to do", .file = FileRole::read});
}

struct Program {
  CLI::App app;
  BoundParameters bound;

  explicit Program(OptionLooks looks = {}) {
    bound.looks = std::move(looks);
    bound.add<Sample>(app, "Options");
  }
  Sample parse(const char* words) {
    app.parse(words);
    Sample sample;
    bound.apply(sample);
    return sample;
  }
};

TEST(BoundParameters, TakeWhatWasGiven) {
  const Sample s = Program().parse("--width 1um --count 4 --quick --plan a.txt");
  EXPECT_EQ(s.width_nm, 1000);
  EXPECT_EQ(s.count, 4);
  EXPECT_TRUE(s.quick);
  EXPECT_EQ(s.plan, "a.txt");
  EXPECT_EQ(Program().parse("").width_nm, 3);
  EXPECT_THROW(Program().parse("--width 0nm"), UsageError);
}

TEST(BoundParameters, FormerNamesStandForTheSameAndAreNotShown) {
  const OptionLooks looks{
      {"sample.width", {.name = "--sample-width", .former = {"--width", "--breadth"}}}};
  EXPECT_EQ(Program(looks).parse("--sample-width 5nm").width_nm, 5);
  EXPECT_EQ(Program(looks).parse("--breadth 6nm").width_nm, 6);
  Program p(looks);
  EXPECT_THAT(p.app.help(), testing::HasSubstr("--sample-width LENGTH"));
  EXPECT_THAT(p.app.help(), testing::HasSubstr("Width of the sample, above 0nm (3nm)"));
  EXPECT_THAT(p.app.help(), testing::Not(testing::HasSubstr("--breadth")));
}

TEST(BoundParameters, AreFoundByTheParametersName) {
  Program p({{"sample.width", {.name = "-w,--sample-width", .former = {"--breadth"}}},
             {"sample.quick", {.hidden = true}}});
  EXPECT_EQ(option_of(p.app, "sample.width"), "--sample-width");
  EXPECT_EQ(option_of(p.app, "sample.count"), "--count");
  EXPECT_EQ(option_of(p.app, "sample.quick"), "");
  EXPECT_EQ(option_of(p.app, "other.thing"), "");
}

TEST(BoundParameters, OtherOptionsMayStandForAParameter) {
  Program p({{"sample.plan", {.hidden = true}}});
  std::string value;
  CLI::Option* own = p.app.add_option("--own-plan", value);
  p.bound.stands_for(own, "sample.plan");
  EXPECT_EQ(option_of(p.app, "sample.plan"), "--own-plan");
  EXPECT_FALSE(file_role(*own));
}

TEST(BoundParameters, RolesOfFilesEndWithTheirOptions) {
  CLI::App plain;
  for (int i = 0; i < 50; ++i) {  // options may lie where bound ones lay
    Program p;
    EXPECT_EQ(file_role(*p.app.get_option("--plan")), FileRole::read);
    EXPECT_EQ(file_role(*p.app.get_option("--count")), FileRole::none);
  }
  std::vector<std::string> values(50);
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_FALSE(file_role(*plain.add_option("--o" + std::to_string(i), values[i])));
}

/// So a new command cannot write over its inputs before anybody thinks of it.
TEST(BoundParameters, EveryOptionOfAFileSaysWhatIsDoneWithIt) {
  Action action;
  const std::unique_ptr<CLI::App> app = make_app(action, "");
  int files = 0;
  const std::function<void(const CLI::App&)> look = [&](const CLI::App& command) {
    for (const CLI::Option* option : command.get_options()) {
      const std::string form =
          option->get_option_text().empty() ? option->get_type_name() : option->get_option_text();
      SCOPED_TRACE(command.get_name() + " " + option->get_name() + " " + form);
      const auto role = file_role(*option);
      if (form.starts_with("FILE")) {
        ++files;
        EXPECT_TRUE(role && *role != FileRole::none);
      } else if (form.starts_with("FOLDER")) {
        EXPECT_TRUE(role);
      }
    }
    for (const CLI::App* sub : command.get_subcommands(nullptr)) look(*sub);
  };
  look(*app);
  EXPECT_GT(files, 80);
}

}  // namespace
}  // namespace surf::cli
