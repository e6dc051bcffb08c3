#pragma once
/// \file
/// Explanations of case files, from the description that they are read by.
#include <string>

#include "app/case_config.hpp"

namespace quicksand {

/// The case with every default, and comments that explain each key. Reads back to the same case.
std::string explained_case(const CaseConfig& config);

/// A small case to begin with, explained, with all keys and forms that it does not use in comments.
std::string case_template();

/// What a key is, or all keys whose path ends in what is given.
/// \throws InputError if there is none, with the nearest in spelling
std::string explain_key(const std::string& path);

/// All keys of a case as a page in Markdown.
std::string case_reference();

}  // namespace quicksand
