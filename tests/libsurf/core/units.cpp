// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/units.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

#include "surf/core/error.h"

namespace surf {
namespace {

using testing::HasSubstr;

/// The UsageError that `parse` gives, after checking its three parts.
template <class Parse>
std::string refusal(const Parse& parse, const char* text) {
  try {
    const double value = parse(text, "--thing");
    return std::string("accepted as ") + format_exact(value);
  } catch (const UsageError& error) {
    EXPECT_EQ(error.subject(), "--thing");
    EXPECT_FALSE(error.reason().empty());
    EXPECT_FALSE(error.remedy().empty());
    return error.what();
  }
}

double nm(const char* text) { return parse_length_nm(text, "--length"); }
double ev(const char* text) { return parse_energy_ev(text, "--energy"); }
double deg(const char* text) { return parse_angle_deg(text, "--angle"); }

}  // namespace

TEST(ParseLength, KnowsEveryUnit) {
  EXPECT_EQ(nm("2"), 2);
  EXPECT_EQ(nm("2nm"), 2);
  EXPECT_EQ(nm("0.5um"), 500);
  EXPECT_EQ(nm("0.5\u00b5m"), 500);
  EXPECT_EQ(nm("0.5\u03bcm"), 500);
  EXPECT_EQ(nm("1e-3 mm"), 1000);
  EXPECT_EQ(nm("1m"), 1e9);
  EXPECT_EQ(nm("9pm"), 0.009) << "9 * 1e-3 is another number";
  EXPECT_EQ(nm("2A"), 0.2);
  EXPECT_EQ(nm("1in"), 2.54e7);
}

TEST(ParseLength, AcceptsSignsBlanksAndExponents) {
  EXPECT_EQ(nm("-2.5nm"), -2.5);
  EXPECT_EQ(nm("+2.5nm"), 2.5);
  EXPECT_EQ(nm("  7 nm\t"), 7);
  EXPECT_EQ(nm("1E3"), 1000);
  EXPECT_EQ(nm(".5um"), 500);
}

TEST(ParseLength, RefusesWhatIsNoLength) {
  for (const char* text :
       {"",         "  ",    "nm",     "abc",   "2nn",  "2 nm x", "2NM",   "2Um", "1.2.3",
        "0x10",     "+-2",   "++2",    "-",     "2nm3", "nan",    "nannm", "inf", "-inf",
        "infinity", "1e999", "1e308m", "0,5um", "2e",   "5keV",   "5a"}) {
    EXPECT_THAT(refusal(parse_length_nm, text), HasSubstr("--thing: ")) << text;
  }
}

TEST(ParseLength, SaysWhatIsWrong) {
  EXPECT_THAT(refusal(parse_length_nm, "2NM"), HasSubstr("'NM' is not a unit of length"));
  EXPECT_THAT(refusal(parse_length_nm, "abc"), HasSubstr("'abc' is not a length"));
  EXPECT_THAT(refusal(parse_length_nm, "0,5um"), HasSubstr("comma"));
  EXPECT_THAT(refusal(parse_length_nm, "nan"), HasSubstr("not a finite number"));
  EXPECT_THAT(refusal(parse_length_nm, "1e308m"), HasSubstr("beyond the range"));
  EXPECT_THAT(refusal(parse_length_nm, "2x"), HasSubstr("for example 0.5um"));
}

TEST(ParseEnergy, KnowsEveryUnitInAnyCase) {
  EXPECT_EQ(ev("500"), 500);
  EXPECT_EQ(ev("500eV"), 500);
  EXPECT_EQ(ev("500ev"), 500);
  EXPECT_EQ(ev("500EV"), 500);
  for (const char* text : {"1.5keV", "1.5kev", "1.5KeV", "1.5KEV", "1.5 keV", "1500"}) {
    EXPECT_EQ(ev(text), 1500) << text;
  }
  EXPECT_EQ(ev("0.03MeV"), 30000);
  EXPECT_EQ(ev("0.03MEV"), 30000);
  EXPECT_EQ(ev("1e3eV"), 1000);
  EXPECT_EQ(ev("1eV"), 1);
}

TEST(ParseEnergy, RefusesTheAmbiguousMev) {
  for (const char* text : {"1mev", "1meV", "1mEV"}) {
    EXPECT_THAT(refusal(parse_energy_ev, text), HasSubstr("milli- or mega")) << text;
  }
}

TEST(ParseEnergy, RefusesOtherUnits) {
  for (const char* text : {"1kV", "1nm", "1J", "1e", "", "eV"}) {
    EXPECT_THAT(refusal(parse_energy_ev, text), HasSubstr("--thing: ")) << text;
  }
  EXPECT_THAT(refusal(parse_energy_ev, "1KV"), HasSubstr("'KV' is not a unit of energy"));
}

TEST(ParseCurrentAndTime, KnowEveryUnit) {
  for (const char* text : {"100", "100pA", "0.1nA", "1e-4uA", "1e5fA", "1e-10 A"})
    EXPECT_DOUBLE_EQ(parse_current_pa(text, "--thing"), 100) << text;
  for (const char* text : {"10", "10us", "0.01ms", "1e4ns", "1e-5s", "10\u00b5s"})
    EXPECT_DOUBLE_EQ(parse_time_us(text, "--thing"), 10) << text;
  for (const char* text : {"7200", "7200s", "120min", "2h", "7.2e6 ms"})
    EXPECT_DOUBLE_EQ(parse_duration_s(text, "--thing"), 7200) << text;
  EXPECT_DOUBLE_EQ(parse_duration_s("1d", "--thing"), 86400);
  EXPECT_THAT(refusal(parse_duration_s, "1us"), HasSubstr("'us' is not a unit of duration"));
  EXPECT_THAT(refusal(parse_current_pa, "1 amp"), HasSubstr("'amp' is not a unit of current"));
  EXPECT_THAT(refusal(parse_time_us, "x"), HasSubstr("'x' is not a time"));
  // 1 nA for 1 us: 6241.5 electrons.
  EXPECT_NEAR(1000 * electrons_per_pa_us, 6241.509, 1e-3);
}

TEST(ParseAngle, KnowsEveryUnit) {
  EXPECT_EQ(deg("30"), 30);
  EXPECT_EQ(deg("-30deg"), -30);
  EXPECT_EQ(deg("30\u00b0"), 30);
  EXPECT_DOUBLE_EQ(deg("0.5rad"), 90 / std::numbers::pi);
  EXPECT_DOUBLE_EQ(deg("10mrad"), 1.8 / std::numbers::pi);
  EXPECT_DOUBLE_EQ(deg("1rad") * degrees_to_radians, 1);
  EXPECT_THAT(refusal(parse_angle_deg, "30degrees"), HasSubstr("'degrees' is not a unit of angle"));
  EXPECT_THAT(refusal(parse_angle_deg, "x"), HasSubstr("'x' is not an angle"));
}

TEST(UnitLength, GivesNanometresPerUnit) {
  const auto length = [](const char* unit) { return unit_length_nm(unit, "--unit"); };
  EXPECT_EQ(length("nm"), 1);
  EXPECT_EQ(length("um"), 1e3);
  EXPECT_EQ(length("\u00b5m"), 1e3);
  EXPECT_EQ(length("mm"), 1e6);
  EXPECT_EQ(length("m"), 1e9);
  EXPECT_EQ(length("pm"), 1e-3);
  EXPECT_EQ(length("A"), 0.1);
  EXPECT_EQ(length("in"), 2.54e7);
  for (const char* unit : {"", "NM", "2nm", "eV", " nm"}) {
    EXPECT_THROW(length(unit), UsageError) << unit;
  }
}

TEST(FormatLength, ChoosesTheUnit) {
  EXPECT_EQ(format_length(398), "398 nm");
  EXPECT_EQ(format_length(1200), "1.20 um");
  EXPECT_EQ(format_length(3.5e6, 2), "3.5 mm");
  EXPECT_EQ(format_length(2.5e9), "2.50 m");
  EXPECT_EQ(format_length(7e12), "7000 m");
  EXPECT_EQ(format_length(0.5), "0.500 nm");
  EXPECT_EQ(format_length(0.003), "3.00 pm");
  EXPECT_EQ(format_length(-45.67), "-45.7 nm");
  EXPECT_EQ(format_length(0), "0 nm");
  EXPECT_EQ(format_length(-0.0), "0 nm");
}

TEST(FormatLength, IsShortWhereverTheNumberLies) {
  EXPECT_EQ(format_length(9.994e13), "99900 m");
  EXPECT_EQ(format_length(1e14), "1.00e+05 m");
  EXPECT_EQ(format_length(1e300), "1.00e+291 m");
  EXPECT_EQ(format_length(-1.7976931348623157e308), "-1.80e+299 m");
  EXPECT_EQ(format_length(1e-6), "0.00100 pm");
  EXPECT_EQ(format_length(1e-7), "1.00e-07 nm");
  EXPECT_EQ(format_length(-1e-300), "-1.00e-300 nm");
  EXPECT_EQ(format_length(4.9406564584124654e-324), "4.94e-324 nm");
  EXPECT_EQ(format_length(std::numeric_limits<double>::infinity()), "inf nm");
  for (int exponent = -320; exponent <= 307; ++exponent)
    EXPECT_LE(format_length(-9.99 * std::pow(10.0, exponent)).size(), 13u) << exponent;
}

TEST(FormatLength, RoundsBeforeItChooses) {
  EXPECT_EQ(format_length(999.4), "999 nm");
  EXPECT_EQ(format_length(999.6), "1.00 um");
  EXPECT_EQ(format_length(999600), "1.00 mm");
  EXPECT_EQ(format_length(398, 2), "400 nm");
  EXPECT_EQ(format_length(398.25, 5), "398.25 nm");
  EXPECT_THROW(format_length(1, 0), UsageError);
}

TEST(Share, PercentAndNumberAreTheSame) {
  EXPECT_EQ(parse_share("1%", "x"), 0.01);
  EXPECT_EQ(parse_share("1.3 %", "x"), 0.013);
  EXPECT_EQ(parse_share("0.013", "x"), parse_share("1.3%", "x"));
  for (int i = 1; i < 1000; ++i) EXPECT_EQ(parse_share(std::to_string(i) + "%", "x"), i / 100.0);
  for (const char* zero : {"0", "0.0", "0%", "0.00 %"})
    EXPECT_EQ(parse_share(zero, "x"), 0) << zero;
  for (const char* bad : {"", "%", "-1%", "nan", "inf", "1%%", "1 percent", "0x1"})
    EXPECT_THROW(parse_share(bad, "--accuracy"), UsageError) << bad;
}

TEST(Share, IsWrittenAsShortAsItReadsBack) {
  EXPECT_EQ(format_share(0.01), "1 %");
  EXPECT_EQ(format_share(0.013), "1.3 %");
  EXPECT_EQ(format_share(0.00025), "0.025 %");
  EXPECT_EQ(format_share(1), "100 %");
  for (const double share : {1.0 / 3, 0.07, 0.29, 1e-4})
    EXPECT_EQ(parse_share(format_share(share), "x"), share);
}

TEST(FormatExact, ReadsBackExactly) {
  EXPECT_EQ(format_exact(0.1), "0.1");
  EXPECT_EQ(format_exact(1), "1");
  EXPECT_EQ(format_exact(-2.5), "-2.5");
  for (const double value : {1.0 / 3, 0.1 + 0.2, 1e300, 5e-324, 123456789012345678.0,
                             std::numeric_limits<double>::max(), -1e-7}) {
    const std::string text = format_exact(value);
    double back = 0;
    std::from_chars(text.data(), text.data() + text.size(), back);
    EXPECT_EQ(back, value) << text;
  }
}

}  // namespace surf
