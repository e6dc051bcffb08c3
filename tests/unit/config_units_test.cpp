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

TEST(ConfigUnits, RefusesWhatDoesNotFit) {
  for (const std::string text : {"2.5 kg", "2.5 parsec", "in", "", "2.5 in in", "2.5 m^2", "2.5 m/", "2.5 m^", "2.5 /",
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
}

}  // namespace
}  // namespace quicksand
