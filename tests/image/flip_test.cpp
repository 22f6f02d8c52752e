// SPDX-License-Identifier: MIT
#include "lantern/image/flip.h"

#include "lantern/core/error.h"
#include "lantern/core/hash.h"
#include "lantern/core/parallel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lantern {
namespace {

using glm::dvec3;

/// A step from dark to bright at column `edge`.
Image step(int edge, int width = 48, int height = 32) {
  Image image(width, height, Rgb(0.1f));
  for (int y = 0; y < height; ++y) {
    for (int x = edge; x < width; ++x) image.at(x, y) = Rgb(0.8f, 0.7f, 0.6f);
  }
  return image;
}

/// Smooth colours with blocks and dots in them.
Image busy(std::uint64_t seed, int width = 28, int height = 23) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto at = [seed](int i, int j, std::uint64_t k) {
        return to_unit_float(
            hash(seed + k, static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j)));
      };
      const float slope = static_cast<float>(x) / static_cast<float>(width);
      const Rgb block(at(x / 7, y / 5, 0), at(x / 7, y / 5, 1), at(x / 7, y / 5, 2));
      image.at(x, y) = 0.5f * block + Rgb(0.3f * slope);
      if (at(x, y, 3) < 0.02f) image.at(x, y) = Rgb(5.0f, 1.0f, 0.5f);
    }
  }
  return image;
}

/// Mean over a square of (2 radius + 1)² pixels inside the picture.
Image blurred(const Image& image, int radius) {
  Image out(image.width, image.height);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      Rgb sum(0.0f);
      for (int dy = -radius; dy <= radius; ++dy) {
        for (int dx = -radius; dx <= radius; ++dx) {
          sum += image.at(std::clamp(x + dx, 0, image.width - 1),
                          std::clamp(y + dy, 0, image.height - 1));
        }
      }
      out.at(x, y) = sum / static_cast<float>((2 * radius + 1) * (2 * radius + 1));
    }
  }
  return out;
}

double flip_of_constants(const Rgb& a, const Rgb& b) {
  return flip(Image(5, 4, a), Image(5, 4, b)).mean;
}

// ---- Constant pictures, which no filter changes: values worked out by hand ----

// CIELAB of the sRGB primaries under D65, to four decimals: red (53.2408, 80.0925, 67.2032), green
// (87.7347, -86.1827, 83.1793), blue (32.2970, 79.1875, -107.8602). With Hunt's effect the chroma
// is multiplied by L/100.
constexpr double kRed[3] = {53.2408, 0.532408 * 80.0925, 0.532408 * 67.2032};
constexpr double kGreen[3] = {87.7347, -0.877347 * 86.1827, 0.877347 * 83.1793};
constexpr double kBlue[3] = {32.2970, 0.322970 * 79.1875, -0.322970 * 107.8602};

double hyab(const double a[3], const double b[3]) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

double squeezed(double distance) {
  const double share = std::pow(distance, 0.7) / std::pow(hyab(kGreen, kBlue), 0.7);
  return share < 0.4 ? share * 0.95 / 0.4 : 0.95 + 0.05 * (share - 0.4) / 0.6;
}

// The tables of the primaries differ in their fourth digit with the white point's digits, and the
// planes are floats.
constexpr double kTableError = 2e-4;

TEST(Flip, BlackAgainstWhite) {
  // The lightness differs by 100: 100^0.7 = 25.12 of 203.2^0.7 = 41.26, a share of 0.609, beyond
  // the knee: 0.95 + 0.05 * 0.209 / 0.6 = 0.967.
  EXPECT_NEAR(flip_of_constants(Rgb(0.0f), Rgb(1.0f)), 0.967, 1e-3);
  EXPECT_NEAR(flip_of_constants(Rgb(0.0f), Rgb(1.0f)), squeezed(100.0), kTableError);
}

TEST(Flip, NeighbouringGreys) {
  // L* of 0.5 and 0.6 is 116 t^(1/3) - 16: 76.069 and 81.838; 5.769^0.7 / 41.26 * 0.95/0.4 = 0.196.
  const auto lightness = [](double y) { return 116.0 * std::cbrt(y) - 16.0; };
  EXPECT_NEAR(flip_of_constants(Rgb(0.5f), Rgb(0.6f)), 0.196, 1e-3);
  EXPECT_NEAR(flip_of_constants(Rgb(0.5f), Rgb(0.6f)), squeezed(lightness(0.6) - lightness(0.5)),
              kTableError);
}

