// SPDX-License-Identifier: MIT
// Programs that draw the same frames, each in a process of its own, so that each one's processor
// time is its own and their frames can take turns. Errors: Error if a process ends early.
#pragma once

#include "lantern/image/image.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <sys/types.h>

namespace lantern {

/// Draws a scene with one of several sets of lights.
class Painter {
 public:
  virtual ~Painter() = default;
  /// Returns how many they are.
  virtual std::size_t take_lights(std::uint32_t set) = 0;
  /// With the lights taken last; waits for the end of the frame.
  virtual void draw() = 0;
  virtual Image picture() = 0;
};

class Contender {
 public:
  /// Forks: nothing may run on another thread yet. `make` is called in the new process.
  Contender(std::string name, const std::function<std::unique_ptr<Painter>()>& make);
  ~Contender();
  Contender(const Contender&) = delete;
  Contender& operator=(const Contender&) = delete;

  const std::string& name() const { return name_; }

  struct Frame {
    double processor_seconds = 0.0;  // of all threads of its process
    std::uint64_t lights = 0;
  };

  /// One frame. What is drawn to warm up when the lights change does not count.
  Frame draw(std::uint32_t light_set);

  /// Of these lights.
  Image picture(std::uint32_t light_set);

 private:
  enum class Wish : std::uint32_t { kFrame, kPicture, kEnd };
  struct Question {
    Wish wish;
    std::uint32_t light_set;
  };
  static void serve(Painter& painter, int from, int to);
  void ask(const Question& question);
  void receive(void* data, std::size_t bytes);

  std::string name_;
  pid_t process_ = -1;
  int to_ = -1, from_ = -1;
};

}  // namespace lantern
