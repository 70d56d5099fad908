// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/message_schema.hpp"

#include <cctype>
#include <map>
#include <set>
#include <stdexcept>
#include <vector>

namespace sidestep {
namespace {

bool is_of_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Splits the text into names, numbers and single other characters.
std::vector<std::string_view> tokens_of(std::string_view text) {
  std::vector<std::string_view> tokens;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i + 1;
    if (is_of_name(text[i]))
      while (end < text.size() && is_of_name(text[end])) ++end;
    if (std::isspace(static_cast<unsigned char>(text[i])) == 0) tokens.push_back(text.substr(i, end - i));
    i = end;
  }
  return tokens;
}

struct Definition {
  std::string module;  // for example sidestep::msg
  std::string_view text;
  std::vector<std::string_view> tokens;
};

/// The name that a definition defines: the last name before its braces, its value or its end.
std::string_view defined_name(const std::vector<std::string_view>& tokens) {
  std::string_view name;
  for (const std::string_view token : tokens) {
    if (token == "{" || token == "=" || token == ":" || token == ";") break;
    if (is_of_name(token.front())) name = token;
  }
  return name;
}

std::string joined(const std::vector<std::string>& modules) {
  std::string result;
  for (const std::string& module : modules) result += (result.empty() ? "" : "::") + module;
  return result;
}

class Definitions {
 public:
  explicit Definitions(std::string_view idl) {
    std::vector<std::string> modules;
    while (skip_space(idl), !idl.empty()) {
      if (idl.starts_with("module ")) {
        const std::size_t brace = idl.find('{');
        if (brace == std::string_view::npos) throw std::invalid_argument("IDL: a module without braces");
        modules.emplace_back(tokens_of(idl.substr(0, brace)).at(1));
        idl.remove_prefix(brace + 1);
      } else if (idl.front() == '}') {
        if (modules.empty()) throw std::invalid_argument("IDL: a brace that was not opened");
        modules.pop_back();
        idl.remove_prefix(1);
        skip_space(idl);
        if (idl.starts_with(";")) idl.remove_prefix(1);
      } else {
        const std::string_view text = idl.substr(0, size_of_definition(idl));
        idl.remove_prefix(text.size());
        Definition definition{joined(modules), text, tokens_of(text)};
        const std::string name(defined_name(definition.tokens));
        definitions_.try_emplace(name, std::move(definition));
      }
    }
  }

  const Definition* find(const std::string& name) const {
    const auto found = definitions_.find(name);
    return found == definitions_.end() ? nullptr : &found->second;
  }

  /// Appends the definitions that a definition uses, and then the definition itself.
  void append(const std::string& name, std::set<std::string>& done, std::string& text) const {
    const Definition* definition = find(name);
    if (definition == nullptr || !done.insert(name).second) return;
    for (const std::string_view token : definition->tokens) append(std::string(token), done, text);
    std::string end;
    for (const std::string_view token : tokens_of(definition->module)) {
      if (token == ":") continue;
      text += "module " + std::string(token) + " { ";
      end += "}; ";
    }
    text += '\n';
    text += definition->text;
    text += '\n' + end + '\n';
  }

 private:
  static void skip_space(std::string_view& text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0)
      text.remove_prefix(1);
  }
  /// The length of a definition: up to the first semicolon outside all braces.
  static std::size_t size_of_definition(std::string_view text) {
    int depth = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '{') ++depth;
      if (text[i] == '}') --depth;
      if (text[i] == ';' && depth == 0) return i + 1;
    }
    throw std::invalid_argument("IDL: a definition without end");
  }

  std::map<std::string, Definition> definitions_;  // keyed by name; our names are unique across modules
};

}  // namespace

std::string message_schema(std::string_view type, std::string_view idl) {
  const Definitions definitions(idl);
  const std::size_t colon = type.rfind("::");
  const std::string name(colon == std::string_view::npos ? type : type.substr(colon + 2));
  const Definition* root = definitions.find(name);
  if (root == nullptr || (colon == std::string_view::npos ? "" : type.substr(0, colon)) != root->module)
    throw std::invalid_argument("IDL: there is no type " + std::string(type));
  std::string text;
  std::set<std::string> done;
  definitions.append(name, done, text);
  return text;
}

}  // namespace sidestep
