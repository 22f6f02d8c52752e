// SPDX-License-Identifier: MIT
// stb_image, kept from what it does not do itself: it takes the end of a file for zeros, believes
// claimed sizes, and hands out memory it never wrote to.
#include "lantern/core/error.h"
#include "lantern/image/codec.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <unordered_map>

namespace lantern::codec {
namespace {

/// Memory of one decoding, freed with it, so that an exception may leave stb_image. All of it is
/// zero at first, so that no file can show what was there before.
class Arena {
 public:
  explicit Arena(std::size_t limit) : left_(limit) { current_ = this; }
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;
  ~Arena() { current_ = nullptr; }

  static Arena& current() { return *current_; }

  /// Null, as malloc, when the limit is reached.
  void* allocate(std::size_t size) {
    if (size > left_) return nullptr;
    Block block(std::calloc(std::max<std::size_t>(size, 1), 1));
    if (!block) return nullptr;
    void* pointer = block.get();
    blocks_.emplace(pointer, std::pair(std::move(block), size));
    left_ -= size;
    return pointer;
  }

  void* reallocate(void* old, std::size_t old_size, std::size_t size) {
    void* pointer = allocate(size);
    if (pointer && old) {
      std::memcpy(pointer, old, std::min(old_size, size));
      release(old);
    }
    return pointer;
  }

  void release(void* pointer) {
    const auto found = blocks_.find(pointer);
    if (found == blocks_.end()) return;
    left_ += found->second.second;
    blocks_.erase(found);
  }

 private:
  struct Free {
    void operator()(void* p) const { std::free(p); }
  };
  using Block = std::unique_ptr<void, Free>;

  static thread_local Arena* current_;
  std::unordered_map<void*, std::pair<Block, std::size_t>> blocks_;
  std::size_t left_;
};

thread_local Arena* Arena::current_ = nullptr;

struct Broken {
  const char* reason;
};

}  // namespace
}  // namespace lantern::codec

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_ZLIB
#define STBI_ONLY_TGA
#define STBI_ONLY_BMP
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#define STBI_ASSERT(condition)                     \
  if (!(condition)) throw lantern::codec::Broken { \
      "inconsistent"                               \
    }
#define STBI_MALLOC(size) lantern::codec::Arena::current().allocate(size)
#define STBI_REALLOC_SIZED(old, old_size, size) \
  lantern::codec::Arena::current().reallocate(old, old_size, size)
#define STBI_FREE(pointer) lantern::codec::Arena::current().release(pointer)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace lantern::codec {
namespace {

/// Feeds stb_image and throws where it would read past the end.
struct Input {
  View rest;
  const void* buffer;  // stb_image's own: only there may a read fall short

