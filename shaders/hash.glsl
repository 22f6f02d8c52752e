// SPDX-License-Identifier: MIT
// Random numbers without a state.

/// Every input bit changes every output bit with a probability of about one half.
uint hash(uint x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}
