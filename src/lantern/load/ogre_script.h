// SPDX-License-Identifier: MIT
// The syntax of Ogre's scripts, whatever they describe: blocks in braces and lines of words, with
// // and /* */ comments, quoted words and $variables. Errors: Error with file and line.
// Source: the Ogre manual, Scripts.
#pragma once

#include "lantern/core/error.h"

#include <string>
#include <string_view>
#include <vector>

namespace lantern::ogre {

struct Word {
  std::string text;
  bool is_variable = false;  // `text` starts with its $
};

/// `words {children}` or, if it is no block, a line of words (at least one).
struct Statement {
  int line = 0;
  std::vector<Word> words;
  std::vector<std::string> parents;  // after a colon
  bool is_block = false;
  std::vector<Statement> children;
};

/// `file` is for messages. Blocks may nest 32 deep.
std::vector<Statement> parse_script(std::string_view text, const std::string& file);

}  // namespace lantern::ogre
