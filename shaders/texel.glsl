// SPDX-License-Identifier: MIT
// A texel by its column and row, of a texture without mip levels that looks up the nearest one. For
// texelFetch() Mesa finds size and place of a level for each pixel anew, which takes longer than the
// texel itself. Beyond the texture is its edge.

/// The same for all texels of a texture: loops find it before they begin, as Mesa does not.
vec2 texel_size(sampler2D image) { return 1.0 / vec2(textureSize(image, 0)); }
vec2 texel_size(usampler2D image) { return 1.0 / vec2(textureSize(image, 0)); }

vec4 texel_of(sampler2D image, vec2 size, ivec2 at) {
  return textureLod(image, (vec2(at) + 0.5) * size, 0.0);
}

uvec4 texel_of(usampler2D image, vec2 size, ivec2 at) {
  return textureLod(image, (vec2(at) + 0.5) * size, 0.0);
}

vec4 texel_of(sampler2D image, ivec2 at) { return texel_of(image, texel_size(image), at); }
uvec4 texel_of(usampler2D image, ivec2 at) { return texel_of(image, texel_size(image), at); }
