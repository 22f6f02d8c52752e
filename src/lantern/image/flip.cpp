// SPDX-License-Identifier: MIT
#include "lantern/image/flip.h"

#include "lantern/core/parallel.h"
#include "lantern/image/compare.h"

#include <glm/gtc/matrix_access.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>

namespace lantern {
namespace {

using glm::dmat3;
using glm::dvec3;

constexpr std::size_t kRowsOfTask = 8;

/// One channel of a picture.
struct Plane {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<float> values;

  Plane(std::size_t w, std::size_t h) : width(w), height(h), values(w * h) {}
  std::span<float> row(std::size_t y) { return std::span(values).subspan(y * width, width); }
  std::span<const float> row(std::size_t y) const {
    return std::span(values).subspan(y * width, width);
  }
};

void for_each_row(const Plane& plane, const std::function<void(std::size_t)>& body) {
  parallel_for(plane.height, kRowsOfTask, body);
}

void for_each_pixel(std::size_t count, const std::function<void(std::size_t)>& body) {
  constexpr std::size_t kPixelsOfTask = 4096;
  parallel_for(count, kPixelsOfTask, body);
}

// ---- Filters ----

/// Weights at -radius .. radius.
using Kernel = std::vector<double>;

Kernel make_kernel(std::size_t radius, const std::function<double(double)>& weight) {
  Kernel kernel;
  for (std::size_t i = 0; i <= 2 * radius; ++i) {
    kernel.push_back(weight(static_cast<double>(i) - static_cast<double>(radius)));
  }
  return kernel;
}

double sum(const Kernel& kernel) {
  double total = 0.0;
  for (const double weight : kernel) total += weight;
  return total;
}

/// Positive weights made to sum to 1, negative ones to -1.
Kernel balanced(Kernel kernel) {
  double positive = 0.0, negative = 0.0;
  for (const double weight : kernel) (weight > 0.0 ? positive : negative) += std::abs(weight);
  for (double& weight : kernel) {
    if (weight != 0.0) weight /= weight > 0.0 ? positive : negative;
  }
  return kernel;
}

/// `across` along the rows, then `down` along the columns. Beyond its border a picture goes on as
/// it is there.
Plane filtered(const Plane& in, const Kernel& across, const Kernel& down) {
  Plane half(in.width, in.height), out(in.width, in.height);
  const auto inside = [](std::size_t i, std::size_t offset, std::size_t radius, std::size_t size) {
    return std::min(std::max(i + offset, radius) - radius, size - 1);
  };
  for_each_row(in, [&](std::size_t y) {
    const std::span<const float> from = in.row(y);
    const std::span<float> to = half.row(y);
    for (std::size_t x = 0; x < in.width; ++x) {
      double total = 0.0;
      for (std::size_t k = 0; k < across.size(); ++k) {
        total += across[k] * static_cast<double>(from[inside(x, k, across.size() / 2, in.width)]);
      }
      to[x] = static_cast<float>(total);
    }
  });
  for_each_row(in, [&](std::size_t y) {
    std::vector<double> total(in.width, 0.0);
    for (std::size_t k = 0; k < down.size(); ++k) {
      const std::span<const float> from = half.row(inside(y, k, down.size() / 2, in.height));
      for (std::size_t x = 0; x < in.width; ++x) total[x] += down[k] * static_cast<double>(from[x]);
    }
    const std::span<float> to = out.row(y);
    for (std::size_t x = 0; x < in.width; ++x) to[x] = static_cast<float>(total[x]);
  });
  return out;
}

// ---- The colour pipeline ----

/// Linear Rec. 709 to CIE XYZ relative to the white of the screen, D65.
const dmat3& xyz_of_rgb() {
  static const dmat3 matrix = [] {
    const dmat3 absolute = glm::transpose(dmat3(0.4123907993, 0.3575843394, 0.1804807884,  //
                                                0.2126390059, 0.7151686788, 0.0721923154,  //
                                                0.0193308187, 0.1191947798, 0.9505321522));
    const dvec3 white = absolute * dvec3(1.0);
    return glm::transpose(dmat3(glm::row(absolute, 0) / white[0], glm::row(absolute, 1) / white[1],
                                glm::row(absolute, 2) / white[2]));
  }();
  return matrix;
}

/// YCxCz without its factors and offset, which filters of weight 1 leave as they are: Y, X - Y and
/// Y - Z (the linearised CIELAB).
dvec3 opponent_of_xyz(const dvec3& xyz) { return {xyz.y, xyz.x - xyz.y, xyz.y - xyz.z}; }
dvec3 xyz_of_opponent(const dvec3& c) { return {c[0] + c[1], c[0], c[0] - c[2]}; }

/// Linear RGB in [0, 1] to CIELAB (CIE 15), its chroma scaled by the lightness: Hunt's effect.
dvec3 hunt_lab(const dvec3& rgb) {
  const auto f = [](double t) {
    constexpr double kDelta = 6.0 / 29.0;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
  };
  const dvec3 xyz = xyz_of_rgb() * rgb;
  const double lightness = 116.0 * f(xyz.y) - 16.0;
  const double chroma_scale = 0.01 * lightness;
  return {lightness, chroma_scale * 500.0 * (f(xyz.x) - f(xyz.y)),
          chroma_scale * 200.0 * (f(xyz.y) - f(xyz.z))};
}

/// City-block in lightness, Euclidean in chroma. [Abasi et al. 2020]
double hyab(const dvec3& a, const dvec3& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

/// Contrast sensitivity of the eye to one channel, as its spatial response: a sum of two Gaussians
/// a sqrt(pi/b) exp(-pi² x²/b), x in degrees.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> kSensitivity = {
    {{1.0, 0.0047, 0.0, 1e-5}, {1.0, 0.0053, 0.0, 1e-5}, {34.1, 0.04, 13.5, 0.025}}};
constexpr double kWidest = 0.04;  // the largest b

Plane as_seen(const Plane& in, const Sensitivity& s, double pixels_per_degree) {
  constexpr double kPi2 = std::numbers::pi * std::numbers::pi;
  // Three standard deviations of the widest Gaussian.
  const auto radius = static_cast<std::size_t>(
      std::ceil(3.0 * std::sqrt(kWidest / (2.0 * kPi2)) * pixels_per_degree));
  double total = 0.0;
  Plane out(in.width, in.height);
  const auto add = [&](double a, double b) {
    if (a == 0.0) return;
    Kernel kernel = make_kernel(radius, [&](double pixels) {
      const double x = pixels / pixels_per_degree;
      return std::exp(-kPi2 * x * x / b);
    });
    const double side = sum(kernel);
    for (double& weight : kernel) weight /= side;
    const Plane part = filtered(in, kernel, kernel);
    const double share = a * std::sqrt(std::numbers::pi / b) * side * side;
    total += share;
    const auto mix = static_cast<float>(share / total);
    for (std::size_t i = 0; i < out.values.size(); ++i) {
      out.values[i] += mix * (part.values[i] - out.values[i]);
    }
  };
  add(s.a1, s.b1);
  add(s.a2, s.b2);
  return out;
}

/// Large differences of colour are squeezed: up to 0.4 of the largest there is, green to blue, they
/// take 0.95 of the range.
double colour_error(const dvec3& a, const dvec3& b) {
  constexpr double kExponent = 0.7, kKnee = 0.4, kRangeToKnee = 0.95;
  static const double largest =
      std::pow(hyab(hunt_lab(dvec3(0.0, 1.0, 0.0)), hunt_lab(dvec3(0.0, 0.0, 1.0))), kExponent);
  const double share = std::min(1.0, std::pow(hyab(a, b), kExponent) / largest);
  if (share < kKnee) return kRangeToKnee / kKnee * share;
  return kRangeToKnee + (share - kKnee) / (1.0 - kKnee) * (1.0 - kRangeToKnee);
}

// ---- The feature pipeline ----

/// What FLIP compares of a picture.
struct Impression {
  std::vector<dvec3> colour;  // CIELAB with Hunt's effect, as far as the eye resolves it
  Plane edges, points;        // strength of edges and of points at each pixel
};

/// Length of the vector that a filter across and the same filter down give.
Plane strength(const Plane& in, const Kernel& feature, const Kernel& smooth) {
  Plane across = filtered(in, feature, smooth);
  const Plane down = filtered(in, smooth, feature);
  for (std::size_t i = 0; i < across.values.size(); ++i) {
    across.values[i] = std::hypot(across.values[i], down.values[i]);
  }
  return across;
}

Impression look_at(const Image& image, const FlipOptions& options) {
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  std::array<Plane, 3> channel = {Plane(width, height), Plane(width, height), Plane(width, height)};
  for_each_pixel(image.pixels.size(), [&](std::size_t i) {
    const dvec3 c = opponent_of_xyz(xyz_of_rgb() * dvec3(shown(image.pixels[i], options.tone)));
    channel[0].values[i] = static_cast<float>(c[0]);
    channel[1].values[i] = static_cast<float>(c[1]);
    channel[2].values[i] = static_cast<float>(c[2]);
  });

  // Standard deviation of the detectors in pixels: half of a width of 0.082 degrees.
  const double deviation = 0.5 * 0.082 * options.pixels_per_degree;
  const auto radius = static_cast<std::size_t>(std::ceil(3.0 * deviation));
  const auto gaussian = [&](double x) { return std::exp(-x * x / (2.0 * deviation * deviation)); };
  const auto slope = [&](double x) { return -x * gaussian(x); };
  const auto bend = [&](double x) { return (x * x / (deviation * deviation) - 1.0) * gaussian(x); };
  const Kernel smooth = balanced(make_kernel(radius, gaussian));
  Impression seen{std::vector<dvec3>(image.pixels.size()),
                  strength(channel[0], balanced(make_kernel(radius, slope)), smooth),
                  strength(channel[0], balanced(make_kernel(radius, bend)), smooth)};

  for (std::size_t k = 0; k < 3; ++k) {
    channel[k] = as_seen(channel[k], kSensitivity[k], options.pixels_per_degree);
  }
  static const dmat3 rgb_of_xyz = glm::inverse(xyz_of_rgb());
  for_each_pixel(image.pixels.size(), [&](std::size_t i) {
    const dvec3 opponent(channel[0].values[i], channel[1].values[i], channel[2].values[i]);
    const dvec3 rgb = rgb_of_xyz * xyz_of_opponent(opponent);
    seen.colour[i] = hunt_lab(glm::clamp(rgb, 0.0, 1.0));
  });
  return seen;
}

double feature_error(double edges_a, double edges_b, double points_a, double points_b) {
  const double largest = std::max(std::abs(edges_a - edges_b), std::abs(points_a - points_b));
  return std::sqrt(std::min(1.0, largest / std::numbers::sqrt2));
}

}  // namespace

Flip flip(const Image& a, const Image& b, const FlipOptions& options) {
  assert(options.pixels_per_degree >= 1.0 && options.pixels_per_degree <= 1000.0);
  require_comparable(a, b);
  const Impression seen_a = look_at(a, options), seen_b = look_at(b, options);
  Flip result;
  result.error.resize(a.pixels.size());
  for_each_pixel(a.pixels.size(), [&](std::size_t i) {
    const double colour = colour_error(seen_a.colour[i], seen_b.colour[i]);
    const auto at = [i](const Plane& plane) { return static_cast<double>(plane.values[i]); };
    const double features =
        feature_error(at(seen_a.edges), at(seen_b.edges), at(seen_a.points), at(seen_b.points));
    result.error[i] = static_cast<float>(std::pow(colour, 1.0 - features));
  });
  for (const float error : result.error) result.mean += static_cast<double>(error);
  result.mean /= static_cast<double>(result.error.size());
  return result;
}

}  // namespace lantern