  static int read(void* user, char* to, int size) {
    auto& input = *static_cast<Input*>(user);
    const auto wanted = static_cast<std::size_t>(size);
    const std::size_t n = std::min(wanted, input.rest.size());
    if (n == 0 || (n < wanted && to != input.buffer)) throw Broken{"the file ends too early"};
    std::memcpy(to, input.rest.data(), n);
    input.rest = input.rest.subspan(n);
    return static_cast<int>(n);
  }
  static void skip(void* user, int size) {
    auto& input = *static_cast<Input*>(user);
    input.rest = input.rest.subspan(std::min(static_cast<std::size_t>(size), input.rest.size()));
  }
  static int at_end(void* user) { return static_cast<Input*>(user)->rest.empty(); }
};

constexpr stbi_io_callbacks kCallbacks{Input::read, Input::skip, Input::at_end};

struct Source {
  explicit Source(View bytes) : input{bytes, context.buffer_start} {
    stbi__start_callbacks(&context, const_cast<stbi_io_callbacks*>(&kCallbacks), &input);
  }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  stbi__context context{};
  Input input;
};

struct Kind {
  const char* name;
  std::uint64_t pixels_a_byte;  // no file of the kind can hold more
};

/// TGA has no magic number: what is nothing else may be one.
Kind kind_of(View bytes) {
  if (starts_with(bytes, "BM")) return {"BMP", 8};  // one bit a pixel
  if (starts_with(bytes, "#?RADIANCE\n") || starts_with(bytes, "#?RGBE\n")) {
    return {"HDR", 16};  // runs of 127 in 4 channels of 2 bytes
  }
  return {"TGA", 64};  // runs of 128 in 2 bytes
}

[[noreturn]] void fail_kind(const Kind& kind, const char* reason, const std::string& name) {
  if (std::strcmp(kind.name, "TGA") == 0) {
    fail({name}, "is no picture that can be read: EXR, HDR, PFM, PNG, JPEG, TGA or BMP");
  }
  fail({name}, "broken {}: {}", kind.name, reason);
}

/// The product of the header's EXPOSURE lines: pixels are radiance times it.
float hdr_exposure(View bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  text = text.substr(0, text.find("\n\n"));
  constexpr std::string_view kKey = "\nEXPOSURE=";
  float product = 1.0f;
  for (auto at = text.find(kKey); at != text.npos; at = text.find(kKey, at + 1)) {
    std::string_view number = text.substr(at + kKey.size());
    number.remove_prefix(std::min(number.find_first_not_of(' '), number.size()));
    float value = 1.0f;
    std::from_chars(number.data(), number.data() + number.size(), value);
    if (std::isnormal(value) && value > 0.0f) product *= value;
  }
  return product;
}

void read_size(View bytes, const Kind& kind, int& width, int& height, const std::string& name) {
  Source source(bytes);
  int channels = 0;
  if (!stbi__info_main(&source.context, &width, &height, &channels)) {
    fail_kind(kind, stbi_failure_reason(), name);
  }
  // A BMP whose rows run downwards has a negative height; -2^31 has no opposite.
  if (height < 0 && height > std::numeric_limits<int>::min()) height = -height;
  check_size(width, height, name);
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (pixels > bytes.size() * kind.pixels_a_byte) {
    fail({name}, "a {} of {} bytes cannot hold a picture of {}x{}", kind.name, bytes.size(), width,
         height);
  }
}

/// What stb_image needs at most while it works: 16 bytes a pixel of an HDR, and its mantissas.
std::size_t working_memory(int width, int height) {
  constexpr std::size_t kBytesPerPixel = 20;
  constexpr std::size_t kSlack = std::size_t{1} << 20;  // palettes, rows
  return kSlack +
         kBytesPerPixel * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

}  // namespace

Raster decode_stb(View bytes, const std::string& name) {
  const Kind kind = kind_of(bytes);
  try {
    Raster raster;
    {
      Arena header_arena(working_memory(0, 0));
      read_size(bytes, kind, raster.width, raster.height, name);
    }
    Arena arena(working_memory(raster.width, raster.height));
    Source source(bytes);
    const std::size_t values =
        4 * static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height);
    int width = 0;
    int height = 0;
    int channels = 0;
    const auto check_decoded = [&](const void* pixels) {
      if (!pixels) fail_kind(kind, stbi_failure_reason(), name);
      if (width != raster.width || height != raster.height) throw Broken{"it has two sizes"};
    };
    if (std::strcmp(kind.name, "HDR") == 0) {
      const float* from =
          stbi__loadf_main(&source.context, &width, &height, &channels, STBI_rgb_alpha);
      check_decoded(from);
      raster.linear.assign(from, from + values);
      const float exposure = hdr_exposure(bytes);
      for (std::size_t i = 0; i < values; ++i) {
        if (i % 4 != 3) raster.linear[i] /= exposure;
      }
    } else {
      const stbi_uc* from = stbi__load_and_postprocess_8bit(&source.context, &width, &height,
                                                            &channels, STBI_rgb_alpha);
      check_decoded(from);
      raster.srgb8.assign(from, from + values);
    }
    return raster;
  } catch (const Broken& broken) {
    fail_kind(kind, broken.reason, name);
  }
}

}  // namespace lantern::codec
