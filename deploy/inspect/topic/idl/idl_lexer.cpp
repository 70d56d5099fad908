// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/idl/idl_lexer.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <utility>

#include "deploy/inspect/topic/idl/idl_parser.hpp"

namespace sidestep {
namespace {

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

class Lexer {
 public:
  Lexer(std::string_view text, const std::string& file_name) : text_(text), file_name_(file_name) {}

  IdlTokens run() {
    for (;;) {
      skip_space_and_comments();
      if (at_ >= text_.size()) break;
      if (text_[at_] == '#')
        read_directive();
      else
        read_token();
    }
    result_.tokens.push_back({"", line_});
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw IdlError(fmt::format("{}:{}: {}", file_name_, line_, what));
  }
  bool has(std::string_view begin) const { return text_.substr(at_).starts_with(begin); }
  void skip_to(std::size_t end) {
    for (; at_ < end; ++at_)
      if (text_[at_] == '\n') ++line_;
  }

  void skip_space_and_comments() {
    while (at_ < text_.size()) {
      if (std::isspace(static_cast<unsigned char>(text_[at_])) != 0) {
        skip_to(at_ + 1);
      } else if (has("//")) {
        skip_to(std::min(text_.find('\n', at_), text_.size()));
      } else if (has("/*")) {
        const std::size_t end = text_.find("*/", at_ + 2);
        if (end == std::string_view::npos) fail("a comment is not closed");
        skip_to(end + 2);
      } else {
        return;
      }
    }
  }

  void read_directive() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string_view line = text_.substr(at_, end - at_);
    const std::size_t word = line.find_first_not_of(" \t", 1);
    const std::size_t quote = line.find('"');
    if (word != std::string_view::npos && line.substr(word).starts_with("include") &&
        quote != std::string_view::npos) {
      const std::size_t close = line.find('"', quote + 1);
      if (close == std::string_view::npos) fail("an #include has no closing quote");
      result_.includes.emplace_back(line.substr(quote + 1, close - quote - 1));
    }
    skip_to(end);
  }

  void read_token() {
    const char first = text_[at_];
    std::size_t end = at_ + 1;
    if (first == '"') {
      end = text_.find('"', at_ + 1);
      if (end == std::string_view::npos) fail("a string is not closed");
      result_.tokens.push_back({std::string(text_.substr(at_ + 1, end - at_ - 1)), line_, true});
      skip_to(end + 1);
      return;
    }
    if (is_letter(first) || (first == ':' && has("::"))) {
      end = at_;
      while (end < text_.size()) {
        if (is_letter(text_[end]) || is_digit(text_[end]))
          ++end;
        else if (text_.substr(end).starts_with("::") && end + 2 < text_.size() && is_letter(text_[end + 2]))
          end += 2;
        else
          break;
      }
      if (end == at_) fail("expected a name after '::'");
    } else if (is_digit(first)) {
      while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]) || text_[end] == '.'))
        ++end;
    }
    result_.tokens.push_back({std::string(text_.substr(at_, end - at_)), line_});
    at_ = end;
  }

  std::string_view text_;
  const std::string& file_name_;
  std::size_t at_ = 0;
  int line_ = 1;
  IdlTokens result_;
};

}  // namespace

IdlTokens tokens_of_idl(std::string_view text, const std::string& file_name) {
  return Lexer(text, file_name).run();
}

}  // namespace sidestep
