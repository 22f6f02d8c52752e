// SPDX-License-Identifier: MIT
const int kTile = 4;  // pixels a side of a tile, whose points maps are asked for at once
