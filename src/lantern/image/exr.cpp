// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/image/codec.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVersion.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

namespace lantern::codec {
namespace {

constexpr std::size_t kPreamble = 8;  // magic number and version

class MemoryInput : public Imf::IStream {
 public:
  MemoryInput(View bytes, const std::string& name) : IStream(name.c_str()), bytes_(bytes) {}

  bool read(char to[], int count) override {
    const auto n = static_cast<std::uint64_t>(count);
    if (count < 0 || position_ > bytes_.size() || n > bytes_.size() - position_) {
      throw Error({fileName(), {}, {}, bytes_.size()}, "the EXR ends before its picture does");
    }
    std::memcpy(to, bytes_.data() + position_, n);
    position_ += n;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  View bytes_;
  std::uint64_t position_ = 0;
};

class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput(Bytes& bytes, const std::string& name) : OStream(name.c_str()), bytes_(bytes) {}

  void write(const char from[], int count) override {
    const auto n = static_cast<std::size_t>(count);
    if (bytes_.size() < position_ + n) bytes_.resize(position_ + n);
    std::memcpy(bytes_.data() + position_, from, n);
    position_ += n;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

 private:
  Bytes& bytes_;
  std::uint64_t position_ = 0;
};

/// OpenEXR reports with many kinds of exceptions; all become an Error with the file's name.
template <typename Work>
auto with_place(const std::string& name, const Work& work) {
  try {
    return work();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    throw Error({name}, e.what());
  }
}

std::uint32_t little_endian(View bytes, std::size_t at) {
  std::uint32_t value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// A text of the header; leaves `at` behind the zero that ends it.
std::string take_text(View bytes, std::size_t& at, const std::string& name) {
  const View rest = bytes.subspan(at);
  const auto end = std::find(rest.begin(), rest.end(), std::byte{0});
  if (end == rest.end()) fail({name}, "the header of the EXR is incomplete");
  const auto length = static_cast<std::size_t>(end - rest.begin());
  at += length + 1;
  return {reinterpret_cast<const char*>(rest.data()), length};
}

/// OpenEXR makes room for as much as an attribute claims, wherever it believes that one starts; so
/// read them here first and see that each is just as long as it says. An attribute is a name, a
/// type, a size of 4 bytes and its value; an empty name ends the header.
Imf::Header read_header(View bytes, const std::string& name) {
  if (bytes.size() < kPreamble) fail({name}, "the header of the EXR is incomplete");
  const int version = static_cast<int>(little_endian(bytes, 4));
  if (Imf::isMultiPart(version)) fail({name}, "an EXR of several parts cannot be read");
  if (Imf::isNonImage(version)) fail({name}, "a deep EXR cannot be read");

  Imf::Header header;
  std::size_t at = kPreamble;
  for (auto key = take_text(bytes, at, name); !key.empty(); key = take_text(bytes, at, name)) {
    const std::string type = take_text(bytes, at, name);
    if (bytes.size() - at < 4) fail({name}, "the header of the EXR is incomplete");
    const std::uint32_t size = little_endian(bytes, at);
    at += 4;
    if (size > bytes.size() - at) {
      fail({name, {}, {}, at}, "an EXR attribute of {} bytes does not fit into the file", size);
    }
    if (Imf::Attribute::knownType(type.c_str())) {
      const std::unique_ptr<Imf::Attribute> value(Imf::Attribute::newAttribute(type.c_str()));
      MemoryInput input(bytes.subspan(at, size), name);
      value->readValueFrom(input, static_cast<int>(size), version);
      if (input.tellg() != size) {
        fail({name, {}, {}, at}, "an EXR attribute of type {} has {} bytes", type, size);
      }
      header.insert(key, *value);
    }
    at += size;
  }
  header.sanityCheck(Imf::isTiled(version));
  if (Imf::isTiled(version) != header.hasTileDescription()) {
    fail({name}, "the EXR does not know whether it is tiled");
  }
  return header;
}

struct Extent {
  std::uint64_t width;
  std::uint64_t height;
};

/// The piece of the picture that is coded at once.
Extent chunk(const Imf::Header& header, const Extent& picture) {
  if (header.hasTileDescription()) {
    return {header.tileDescription().xSize, header.tileDescription().ySize};
  }
  switch (header.compression()) {
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
      return {picture.width, 16};
    case Imf::PIZ_COMPRESSION:
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
    case Imf::DWAA_COMPRESSION:
      return {picture.width, 32};
    case Imf::DWAB_COMPRESSION:
      return {picture.width, 256};
    default:
      return {picture.width, 1};
  }
}

/// Throws unless the file can hold what its header claims, whole chunks counted as OpenEXR
/// makes room for them.
void check_proportion(const Imf::Header& header, const Extent& picture, View bytes,
                      const std::string& name) {
  // Deflate, the strongest of the lossless ones, ends at 1032:1, and PXR24 drops a quarter before.
  // DWA codes runs of zeros before deflating; 2^14 is above what a black picture reaches.
  constexpr std::uint64_t kLossless = 2048;
  constexpr std::uint64_t kDwa = 16384;
  constexpr std::uint64_t kHarmless = std::uint64_t{4} << 20;  // bytes not worth refusing
  constexpr std::uint64_t kLargestTileSide = 1 << 15;

  std::uint64_t pixel_bytes = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    pixel_bytes += c.channel().type == Imf::HALF ? 2 : 4;
  }
  const Extent piece = chunk(header, picture);
  if (header.hasTileDescription() && std::max(piece.width, piece.height) > kLargestTileSide) {
    fail({name}, "an EXR tile of {}x{} is too large", piece.width, piece.height);
  }
  const bool dwa = header.compression() == Imf::DWAA_COMPRESSION ||
                   header.compression() == Imf::DWAB_COMPRESSION;
  const auto round_up = [](std::uint64_t n, std::uint64_t step) {
    return (n + step - 1) / step * step;
  };
  const std::uint64_t claimed =
      round_up(picture.width, piece.width) * round_up(picture.height, piece.height) * pixel_bytes;
  if (claimed > kHarmless + bytes.size() * (dwa ? kDwa : kLossless)) {
    fail({name}, "an EXR of {} bytes cannot hold a picture of {}x{}", bytes.size(), picture.width,
         picture.height);
  }
}

void require_colour(const Imf::ChannelList& channels, const std::string& name) {
  if (channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B")) return;
  if (channels.findChannel("RY") || channels.findChannel("BY")) {
    fail({name}, "an EXR of luminance and chroma cannot be read");
  }
  if (!channels.findChannel("Y")) fail({name}, "the EXR has neither channels R, G, B nor Y");
}

}  // namespace

bool is_exr(View bytes) { return starts_with(bytes, "\x76\x2f\x31\x01"); }

Raster decode_exr(View bytes, const std::string& name) {
  return with_place(name, [&] {
    const Imf::Header header = read_header(bytes, name);
    const Imath::Box2i window = header.dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    check_size(width, height, name);
    check_proportion(header,
                     {static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height)}, bytes,
                     name);
    require_colour(header.channels(), name);

    MemoryInput input(bytes, name);
    Imf::InputFile file(input);
    if (!file.isComplete()) fail({name}, "the EXR is incomplete");

    const auto w = static_cast<std::size_t>(width);
    const auto h = static_cast<std::size_t>(height);
    Raster raster{
        static_cast<int>(width), static_cast<int>(height), {}, std::vector<float>(w * h * 4, 1.0f)};
    const bool grey = !header.channels().findChannel("R");
    const std::string_view channels = grey ? "Y" : "RGBA";
    constexpr std::size_t kTexelBytes = 4 * sizeof(float);
    constexpr double kOpaque = 1.0;
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      frame.insert(std::string(1, channels[c]),
                   Imf::Slice::Make(Imf::FLOAT, raster.linear.data() + c, window, kTexelBytes,
                                    kTexelBytes * w, 1, 1, kOpaque));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    if (grey) {
      for (std::size_t i = 0; i < raster.linear.size(); i += 4) {
        raster.linear[i + 1] = raster.linear[i + 2] = raster.linear[i];
      }
    }
    return raster;
  });
}

Metadata exr_metadata(View bytes, const std::string& name) {
  return with_place(name, [&] {
    const Imf::Header header = read_header(bytes, name);
    Metadata metadata;
    for (auto a = header.begin(); a != header.end(); ++a) {
      const std::string_view key = a.name();
      const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute());
      if (text && key.starts_with(kKeyPrefix)) {
        metadata.emplace(key.substr(kKeyPrefix.size()), text->value());
      }
    }
    return metadata;
  });
}

Bytes encode_exr(const Image& image, const WriteOptions& options, const std::string& name) {
  return with_place(name, [&] {
    const bool half = options.exr_depth == ExrDepth::kHalf;
    const Imf::PixelType type = half ? Imf::HALF : Imf::FLOAT;
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const char* channel : {"R", "G", "B"}) header.channels().insert(channel, {type});
    for (const auto& [key, value] : options.metadata) {
      header.insert(std::string(kKeyPrefix) + key, Imf::StringAttribute(value));
    }

    Bytes bytes;
    {
      MemoryOutput output(bytes, name);
      Imf::OutputFile file(output, header);
      const auto width = static_cast<std::size_t>(image.width);
      // One row, written over and over: a stride of 0 between rows.
      std::vector<Imath::half> half_row(half ? 3 * width : 0);
      std::vector<Rgb> float_row(half ? 0 : width);
      const std::size_t value_bytes = half ? sizeof(Imath::half) : sizeof(float);
      char* base = half ? reinterpret_cast<char*>(half_row.data())
                        : reinterpret_cast<char*>(float_row.data());
      Imf::FrameBuffer frame;
      frame.insert("R", Imf::Slice(type, base, 3 * value_bytes, 0));
      frame.insert("G", Imf::Slice(type, base + value_bytes, 3 * value_bytes, 0));
      frame.insert("B", Imf::Slice(type, base + 2 * value_bytes, 3 * value_bytes, 0));
      file.setFrameBuffer(frame);
      for (int y = 0; y < image.height; ++y) {
        const Rgb* row = &image.at(0, y);
        if (half) {
          constexpr float kLargestHalf = 65504.0f;
          for (std::size_t i = 0; i < half_row.size(); ++i) {
            const float value = row[i / 3][static_cast<int>(i % 3)];
            half_row[i] = std::clamp(value, -kLargestHalf, kLargestHalf);
          }
        } else {
          std::copy_n(row, width, float_row.begin());
        }
        file.writePixels(1);
      }
    }  // the file puts its table of chunks in place when it closes
    return bytes;
  });
}

}  // namespace lantern::codec
