// SPDX-License-Identifier: MIT
// Whole files in and out. Reading refuses what is no regular file; writing goes through a temporary
// file beside the target and a rename, so that a file appears whole or not at all. Errors: Error
// with the path.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lantern {

/// The bytes of a regular file. Files above 4 GiB are refused.
std::vector<std::byte> read_file(const std::filesystem::path& path);

/// The same as text.
std::string read_text(const std::filesystem::path& path);

void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file(const std::filesystem::path& path, std::string_view text);

/// Throws unless a file could be written at `path`: to refuse before a long render, not after it.
void require_writable(const std::filesystem::path& path);

/// Lower-case extension with its dot (".exr"), "" if there is none.
std::string extension(const std::filesystem::path& path);

}  // namespace lantern