TEST(Flip, Primaries) {
  const Rgb red(1.0f, 0.0f, 0.0f), green(0.0f, 1.0f, 0.0f), blue(0.0f, 0.0f, 1.0f);
  EXPECT_NEAR(flip_of_constants(green, blue), 1.0, kTableError);
  EXPECT_NEAR(flip_of_constants(red, green), squeezed(hyab(kRed, kGreen)), kTableError);
  EXPECT_NEAR(flip_of_constants(red, blue), squeezed(hyab(kRed, kBlue)), kTableError);
  EXPECT_LE(flip_of_constants(green, blue), 1.0);
}

TEST(Flip, GrowsWithTheShiftOfColour) {
  for (const Rgb direction : {Rgb(1.0f, -0.3f, 0.0f), Rgb(0.0f, 0.0f, 1.0f), Rgb(-1.0f)}) {
    double before = 0.0;
    for (float amount = 0.02f; amount < 0.4f; amount *= 1.5f) {
      const double now = flip_of_constants(Rgb(0.5f), Rgb(0.5f) + amount * direction);
      EXPECT_GT(now, before) << amount;
      before = now;
    }
  }
}

// ---- Pictures with something in them ----

TEST(Flip, APictureEqualsItself) {
  for (const float error : flip(busy(1), busy(1)).error) ASSERT_EQ(error, 0.0f);
  EXPECT_EQ(flip(busy(1), busy(1)).mean, 0.0);
}

TEST(Flip, SymmetricAndWithinItsRange) {
  const Flip forth = flip(busy(1), busy(2)), back = flip(busy(2), busy(1));
  EXPECT_EQ(forth.error, back.error);
  for (const float error : forth.error) {
    ASSERT_GE(error, 0.0f);
    ASSERT_LE(error, 1.0f);
  }
  EXPECT_GT(forth.mean, 0.2);
}

TEST(Flip, SeesAnEdgeMoveWhereItMoves) {
  const Image still = step(24);
  double before = 0.0;
  for (const int shift : {1, 2, 4, 8}) {
    const Flip moved = flip(still, step(24 + shift));
    EXPECT_GT(moved.mean, before) << shift;
    before = moved.mean;
    // 67 pixels a degree: the widest filter reaches ceil(3 * 67 * sqrt(0.04/2)/pi) = 10 pixels.
    for (int x : {0, 13, 24 + shift + 10, 47}) {
      const float error = moved.error[static_cast<std::size_t>(16 * 48 + x)];
      EXPECT_EQ(error, 0.0f) << shift << " " << x;
    }
    EXPECT_GT(moved.error[16 * 48 + 24], 0.1f);
  }
}

TEST(Flip, SeesLessFromAfar) {
  // More pixels in a degree: the same shift of an edge by a pixel is a smaller angle.
  double before = 1.0;
  for (const double pixels_per_degree : {10.0, 30.0, 67.0, 150.0}) {
    FlipOptions options;
    options.pixels_per_degree = pixels_per_degree;
    const double now = flip(step(100, 200, 3), step(101, 200, 3), options)
                           .error[200 + 100];  // the largest: where the edge moved
    EXPECT_LT(now, before) << pixels_per_degree;
    before = now;
  }
}

TEST(Flip, GrowsWithBlur) {
  const Image sharp = busy(3, 64, 64);
  double before = 0.0;
  for (int radius = 1; radius <= 5; ++radius) {
    const double now = flip(sharp, blurred(sharp, radius)).mean;
    EXPECT_GT(now, before) << radius;
    before = now;
  }
}

TEST(Flip, SeesAFirefly) {
  Image dotted(41, 41, Rgb(0.2f));
  dotted.at(20, 20) = Rgb(30.0f);
  const Flip seen = flip(Image(41, 41, Rgb(0.2f)), dotted);
  EXPECT_EQ(std::max_element(seen.error.begin(), seen.error.end()) - seen.error.begin(),
            20 * 41 + 20);
  EXPECT_GT(seen.error[20 * 41 + 20], 0.3f);
  EXPECT_EQ(seen.error[0], 0.0f);
}

