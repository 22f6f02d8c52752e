// SPDX-License-Identifier: MIT
// What Ogre's text formats share: numbers, findings with their places, and XML elements read with
// both. Errors: Error with file and line, the first few findings in one line.
#pragma once

#include "lantern/core/error.h"
#include "lantern/core/math.h"

#include <tinyxml2.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lantern::ogre {

/// The finite number that is the whole text; none for "abc", "nan", "inf" and "1e999". What is too
/// small for a float is 0.
std::optional<float> parse_float(std::string_view text);

std::optional<std::uint32_t> parse_unsigned(std::string_view text);

/// The parts between blanks.
std::vector<std::string_view> split(std::string_view text);

/// Collects what is wrong, so that one message names all of it (the first few).
class Findings {
 public:
  template <typename... Args>
  void add(const Place& place, fmt::format_string<Args...> text, Args&&... args) {
    constexpr std::size_t kNamed = 4;
    if (++count_ > kNamed) return;
    if (count_ == 1) first_ = place;
    if (count_ > 1) text_ += "; " + to_string(place) + ": ";
    text_ += fmt::format(text, std::forward<Args>(args)...);
    named_ = count_;
  }
  void throw_if_any() const;

 private:
  Place first_;
  std::string text_;
  std::size_t named_ = 0;
  std::size_t count_ = 0;
};

/// An XML file in memory. The readers note what is wrong in `findings` and return the fallback, or
/// zero, so that reading can go on.
class XmlFile {
 public:
  /// Throws unless `text` is XML with that root. Elements may nest 100 deep (a limit of TinyXML-2).
  XmlFile(std::string_view text, std::string name, const char* root);

  const tinyxml2::XMLElement& root() const { return *document_.RootElement(); }
  Place place(const tinyxml2::XMLElement& element) const;

  float number(const tinyxml2::XMLElement& element, const char* attribute,
               std::optional<float> fallback = std::nullopt);
  std::uint32_t count(const tinyxml2::XMLElement& element, const char* attribute,
                      std::optional<std::uint32_t> fallback = std::nullopt);
  bool flag(const tinyxml2::XMLElement& element, const char* attribute, bool fallback);
  std::string text(const tinyxml2::XMLElement& element, const char* attribute) const;
  Vec3 vector(const tinyxml2::XMLElement& element, std::optional<float> fallback = std::nullopt);
  Rgb colour(const tinyxml2::XMLElement& element);

  Findings findings;

 private:
  tinyxml2::XMLDocument document_;
  std::string name_;
};

}  // namespace lantern::ogre
