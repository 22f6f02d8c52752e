// SPDX-License-Identifier: MIT
#include "apps/lantern/terminal.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <unistd.h>

namespace lantern::app {
namespace {

StopFlag stop_flag{false};

extern "C" void on_interrupt(int signal) {
  stop_flag.store(true);
  std::signal(signal, SIG_DFL);
}

std::string time_text(double seconds) {
  if (!std::isfinite(seconds)) return "?";
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  return fmt::format("{}:{:02} min", whole / 60, whole % 60);
}

}  // namespace

void warn(const std::string& text) { fmt::print(stderr, "warning: {}\n", text); }

void note(const std::string& text) {
  const bool over_bar = ::isatty(STDERR_FILENO) != 0;
  fmt::print(stderr, "{}{}\n", over_bar ? "\r\033[K" : "", text);
}

ProgressBar::ProgressBar(bool quiet)
    : quiet_(quiet),
      terminal_(::isatty(STDERR_FILENO) != 0),
      last_(std::chrono::steady_clock::now()) {}

ProgressBar::~ProgressBar() {
  if (drawn_ && terminal_) fmt::print(stderr, "\r\033[K");
}

void ProgressBar::show(const Progress& progress) {
  if (quiet_) return;
  const auto now = std::chrono::steady_clock::now();
  const auto interval =
      terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(5000);
  if (now - last_ < interval) return;
  last_ = now;
  drawn_ = true;
  const std::string status =
      fmt::format("{:3.0f} %  {} {}  {} left", 100.0 * progress.share, progress.pass,
                  progress.passes_done + 1, time_text(progress.seconds_left));
  if (!terminal_) {
    fmt::print(stderr, "{}\n", status);
    return;
  }
  constexpr int kWidth = 30;
  const int filled = std::clamp(static_cast<int>(progress.share * kWidth), 0, kWidth);
  fmt::print(stderr, "\r\033[K[{:=<{}}{:<{}}] {}", "", filled, "", kWidth - filled, status);
  std::fflush(stderr);
}

const StopFlag& stop_on_interrupt() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  return stop_flag;
}

void finish_in_peace() {
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_IGN);
}

}  // namespace lantern::app
