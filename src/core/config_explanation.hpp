#pragma once
/// \file
/// Explanations of a configuration for its user, from its schema: a case with comments, single keys, the reference
/// page.
#include <string>

#include "core/config_keys.hpp"

namespace quicksand {

/// A configuration as YAML in which comments say what each key means, what may be given, the default and usual values,
/// and what keys are not given. Reads back to the same tree.
/// \param forms  whether other forms of a value (other laws, other shapes) are listed as well
std::string explained_yaml(const ConfigNode& value, const ConfigNode& schema, bool forms);

/// What the keys that a user may mean by `path` are.
/// \throws InputError if there are none, with the nearest in spelling
std::string explain_keys(const ConfigNode& schema, const std::string& path);

/// All keys as a page in Markdown, a section per key of the root.
std::string reference_page(const ConfigNode& schema);

}  // namespace quicksand
