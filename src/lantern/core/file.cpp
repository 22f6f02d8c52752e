// SPDX-License-Identifier: MIT
#include "lantern/core/file.h"

#include "lantern/core/error.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <memory>
#include <unistd.h>

namespace lantern {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{4} << 30;

struct CloseFile {
  void operator()(std::FILE* f) const { std::fclose(f); }
};
using FilePtr = std::unique_ptr<std::FILE, CloseFile>;

std::string reason() { return std::strerror(errno); }

template <typename Container>
Container read_into(const std::filesystem::path& path) {
  const Place place{path.string()};
  std::error_code code;
  const auto status = std::filesystem::status(path, code);
  if (status.type() == std::filesystem::file_type::not_found) fail(place, "no such file");
  if (code) fail(place, "cannot be read: {}", code.message());
  if (status.type() != std::filesystem::file_type::regular) fail(place, "is not a file");
  const std::uintmax_t size = std::filesystem::file_size(path, code);
  if (code) fail(place, "cannot be read: {}", code.message());
  if (size > kLargestFile) fail(place, "has {} bytes; the limit is {}", size, kLargestFile);

  const FilePtr file(std::fopen(path.c_str(), "rb"));
  if (!file) fail(place, "cannot be opened: {}", reason());
  Container bytes;
  bytes.resize(static_cast<std::size_t>(size));
  const std::size_t got = std::fread(bytes.data(), 1, bytes.size(), file.get());
  if (got != bytes.size()) fail(place, "only {} of {} bytes could be read", got, bytes.size());
  return bytes;
}

/// A temporary file in the target's folder that removes itself unless renamed.
class Pending {
 public:
  explicit Pending(const std::filesystem::path& target) : target_(behind_links(target)) {
    if (std::filesystem::is_directory(target_)) fail({target.string()}, "is a folder");
    // The mode that any new file has: the user's mask decides who may read.
    constexpr mode_t kAsTheMaskAllows = 0666;
    for (int attempt = 0; descriptor_ < 0; ++attempt) {
      name_ = fmt::format("{}.part-{}-{}", target_.string(), ::getpid(), attempt);
      descriptor_ =
          ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kAsTheMaskAllows);
      constexpr int kAttempts = 100;
      if (descriptor_ < 0 && (errno != EEXIST || attempt == kAttempts)) {
        name_.clear();
        fail({target.string()}, "cannot be written: {}", reason());
      }
    }
  }
  Pending(const Pending&) = delete;
  Pending& operator=(const Pending&) = delete;
  ~Pending() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!name_.empty()) ::unlink(name_.c_str());
  }

  void write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) fail({target_.string()}, "cannot be written: {}", reason());
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
  }

  void commit() {
    const int closed = ::close(descriptor_);
    descriptor_ = -1;
    if (closed != 0 || std::rename(name_.c_str(), target_.c_str()) != 0) {
      fail({target_.string()}, "cannot be written: {}", reason());
    }
    name_.clear();
  }

 private:
  /// A link stays one: what it points to is written.
  static std::filesystem::path behind_links(const std::filesystem::path& path) {
    std::error_code code;
    const auto resolved = std::filesystem::weakly_canonical(path, code);
    return std::filesystem::is_symlink(path, code) && !resolved.empty() ? resolved : path;
  }

  std::filesystem::path target_;
  std::string name_;
  int descriptor_ = -1;
};

/// Devices, pipes and the like can be written but not renamed onto.
bool is_special(const std::filesystem::path& path) {
  std::error_code code;
  const auto type = std::filesystem::status(path, code).type();
  return type == std::filesystem::file_type::character ||
         type == std::filesystem::file_type::fifo || type == std::filesystem::file_type::block;
}

}  // namespace

std::vector<std::byte> read_file(const std::filesystem::path& path) {
  return read_into<std::vector<std::byte>>(path);
}

std::string read_text(const std::filesystem::path& path) { return read_into<std::string>(path); }

void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  if (is_special(path)) {
    FilePtr file(std::fopen(path.c_str(), "wb"));
    const bool written =
        file && std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
    if (!written || std::fclose(file.release()) != 0) {
      fail({path.string()}, "cannot be written: {}", reason());
    }
    return;
  }
  Pending pending(path);
  pending.write(bytes);
  pending.commit();
}

void write_file(const std::filesystem::path& path, std::string_view text) {
  write_file(path, std::as_bytes(std::span(text)));
}

void require_writable(const std::filesystem::path& path) {
  if (!is_special(path)) Pending{path};
}

std::string extension(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace lantern