TEST(Flip, ComparesWhatTheScreenShows) {
  const Image bright(4, 4, Rgb(3.0f)), brighter(4, 4, Rgb(12.0f));
  EXPECT_EQ(flip(bright, brighter).mean, 0.0);  // both are white
  FlipOptions options;
  options.tone.exposure = -4.0f;
  EXPECT_DOUBLE_EQ(flip(bright, brighter, options).mean,
                   flip_of_constants(Rgb(3.0f / 16.0f), Rgb(12.0f / 16.0f)));
  options = {};
  options.tone.curve = ToneCurve::kFilmic;
  EXPECT_GT(flip(bright, brighter, options).mean, 0.0);
}

TEST(Flip, TheSameOnAnyNumberOfThreads) {
  const Image a = busy(1, 90, 70), b = busy(2, 90, 70);
  std::vector<float> one, three;
  ThreadScope(1).run([&] { one = flip(a, b).error; });
  ThreadScope(3).run([&] { three = flip(a, b).error; });
  EXPECT_EQ(one, three);
}

TEST(Flip, RefusesWhatItCannotCompare) {
  EXPECT_THROW(flip(Image(2, 3), Image(3, 2)), Error);
  EXPECT_THROW(flip(Image(), Image()), Error);
  Image broken(4, 3);
  broken.at(2, 1).g = std::numeric_limits<float>::quiet_NaN();
  try {
    flip(Image(4, 3), broken);
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("second picture is not finite at pixel (2, 1)"));
  }
}

// ---- The same metric once more: plain sums over square kernels, YCxCz with all its factors ----

