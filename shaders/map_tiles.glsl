// SPDX-License-Identifier: MIT
// Pixels a side of a tile, whose points maps are asked for at once, and tiles a side of a group of
// them that asks before.
const int kTile = 4, kTilesInGroup = 4;
