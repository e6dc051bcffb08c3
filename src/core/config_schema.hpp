#pragma once
/// \file
/// Parts of JSON Schemas (draft 2020-12) as configuration nodes, put together by codecs. Besides the keywords of the
/// standard they hold texts for explanations, under names that begin with `x-`.
#include <optional>
#include <string>
#include <vector>

#include "core/config_codec.hpp"

namespace quicksand {

/// What a value is, in words, where the keywords of the schema do not tell.
inline constexpr const char* schema_value = "x-value";
/// Usual values of a key.
inline constexpr const char* schema_typical = "x-typical";

/// The schema as editors want it: descriptions hold the usual values too, and no key begins with `x-`.
ConfigNode plain_schema(const ConfigNode& schema);

namespace detail {

ConfigNode typed_schema(const std::string& type);
/// A number, or where it has a dimension also text that begins with a number.
ConfigNode quantity_schema(const Dimension& dimension, const Range& range);

}  // namespace detail

}  // namespace quicksand
