// SPDX-License-Identifier: MIT
// Bilinear look-ups as lantern/scene/texture.h has them: texel centres at (i + 0.5) / width, sRGB
// decoded before the filter. Hardware filters round their weights.
#include "shaders/texel.glsl"

const int kRepeat = 0;
const int kClamp = 1;
const int kMirror = 2;

int wrapped(int i, int size, int mode) {
  if (mode == kClamp) return clamp(i, 0, size - 1);
  int period = mode == kMirror ? 2 * size : size;
  int m = i - period * int(floor(float(i) / float(period)));
  return m < size ? m : period - 1 - m;
}

float texel_position(float coordinate, int size, int mode) {
  if (isnan(coordinate) || isinf(coordinate)) return -0.5;
  float inside = mode == kClamp ? clamp(coordinate, 0.0, 1.0)
                                : coordinate - 2.0 * trunc(0.5 * coordinate);
  return inside * float(size) - 0.5;
}

/// IEC 61966-2-1.
vec3 srgb_to_linear(vec3 c) {
  return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, vec3(lessThanEqual(c, vec3(0.04045))));
}

vec4 texel(sampler2D image, ivec2 at, bool is_srgb) {
  vec4 t = texel_of(image, at);
  return is_srgb ? vec4(srgb_to_linear(t.rgb), t.a) : t;
}

vec4 sample_texture(sampler2D image, vec2 uv, ivec2 wrap, bool is_srgb) {
  ivec2 size = textureSize(image, 0);
  vec2 p = vec2(texel_position(uv.x, size.x, wrap.x), texel_position(uv.y, size.y, wrap.y));
  ivec2 low = ivec2(floor(p));
  int x0 = wrapped(low.x, size.x, wrap.x), x1 = wrapped(low.x + 1, size.x, wrap.x);
  int y0 = wrapped(low.y, size.y, wrap.y), y1 = wrapped(low.y + 1, size.y, wrap.y);
  vec2 f = p - floor(p);
  return mix(mix(texel(image, ivec2(x0, y0), is_srgb), texel(image, ivec2(x1, y0), is_srgb), f.x),
             mix(texel(image, ivec2(x0, y1), is_srgb), texel(image, ivec2(x1, y1), is_srgb), f.x),
             f.y);
}
