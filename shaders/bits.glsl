// SPDX-License-Identifier: MIT
// Bits of masks.

/// Of positive numbers.
int exponent_of(float number) { return int(floatBitsToUint(number) >> 23) - 127; }

/// The lowest ones, up to 32.
uint lowest_bits(int count) { return count < 32 ? ~(0xffffffffu << uint(count)) : 0xffffffffu; }
uint lowest(uint bits) { return bits & (~bits + 1u); }
/// The number of a bit; 0 of none.
int number_of(uint bit) { return max(exponent_of(float(bit)), 0); }

/// A mask of 32 bits from RGBA8, the lowest byte in red, and the other way.
uint mask_of(vec4 bytes) {
  uvec2 words = uvec2(bytes.rb * 255.0 + bytes.ga * 65280.0 + 0.5);
  return words.x | (words.y << 16);
}
vec4 bytes_of(uint mask) {
  return vec4(uvec4(mask, mask >> 8, mask >> 16, mask >> 24) & 255u) / 255.0;
}
