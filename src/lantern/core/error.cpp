// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"

namespace lantern {

std::string to_string(const Place& place) {
  if (place.byte) return fmt::format("{}: byte {}", place.file, *place.byte);
  if (place.line && place.column) {
    return fmt::format("{}:{}:{}", place.file, *place.line, *place.column);
  }
  if (place.line) return fmt::format("{}:{}", place.file, *place.line);
  return place.file;
}

std::string Error::one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return text;
}

}  // namespace lantern
