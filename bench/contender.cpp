// SPDX-License-Identifier: MIT
#include "bench/contender.h"

#include "lantern/core/error.h"
#include "lantern/pipeline/stopwatch.h"

#include <array>
#include <cstdio>
#include <exception>
#include <optional>
#include <sys/wait.h>
#include <unistd.h>

namespace lantern {
namespace {

/// Whether all came before the other side closed the pipe.
bool read_all(int file, void* data, std::size_t bytes) {
  auto* at = static_cast<std::byte*>(data);
  while (bytes > 0) {
    const ssize_t got = ::read(file, at, bytes);
    if (got <= 0) return false;
    at += got;
    bytes -= static_cast<std::size_t>(got);
  }
  return true;
}

bool write_all(int file, const void* data, std::size_t bytes) {
  const auto* at = static_cast<const std::byte*>(data);
  while (bytes > 0) {
    const ssize_t put = ::write(file, at, bytes);
    if (put <= 0) return false;
    at += put;
    bytes -= static_cast<std::size_t>(put);
  }
  return true;
}

}  // namespace

Contender::Contender(std::string name, const std::function<std::unique_ptr<Painter>()>& make)
    : name_(std::move(name)) {
  std::array<int, 2> questions, answers;
  if (::pipe(questions.data()) != 0 || ::pipe(answers.data()) != 0) throw Error("no pipe");
  process_ = ::fork();
  if (process_ < 0) throw Error("no further process");
  if (process_ == 0) {
    ::close(questions[1]);
    ::close(answers[0]);
    int status = 0;
    try {
      serve(*make(), questions[0], answers[1]);
    } catch (const std::exception& error) {
      fmt::print(stderr, "{}: {}\n", name_, error.what());
      status = 1;
    }
    std::fflush(nullptr);
    ::_exit(status);
  }
  ::close(questions[0]);
  ::close(answers[1]);
  to_ = questions[1];
  from_ = answers[0];
}

Contender::~Contender() {
  const Question end{Wish::kEnd, 0};
  write_all(to_, &end, sizeof(end));
  ::close(to_);
  ::close(from_);
  ::waitpid(process_, nullptr, 0);
}

void Contender::serve(Painter& painter, int from, int to) {
  std::optional<std::uint32_t> taken;
  Frame frame;
  Question question{};
  while (read_all(from, &question, sizeof(question)) && question.wish != Wish::kEnd) {
    if (taken != question.light_set) {
      taken = question.light_set;
      frame.lights = painter.take_lights(*taken);
      constexpr int kWarmUp = 2;
      for (int i = 0; i < kWarmUp; ++i) painter.draw();
    }
    if (question.wish == Wish::kPicture) {
      const Image image = painter.picture();
      const std::array<int, 2> size = {image.width, image.height};
      write_all(to, size.data(), sizeof(size));
      write_all(to, image.pixels.data(), image.pixels.size() * sizeof(Rgb));
      continue;
    }
    const double start = processor_seconds();
    painter.draw();
    frame.processor_seconds = processor_seconds() - start;
    write_all(to, &frame, sizeof(frame));
  }
}

void Contender::ask(const Question& question) {
  if (!write_all(to_, &question, sizeof(question))) throw Error(name_ + ": ended early");
}

void Contender::receive(void* data, std::size_t bytes) {
  if (!read_all(from_, data, bytes)) throw Error(name_ + ": ended early");
}

Contender::Frame Contender::draw(std::uint32_t light_set) {
  ask({Wish::kFrame, light_set});
  Frame frame;
  receive(&frame, sizeof(frame));
  return frame;
}

Image Contender::picture(std::uint32_t light_set) {
  ask({Wish::kPicture, light_set});
  std::array<int, 2> size;
  receive(size.data(), sizeof(size));
  Image image(size[0], size[1]);
  receive(image.pixels.data(), image.pixels.size() * sizeof(Rgb));
  return image;
}

}  // namespace lantern
