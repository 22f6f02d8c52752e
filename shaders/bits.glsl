// SPDX-License-Identifier: MIT
// Bits of masks.

/// Of positive numbers.
int exponent_of(float number) { return int(floatBitsToUint(number) >> 23) - 127; }

/// The lowest ones, up to 32.
uint lowest_bits(int count) { return count < 32 ? ~(0xffffffffu << uint(count)) : 0xffffffffu; }
uint lowest(uint bits) { return bits & (~bits + 1u); }
/// The number of a bit; 0 of none.
int number_of(uint bit) { return max(exponent_of(float(bit)), 0); }
