// SPDX-License-Identifier: MIT
// The one exception of the library: the user's input or machine is at fault. what() is one line
// that starts with the place, ready for standard error. Our own bugs are assertions instead.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace lantern {

/// Where in the input something is wrong. Lines and columns count from 1, bytes from 0.
struct Place {
  std::string file;
  std::optional<int> line = std::nullopt;
  std::optional<int> column = std::nullopt;
  std::optional<std::uint64_t> byte = std::nullopt;
};

/// "file", "file:line", "file:line:column" or "file: byte N".
std::string to_string(const Place& place);

class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message) : std::runtime_error(one_line(message)) {}
  Error(const Place& place, const std::string& message)
      : std::runtime_error(one_line(to_string(place) + ": " + message)) {}

 private:
  static std::string one_line(std::string text);
};

template <typename... Args>
[[noreturn]] void fail(const Place& place, fmt::format_string<Args...> text, Args&&... args) {
  throw Error(place, fmt::format(text, std::forward<Args>(args)...));
}

}  // namespace lantern
