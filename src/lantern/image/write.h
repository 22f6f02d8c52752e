// SPDX-License-Identifier: MIT
// Pictures into files, whole or not at all. The extension decides the format. Errors: Error with
// the path.
#pragma once

#include "lantern/image/image.h"
#include "lantern/image/tone.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace lantern {

enum class ExrDepth { kHalf, kFloat };

struct WriteOptions {
  ExrDepth exr_depth = ExrDepth::kHalf;
  Tone tone;          // PNG only: HDR formats keep radiance as it is
  Metadata metadata;  // EXR attributes, PNG text chunks, HDR comments
};

/// Throws Error unless `path` ends in .exr, .png, .hdr or .pfm.
void require_image_format(const std::filesystem::path& path);

void write_image(const std::filesystem::path& path, const Image& image,
                 const WriteOptions& options = {});

}  // namespace lantern
