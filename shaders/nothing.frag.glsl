// SPDX-License-Identifier: MIT
// For what is drawn into depth or stencil alone.
void main() {}
