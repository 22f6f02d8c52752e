// SPDX-License-Identifier: MIT
#include "lantern/load/ogre_text.h"

#include <charconv>
#include <cmath>

namespace lantern::ogre {
namespace {

using tinyxml2::XMLElement;

constexpr std::string_view kBlanks = " \t\r\n\f\v";

/// Ogre's exporters write a leading '+' and blanks around a number, which from_chars refuses.
std::string_view trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  text = text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

template <typename T>
std::errc whole_number(std::string_view text, T& value) {
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && rest != end ? std::errc::invalid_argument : error;
}

}  // namespace

std::optional<float> parse_float(std::string_view text) {
  text = trim(text);
  float value = 0.0f;
  std::errc error = whole_number(text, value);
  if (error == std::errc::result_out_of_range) {
    // from_chars does not say whether the number was too large or too small.
    double wide = 0.0;
    error = whole_number(text, wide);
    if (error == std::errc() && std::abs(wide) > 1.0) return std::nullopt;
    value = 0.0f;
  }
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::uint32_t> parse_unsigned(std::string_view text) {
  std::uint32_t value = 0;
  if (whole_number(trim(text), value) != std::errc()) return std::nullopt;
  return value;
}

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = text.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(kBlanks, end);
  }
  return parts;
}

void Findings::throw_if_any() const {
  if (count_ == 0) return;
  throw Error(first_,
              count_ == named_ ? text_ : fmt::format("{}; and {} more", text_, count_ - named_));
}

XmlFile::XmlFile(std::string_view text, std::string name, const char* root)
    : name_(std::move(name)) {
  document_.Parse(text.data(), text.size());
  if (document_.Error()) {
    Place place{name_};
    if (document_.ErrorLineNum() > 0) place.line = document_.ErrorLineNum();
    switch (document_.ErrorID()) {
      case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
        fail(place, "is empty");
      case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
        fail(place, "elements nest deeper than {}", TINYXML2_MAX_ELEMENT_DEPTH);
      default:
        fail(place, "is no well-formed XML ({})", document_.ErrorName());
    }
  }
  const XMLElement* element = document_.RootElement();
  if (!element) fail({name_}, "has no element");
  if (std::string_view(element->Name()) != root) {
    fail(place(*element), "starts with <{}> where <{}> is expected", element->Name(), root);
  }
}

Place XmlFile::place(const XMLElement& element) const { return {name_, element.GetLineNum()}; }

float XmlFile::number(const XMLElement& element, const char* attribute,
                      std::optional<float> fallback) {
  const char* value = element.Attribute(attribute);
  if (!value && fallback) return *fallback;
  if (!value) {
    findings.add(place(element), "<{}> has no {}", element.Name(), attribute);
    return 0.0f;
  }
  if (const auto number = parse_float(value)) return *number;
  findings.add(place(element), "{}=\"{}\" is no finite number", attribute, value);
  return fallback.value_or(0.0f);
}

std::uint32_t XmlFile::count(const XMLElement& element, const char* attribute,
                             std::optional<std::uint32_t> fallback) {
  const char* value = element.Attribute(attribute);
  if (!value && fallback) return *fallback;
  if (!value) {
    findings.add(place(element), "<{}> has no {}", element.Name(), attribute);
    return 0;
  }
  if (const auto number = parse_unsigned(value)) return *number;
  findings.add(place(element), "{}=\"{}\" is no count", attribute, value);
  return fallback.value_or(0);
}

bool XmlFile::flag(const XMLElement& element, const char* attribute, bool fallback) {
  const char* value = element.Attribute(attribute);
  if (!value) return fallback;
  const std::string_view word(value);
  if (word == "true" || word == "yes" || word == "on" || word == "1") return true;
  if (word == "false" || word == "no" || word == "off" || word == "0") return false;
  findings.add(place(element), "{}=\"{}\" is neither true nor false", attribute, value);
  return fallback;
}

std::string XmlFile::text(const XMLElement& element, const char* attribute) const {
  const char* value = element.Attribute(attribute);
  return value ? value : "";
}

Vec3 XmlFile::vector(const XMLElement& element, std::optional<float> fallback) {
  return {number(element, "x", fallback), number(element, "y", fallback),
          number(element, "z", fallback)};
}

Rgb XmlFile::colour(const XMLElement& element) {
  return {number(element, "r"), number(element, "g"), number(element, "b")};
}

}  // namespace lantern::ogre
