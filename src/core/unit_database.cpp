#include "core/unit_database.hpp"

#include <udunits2.h>

#include <memory>
#include <mutex>
#include <utility>

#include "core/errors.hpp"

namespace quicksand {

namespace {

struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
using UnitPointer = std::unique_ptr<ut_unit, FreeUnit>;

/// Units in use that the database does not have, or has as something else (mph: milliphot).
constexpr std::pair<const char*, const char*> additions[] = {
    {"P", "poise"}, {"psf", "lbf/ft^2"}, {"mph", "mile/hour"}, {"inH2O", "inch H2O"}, {"dyn", "dyne"}, {"lbm", "lb"},
};

class Database {
 public:
  Database() {
    // Errors are known by what functions return; the library would print them.
    ut_set_error_message_handler(ut_ignore);
    system_.reset(ut_read_xml(nullptr));
    if (system_ == nullptr) {
      ut_status status;
      const char* path = ut_get_path_xml(nullptr, &status);
      throw FileError(std::string(path != nullptr ? path : "UDUNITS-2") +
                      ": can't read the database of units (Debian's libudunits2-data, or the file that the "
                      "environment variable UDUNITS2_XML_PATH names)");
    }
    for (const auto& [symbol, meaning] : additions) ut_map_symbol_to_unit(symbol, UT_ASCII, parse(meaning).get());
    kilogram_ = parse("kg");
    meter_ = parse("m");
    second_ = parse("s");
  }

  UnitPointer parse(const char* text) const { return UnitPointer(ut_parse(system_.get(), text, UT_ASCII)); }

  const ut_unit* kilogram() const { return kilogram_.get(); }
  const ut_unit* meter() const { return meter_.get(); }
  const ut_unit* second() const { return second_.get(); }

 private:
  struct FreeSystem {
    void operator()(ut_system* system) const { ut_free_system(system); }
  };
  std::unique_ptr<ut_system, FreeSystem> system_;
  UnitPointer kilogram_, meter_, second_;
};

/// What a visit to a unit has found: a multiple of powers of kg, m and s.
struct Visit {
  const Database* database;
  Unit unit{};
};

ut_status visit_product(const ut_unit*, int count, const ut_unit* const* basic, const int* powers, void* argument) {
  Visit& visit = *static_cast<Visit*>(argument);
  Dimension& dimension = visit.unit.dimension;
  for (int k = 0; k < count; ++k) {
    const std::pair<const ut_unit*, int*> exponents[] = {{visit.database->kilogram(), &dimension.mass},
                                                         {visit.database->meter(), &dimension.length},
                                                         {visit.database->second(), &dimension.time}};
    bool found = ut_is_dimensionless(basic[k]) != 0;  // the radian
    for (const auto& [base, exponent] : exponents) {
      if (found || ut_compare(base, basic[k]) != 0) continue;
      *exponent += powers[k];
      found = true;
    }
    if (!found) return UT_MEANINGLESS;
  }
  return UT_SUCCESS;
}

ut_status visit_basic(const ut_unit* unit, void* argument) {
  const int power = 1;
  return visit_product(nullptr, 1, &unit, &power, argument);
}

const ut_visitor& multiples();

ut_status visit_scaled(const ut_unit*, double scale, const ut_unit* underlying, double offset, void* argument) {
  if (offset != 0) return UT_MEANINGLESS;
  static_cast<Visit*>(argument)->unit.factor *= scale;
  return ut_accept_visitor(underlying, &multiples(), argument);
}

ut_status visit_time_stamp(const ut_unit*, const ut_unit*, double, void*) { return UT_MEANINGLESS; }

ut_status visit_logarithm(const ut_unit*, double, const ut_unit*, void*) { return UT_MEANINGLESS; }

const ut_visitor& multiples() {
  static const ut_visitor visitor{visit_basic, visit_product, visit_scaled, visit_time_stamp, visit_logarithm};
  return visitor;
}

}  // namespace

Unit find_unit(const std::string& word) {
  // The library's parser has a state of its own.
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  static const Database database;
  const UnitPointer unit = database.parse(word.c_str());
  if (unit == nullptr) {
    throw InputError(
        "unknown unit '" + word +
        "'; some of those known are m, cm, mm, in, ft, s, ms, min, kg, g, lb, Pa, bar, atm, psi, ftH2O, P");
  }
  Visit visit{&database};
  if (ut_accept_visitor(unit.get(), &multiples(), &visit) != UT_SUCCESS) {
    throw InputError("unit '" + word + "' is not made of mass, length and time");
  }
  return visit.unit;
}

}  // namespace quicksand