namespace plain {

using Channels = std::vector<dvec3>;

struct Picture {
  int width, height;
  Channels pixels;
  dvec3 at(int x, int y) const {
    return pixels[static_cast<std::size_t>(std::clamp(y, 0, height - 1) * width +
                                           std::clamp(x, 0, width - 1))];
  }
};

const dvec3 kWhite(0.950456, 1.0, 1.089058);

dvec3 to_xyz(const dvec3& c) {
  return {0.412391 * c.r + 0.357584 * c.g + 0.180481 * c.b,
          0.212639 * c.r + 0.715169 * c.g + 0.072192 * c.b,
          0.019331 * c.r + 0.119195 * c.g + 0.950532 * c.b};
}
dvec3 to_rgb(const dvec3& c) {
  return {3.240970 * c.x - 1.537383 * c.y - 0.498611 * c.z,
          -0.969244 * c.x + 1.875968 * c.y + 0.041555 * c.z,
          0.055630 * c.x - 0.203977 * c.y + 1.056972 * c.z};
}

dvec3 to_ycxcz(const dvec3& rgb) {
  const dvec3 t = to_xyz(rgb) / kWhite;
  return {116.0 * t.y - 16.0, 500.0 * (t.x - t.y), 200.0 * (t.y - t.z)};
}
dvec3 from_ycxcz(const dvec3& c) {
  const double y = (c[0] + 16.0) / 116.0;
  return to_rgb(kWhite * dvec3(c[1] / 500.0 + y, y, y - c[2] / 200.0));
}
dvec3 to_lab(const dvec3& rgb) {
  const auto f = [](double t) {
    return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
  };
  const dvec3 t = to_xyz(rgb) / kWhite;
  return {116.0 * f(t.y) - 16.0, 500.0 * (f(t.x) - f(t.y)), 200.0 * (f(t.y) - f(t.z))};
}

template <typename Weight>
dvec3 weighted(const Picture& picture, int x, int y, int radius, const Weight& weight) {
  dvec3 sum(0.0), positive(0.0), negative(0.0);
  for (int dy = -radius; dy <= radius; ++dy) {
    for (int dx = -radius; dx <= radius; ++dx) {
      const dvec3 w = weight(dx, dy);
      positive += glm::max(w, 0.0);
      negative -= glm::min(w, 0.0);
    }
  }
  for (int dy = -radius; dy <= radius; ++dy) {
    for (int dx = -radius; dx <= radius; ++dx) {
      const dvec3 w = weight(dx, dy);
      for (int c = 0; c < 3; ++c) {
        sum[c] += picture.at(x + dx, y + dy)[c] * w[c] /
                  (w[c] > 0.0 ? positive[c] : negative[c] + 1e-300);
      }
    }
  }
  return sum;
}

double error_at(const Picture& a, const Picture& b, int x, int y, double ppd) {
  const double pi = std::numbers::pi;
  const auto sensitivity = [&](int dx, int dy) {
    const double r2 = (dx * dx + dy * dy) / (ppd * ppd);
    const auto gauss = [&](double k, double w) {
      return k * std::sqrt(pi / w) * std::exp(-pi * pi * r2 / w);
    };
    return dvec3(gauss(1.0, 0.0047), gauss(1.0, 0.0053), gauss(34.1, 0.04) + gauss(13.5, 0.025));
  };
  const int wide = static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * pi * pi)) * ppd));
  const auto seen = [&](const Picture& p) {
    const dvec3 rgb = glm::clamp(from_ycxcz(weighted(p, x, y, wide, sensitivity)), 0.0, 1.0);
    dvec3 lab = to_lab(rgb);
    lab[1] *= 0.01 * lab[0];
    lab[2] *= 0.01 * lab[0];
    return lab;
  };
  const dvec3 la = seen(a), lb = seen(b);
  const double distance = std::abs(la[0] - lb[0]) + std::hypot(la[1] - lb[1], la[2] - lb[2]);
  const double colour = squeezed(distance);

  const double sigma = 0.5 * 0.082 * ppd;
  const int narrow = static_cast<int>(std::ceil(3.0 * sigma));
  const auto features = [&](const Picture& p) {
    const auto g = [&](int dx, int dy) {
      return std::exp(-(dx * dx + dy * dy) / (2.0 * sigma * sigma));
    };
    const auto strength = [&](const auto& weight) {
      const double across = weighted(
          p, x, y, narrow, [&](int dx, int dy) { return dvec3(weight(dx) * g(dx, dy)); })[0];
      const double down = weighted(
          p, x, y, narrow, [&](int dx, int dy) { return dvec3(weight(dy) * g(dx, dy)); })[0];
      return std::hypot(across, down) / 116.0;  // Y of YCxCz over its range
    };
    return std::pair(strength([](int d) { return -static_cast<double>(d); }),
                     strength([&](int d) { return d * d / (sigma * sigma) - 1.0; }));
  };
  const auto [edge_a, point_a] = features(a);
  const auto [edge_b, point_b] = features(b);
  const double feature =
      std::sqrt(std::max(std::abs(edge_a - edge_b), std::abs(point_a - point_b)) / std::sqrt(2.0));
  return std::pow(colour, 1.0 - feature);
}

}  // namespace plain

TEST(Flip, EqualsPlainSumsOverItsKernels) {
  const auto prepared = [](const Image& image) {
    plain::Picture out{image.width, image.height, {}};
    for (const Rgb& c : image.pixels) {
      out.pixels.push_back(plain::to_ycxcz(glm::clamp(dvec3(c), 0.0, 1.0)));
    }
    return out;
  };
  const Image a = busy(5), b = busy(6);
  for (const double pixels_per_degree : {20.0, 67.0}) {
    FlipOptions options;
    options.pixels_per_degree = pixels_per_degree;
    const Flip fast = flip(a, b, options);
    const plain::Picture pa = prepared(a), pb = prepared(b);
    for (int y = 0; y < a.height; y += 2) {
      for (int x = 0; x < a.width; ++x) {
        const double expected = plain::error_at(pa, pb, x, y, pixels_per_degree);
        // Planes of floats leave 1e-7 in the features, whose square root is 3e-4, and that moves
        // c^(1-f) by at most 1/e of it; the matrices above have six digits, the primaries four.
        EXPECT_NEAR(fast.error[static_cast<std::size_t>(y * a.width + x)], expected, 3e-4);
      }
    }
  }
}

}  // namespace
}  // namespace lantern
