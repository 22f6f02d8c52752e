// SPDX-License-Identifier: MIT
// A shader's text out of several files: `#include "shaders/NAME"` on a line of its own takes a file
// in, once. Each line of the text knows where it came from, so that what a compiler says can be led
// back to the file. Errors: Error with the file and line of the include.
#pragma once

#include "lantern/core/error.h"
#include "lantern/gl/shader_files.h"

#include <cstddef>
#include <string>
#include <vector>

namespace lantern::gl {

/// Without #line: Mesa 22 forgets the number of the source in what it says of expressions.
struct ShaderSource {
  struct Origin {
    std::size_t file;
    int line;
  };
  std::string text;
  std::vector<std::string> files;  // the first is the one that was asked for
  std::vector<Origin> origins;     // of the lines of `text`; those of the prelude are line 0
};

/// `prelude` goes before everything: version, precisions, definitions; whole lines.
ShaderSource compose(const ShaderFiles& files, const std::string& name, const std::string& prelude);

/// The first error of a compiler's log with its place, from the forms that Mesa ("0:20(3): error:
/// text"), NVIDIA ("0(20) : error C0000: text") and ANGLE ("ERROR: 0:20: text") write. Where none
/// is recognised the whole log, placed in the first file.
Error compile_error(const ShaderSource& source, const std::string& log);

}  // namespace lantern::gl
