// SPDX-License-Identifier: MIT
#include "lantern/trace/brute_force.h"
