// Quantities with units.
#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.hpp"
#include "core/units.hpp"

namespace quicksand {
namespace {

double si(const std::string& text, const Dimension& expected) { return parse_quantity(text, expected, UnitSystem::si); }

TEST(ConfigUnits, ConvertsToSi) {
  EXPECT_DOUBLE_EQ(si("2.5 in", dimension::length), 0.0635);
  EXPECT_DOUBLE_EQ(si("2.5in", dimension::length), 0.0635);
  EXPECT_DOUBLE_EQ(si("0.203 g", dimension::mass), 2.03e-4);
  EXPECT_DOUBLE_EQ(si("1 atm", dimension::pressure), 101325);
  EXPECT_NEAR(si("33.9 ftH2O", dimension::pressure), 101329.37, 0.01);
  EXPECT_NEAR(si("1 psi", dimension::pressure), 6894.757293168, 1e-8);
  EXPECT_DOUBLE_EQ(si("0.25 ms", dimension::time), 2.5e-4);
  EXPECT_NEAR(si("62.4 lb/ft^3", dimension::density), 62.4 * 0.45359237 / std::pow(0.3048, 3), 1e-10);
  EXPECT_DOUBLE_EQ(si("1 g/cm^3", dimension::density), 1000);
  EXPECT_DOUBLE_EQ(si("2 Pa s", dimension::viscosity), 2);
  EXPECT_DOUBLE_EQ(si("2 Pa*s", dimension::viscosity), 2);
  EXPECT_DOUBLE_EQ(si("2 kg m^-1 s^-1", dimension::viscosity), 2);
  EXPECT_DOUBLE_EQ(si("3 1/m", dimension::wavenumber), 3);
  EXPECT_DOUBLE_EQ(si("3 /cm", dimension::wavenumber), 300);
  EXPECT_DOUBLE_EQ(si("3 m/s/s", dimension::acceleration), 3);
  EXPECT_DOUBLE_EQ(si("1e-3", dimension::length), 1e-3);
  EXPECT_DOUBLE_EQ(si("-1.5", dimension::velocity), -1.5);
  EXPECT_DOUBLE_EQ(si("+.5", dimension::none), 0.5);
}

TEST(ConfigUnits, WordsWithSeveralMeaningsAreThoseOfMechanics) {
  EXPECT_DOUBLE_EQ(si("1 in", dimension::length), 0.0254);
  EXPECT_DOUBLE_EQ(si("1 inch", dimension::length), 0.0254);
  EXPECT_DOUBLE_EQ(si("2 feet", dimension::length), 0.6096);
  EXPECT_DOUBLE_EQ(si("1 h", dimension::time), 3600) << "hour, not hecto";
  EXPECT_DOUBLE_EQ(si("1 min", dimension::time), 60) << "minute, not milli-inch";
  EXPECT_DOUBLE_EQ(si("1 d", dimension::time), 86400);
  EXPECT_DOUBLE_EQ(si("1 lb", dimension::mass), 0.45359237) << "mass, not force";
  EXPECT_DOUBLE_EQ(si("1 g", dimension::mass), 1e-3) << "gram, not gravity";
  EXPECT_DOUBLE_EQ(si("1 t", dimension::mass), 1000);
  EXPECT_DOUBLE_EQ(si("1 Mg", dimension::mass), 1000);
  EXPECT_DOUBLE_EQ(si("1 mg", dimension::mass), 1e-6);
  EXPECT_DOUBLE_EQ(si("1 P", dimension::viscosity), 0.1) << "poise, not peta";
  EXPECT_DOUBLE_EQ(si("1 cP", dimension::viscosity), 1e-3);
  EXPECT_DOUBLE_EQ(si("1 hPa", dimension::pressure), 100);
  EXPECT_DOUBLE_EQ(si("1 MPa", dimension::pressure), 1e6);
  EXPECT_DOUBLE_EQ(si("1 mPa", dimension::pressure), 1e-3);
  EXPECT_DOUBLE_EQ(si("1 mph", dimension::velocity), 0.44704) << "miles per hour, not milliphot";
  EXPECT_NEAR(si("1 inHg", dimension::pressure), 3386.389, 1e-3);
  EXPECT_NEAR(si("12 inH2O", dimension::pressure), si("1 ftH2O", dimension::pressure), 1e-9);
  EXPECT_NEAR(si("144 psf", dimension::pressure), si("1 psi", dimension::pressure), 1e-9);
  EXPECT_NEAR(si("1 lbf/in^2", dimension::pressure), si("1 psi", dimension::pressure), 1e-9);
  EXPECT_DOUBLE_EQ(si("1 dyn/cm^2", dimension::pressure), 0.1);
  EXPECT_DOUBLE_EQ(si("3 rad/m", dimension::wavenumber), 3);
  EXPECT_DOUBLE_EQ(si("1 km/h", dimension::velocity), 1 / 3.6);
}

TEST(ConfigUnits, TraditionalUnitsOfExplosivesAreThoseOfTheDatabase) {
  EXPECT_DOUBLE_EQ(si("1 ft", dimension::length), traditional::foot);
  EXPECT_DOUBLE_EQ(si("1 lb", dimension::mass), traditional::pound);
  EXPECT_DOUBLE_EQ(si("1 ftH2O", dimension::pressure), traditional::foot_of_water);
}

TEST(ConfigUnits, RefusesWhatIsNotMechanicsOrNoUnit) {
  for (const std::string text : {"1 K", "1 degC", "1 A", "1 mol", "1 lumen", "1 dB", "1 5", "1 m5x", "1 s @ 5",
                                 "1 lg(re 1 mW)", "1 seconds since 2000-01-01", "1 m^0.5", "1 'm", "1 m m 2"}) {
    EXPECT_THROW(si(text, dimension::length), InputError) << text;
    EXPECT_THROW(si(text, dimension::none), InputError) << text;
  }
}

TEST(ConfigUnits, RefusesWhatDoesNotFit) {
  for (const std::string text : {"2.5 kg", "2.5 parsek", "in", "", "2.5 in in", "2.5 m^2", "2.5 m/", "2.5 m^", "2.5 /",
                                 "1,5", "0x10 m", "inf", ".inf", "nan", "1e999", "--1", "1 m m^-0x", "1e308 km"}) {
    EXPECT_THROW(si(text, dimension::length), InputError) << text;
  }
}

TEST(ConfigUnits, RefusesUnitsWhereThereAreNone) {
  EXPECT_THROW(parse_quantity("2.5 in", dimension::length, UnitSystem::none), InputError);
  EXPECT_EQ(parse_quantity("2.5", dimension::length, UnitSystem::none), 2.5);
}

TEST(ConfigUnits, SaysWhatItExpects) {
  try {
    si("2 kg", dimension::pressure);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "must be a pressure or stress (such as Pa) or a number in SI, but the unit 'kg' is a mass (such as kg)");
  }
  try {
    si("2 pound_of_sand", dimension::mass);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("unknown unit 'pound_of_sand'; some of those known are m, cm"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace quicksand
