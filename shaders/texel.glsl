// SPDX-License-Identifier: MIT
// A texel by its column and row, of a texture without mip levels that looks up the nearest one. For
// texelFetch() Mesa finds size and place of a level for each pixel anew, which takes longer than the
// texel itself.
vec4 texel_of(sampler2D image, ivec2 at) {
  return textureLod(image, (vec2(at) + 0.5) / vec2(textureSize(image, 0)), 0.0);
}

uvec4 texel_of(usampler2D image, ivec2 at) {
  return textureLod(image, (vec2(at) + 0.5) / vec2(textureSize(image, 0)), 0.0);
}
