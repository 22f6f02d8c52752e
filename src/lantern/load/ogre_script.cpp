// SPDX-License-Identifier: MIT
#include "lantern/load/ogre_script.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace lantern::ogre {
namespace {

constexpr int kDeepest = 32;

enum class Kind { kWord, kVariable, kOpen, kClose, kColon, kNewLine, kEnd };

struct Token {
  Kind kind;
  int line;
  std::string text;
};

class Lexer {
 public:
  Lexer(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  Token next() {
    skip_blanks_and_comments();
    if (at_ >= text_.size()) return {Kind::kEnd, line_, {}};
    const char c = text_[at_];
    if (c == '\n') {
      ++at_;
      return {Kind::kNewLine, line_++, {}};
    }
    if (c == '"') return quoted();
    if (c == '{' || c == '}' || c == ':') {
      ++at_;
      return {c == '{' ? Kind::kOpen : (c == '}' ? Kind::kClose : Kind::kColon), line_, {}};
    }
    const std::size_t begin = at_;
    at_ = std::min(text_.find_first_of(" \t\r\n{}:", begin), text_.size());
    const bool variable = c == '$' && at_ - begin > 1;
    return {variable ? Kind::kVariable : Kind::kWord, line_,
            std::string(text_.substr(begin, at_ - begin))};
  }

 private:
  void skip_blanks_and_comments() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == ' ' || c == '\t' || c == '\r') {
        ++at_;
      } else if (text_.compare(at_, 2, "//") == 0) {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (text_.compare(at_, 2, "/*") == 0) {
        const std::size_t end = text_.find("*/", at_ + 2);
        if (end == std::string_view::npos) fail({file_, line_}, "the comment is not closed");
        for (; at_ < end + 2; ++at_) line_ += text_[at_] == '\n';
      } else {
        return;
      }
    }
  }

  Token quoted() {
    Token token{Kind::kWord, line_, {}};
    for (++at_; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '"') {
        ++at_;
        return token;
      }
      if (c == '\\' && at_ + 1 < text_.size() && text_[at_ + 1] == '"') ++at_;
      line_ += c == '\n';
      token.text += text_[at_];
    }
    fail({file_, token.line}, "the quotation mark is not closed");
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

class Parser {
 public:
  Parser(std::string_view text, const std::string& file)
      : file_(file), lexer_(text, file), token_(lexer_.next()) {}

  std::vector<Statement> all() {
    std::vector<Statement> result = statements(0);
    if (token_.kind == Kind::kClose) fail({file_, token_.line}, "'}}' closes nothing");
    return result;
  }

 private:
  void advance() { token_ = lexer_.next(); }

  std::vector<Statement> statements(int depth) {
    std::vector<Statement> result;
    while (true) {
      while (token_.kind == Kind::kNewLine) advance();
      if (token_.kind == Kind::kClose || token_.kind == Kind::kEnd) return result;
      Statement next = statement(depth);
      if (!next.words.empty()) result.push_back(std::move(next));
    }
  }

  Statement statement(int depth) {
    Statement result;
    result.line = token_.line;
    bool inherits = false;
    for (;; advance()) {
      if (token_.kind == Kind::kColon) {
        inherits = true;
      } else if (token_.kind == Kind::kWord || token_.kind == Kind::kVariable) {
        if (inherits) {
          add_parents(token_.text, result.parents);
        } else {
          result.words.push_back({token_.text, token_.kind == Kind::kVariable});
        }
      } else {
        break;
      }
    }
    while (token_.kind == Kind::kNewLine) advance();
    if (token_.kind != Kind::kOpen) return result;

    const int opened = token_.line;
    if (result.words.empty()) fail({file_, opened}, "the block has no name");
    if (depth == kDeepest) fail({file_, opened}, "blocks nest deeper than {}", kDeepest);
    advance();
    result.is_block = true;
    result.children = statements(depth + 1);
    if (token_.kind != Kind::kClose) fail({file_, opened}, "'{{' is not closed");
    advance();
    return result;
  }

  static void add_parents(std::string_view list, std::vector<std::string>& parents) {
    while (!list.empty()) {
      const std::size_t end = std::min(list.find(','), list.size());
      if (end > 0) parents.emplace_back(list.substr(0, end));
      list.remove_prefix(std::min(end + 1, list.size()));
    }
  }

  const std::string& file_;
  Lexer lexer_;
  Token token_;
};

}  // namespace

std::vector<Statement> parse_script(std::string_view text, const std::string& file) {
  return Parser(text, file).all();
}

}  // namespace lantern::ogre
