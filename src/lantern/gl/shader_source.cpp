// SPDX-License-Identifier: MIT
#include "lantern/gl/shader_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <sstream>
#include <string_view>

namespace lantern::gl {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr const char* kSpace = " \t\r";
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) + 1 - first);
}

/// What follows "#", "include" or the like at the start of a line.
std::optional<std::string_view> after(std::string_view word, std::string_view text) {
  if (!text.starts_with(word)) return std::nullopt;
  return trimmed(text.substr(word.size()));
}

std::optional<std::string_view> directive(std::string_view word, std::string_view line) {
  const auto rest = after("#", trimmed(line));
  return rest ? after(word, *rest) : std::nullopt;
}

/// "NAME" with quotes around it and at most a comment behind.
std::optional<std::string> quoted(std::string_view text) {
  if (!text.starts_with('"')) return std::nullopt;
  const std::size_t end = text.find('"', 1);
  if (end == std::string_view::npos || end == 1) return std::nullopt;
  const std::string_view rest = trimmed(text.substr(end + 1));
  if (!rest.empty() && !rest.starts_with("//")) return std::nullopt;
  return std::string(text.substr(1, end - 1));
}

class Composer {
 public:
  Composer(const ShaderFiles& files, ShaderSource& source) : files_(files), source_(source) {}

  void add(const std::string& name, const std::string& text) {
    const std::size_t number = source_.files.size();
    source_.files.push_back(name);
    std::istringstream lines(text);
    std::string line;
    for (int i = 1; std::getline(lines, line); ++i) {
      if (const auto what = directive("include", line)) {
        include(*what, {.file = name, .line = i});
      } else if (directive("pragma", line) != "once") {  // every file is taken in once
        source_.text += line + "\n";
        source_.origins.push_back({number, i});
      }
    }
  }

 private:
  void include(std::string_view what, const Place& place) {
    const std::optional<std::string> name = quoted(what);
    if (!name) throw Error(place, "#include takes a name in quotes");
    if (std::find(source_.files.begin(), source_.files.end(), *name) != source_.files.end()) return;
    const std::optional<std::string> text = files_.find(*name);
    if (!text) throw Error(place, fmt::format("there is no '{}'", *name));
    add(*name, *text);
  }

  const ShaderFiles& files_;
  ShaderSource& source_;
};

/// Line, column (0: not said) and text of an error in one of the forms that compilers write.
struct Complaint {
  std::size_t line = 0;
  int column = 0;
  std::string text;
};

std::optional<Complaint> complaint_in(const std::string& line) {
  Complaint found;
  int text = 0;
  std::sscanf(line.c_str(), "%*u:%zu(%d): error: %n", &found.line, &found.column, &text);
  if (text == 0) {
    found.column = 0;
    std::sscanf(line.c_str(), "%*u(%zu) : error %n", &found.line, &text);
  }
  if (text == 0) std::sscanf(line.c_str(), "ERROR: %*u:%zu: %n", &found.line, &text);
  if (text == 0) return std::nullopt;
  found.text = line.substr(static_cast<std::size_t>(text));
  return found;
}

}  // namespace

ShaderSource compose(const ShaderFiles& files, const std::string& name,
                     const std::string& prelude) {
  const std::optional<std::string> text = files.find(name);
  if (!text) throw Error({.file = name}, "there is no such shader");
  ShaderSource source;
  source.text = prelude;
  source.origins.resize(static_cast<std::size_t>(std::count(prelude.begin(), prelude.end(), '\n')));
  Composer(files, source).add(name, *text);
  return source;
}

Error compile_error(const ShaderSource& source, const std::string& log) {
  std::istringstream lines(log);
  std::string line;
  while (std::getline(lines, line)) {
    const std::optional<Complaint> complaint = complaint_in(line);
    if (!complaint || complaint->line < 1 || complaint->line > source.origins.size()) continue;
    const ShaderSource::Origin origin = source.origins[complaint->line - 1];
    Place place{.file = source.files[origin.file], .line = origin.line};
    if (complaint->column > 0) place.column = complaint->column;
    return {place, complaint->text};
  }
  return {{.file = source.files.front()}, log};
}

}  // namespace lantern::gl
