// SPDX-License-Identifier: MIT
#include "lantern/load/load.h"

#include <algorithm>
#include <utility>

namespace lantern {

void LoadReport::warn(std::string text) {
  if (std::find(warnings.begin(), warnings.end(), text) == warnings.end()) {
    warnings.push_back(std::move(text));
  }
}

}  // namespace lantern
