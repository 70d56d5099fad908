// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/idl/idl_parser.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "common/file/read_file.hpp"
#include "deploy/inspect/topic/idl/idl_lexer.hpp"

namespace sidestep {
namespace {

using Kind = IdlType::Kind;
using Extensibility = IdlType::Extensibility;

constexpr int kMaxNesting = 100;
constexpr std::size_t kMaxFiles = 1000;
// Limit, because the number of values grows exponentially if each type contains another type several times.
constexpr std::uint64_t kMaxValues = 10'000'000;

/// The annotations of a definition or member.
struct Annotations {
  bool is_key = false, is_optional = false;
  std::optional<Extensibility> extensibility{};
  std::optional<std::int64_t> value{};
};

IdlTypePtr type_of(Kind kind) {
  IdlType type;
  type.kind = kind;
  return std::make_shared<const IdlType>(std::move(type));
}

/// Parses the definitions of one or several files.
class Parser {
 public:
  void parse_file(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, error);
    if (!files_.insert(canonical.string()).second) return;
    if (files_.size() > kMaxFiles) throw IdlError(path.string() + ": too many files");
    IdlTokens tokens = tokens_of_idl(read(path.string()), path.string());
    for (const std::string& include : tokens.includes) parse_file(path.parent_path() / include);
    parse_tokens(std::move(tokens.tokens), path.string());
  }

  static std::string read(const std::string& path) {
    constexpr std::size_t kMaxBytes = 4'000'000;
    try {
      return read_file(path, kMaxBytes);
    } catch (const std::runtime_error& error) {
      throw IdlError(fmt::format("{}: cannot be read: {}", path, error.what()));
    }
  }

  void parse_tokens(std::vector<IdlToken> tokens, const std::string& file_name) {
    tokens_ = std::move(tokens);
    file_name_ = file_name;
    at_ = 0;
    while (!peek().text.empty()) parse_definition();
  }

  IdlTypes take_types() { return std::move(types_); }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw IdlError(fmt::format("{}:{}: {}", file_name_, peek().line, what));
  }
  const IdlToken& peek() const { return tokens_[at_]; }
  bool is_next(std::string_view text) const { return !peek().is_string && peek().text == text; }
  std::string take() {
    const std::string text = peek().text;
    if (text.empty() && !peek().is_string) fail("the text ends in the middle of a definition");
    ++at_;
    return text;
  }
  bool take_if(std::string_view text) {
    if (!is_next(text)) return false;
    ++at_;
    return true;
  }
  void expect(std::string_view text) {
    if (!take_if(text)) fail(fmt::format("expected '{}', got '{}'", text, peek().text));
  }
  std::string take_name() {
    const std::string name = take();
    const bool is_name =
        !name.empty() && (std::isalpha(static_cast<unsigned char>(name[0])) != 0 || name[0] == '_');
    if (!is_name || name.find("::") != std::string::npos) {
      --at_;
      fail(fmt::format("expected a name, got '{}'", name));
    }
    return name[0] == '_' ? name.substr(1) : name;  // an escaped keyword
  }

  std::string full_name(const std::string& name) const {
    std::string result;
    for (const std::string& module : modules_) result += module + "::";
    return result + name;
  }
  /// Looks a name up in the current module, and then in the enclosing ones.
  template <typename Value>
  const Value* find(const std::map<std::string, Value>& values, std::string name) const {
    if (name.starts_with("::")) {
      const auto found = values.find(name.substr(2));
      return found == values.end() ? nullptr : &found->second;
    }
    for (std::size_t depth = modules_.size() + 1; depth-- > 0;) {
      std::string scope;
      for (std::size_t i = 0; i < depth; ++i) scope += modules_[i] + "::";
      const auto found = values.find(scope + name);
      if (found != values.end()) return &found->second;
    }
    return nullptr;
  }

  Annotations parse_annotations() {
    Annotations result;
    while (take_if("@")) {
      const std::string name = take_name();
      std::string argument;
      std::optional<std::int64_t> number;
      if (take_if("(")) {
        const std::size_t begin = at_;
        for (int depth = 1; depth > 0;) {
          const std::string token = take();
          depth += token == "(" ? 1 : token == ")" ? -1 : 0;
        }
        argument = tokens_[begin].text;
        if (name == "value") {
          at_ = begin;
          number = parse_number();
          expect(")");
        }
      }
      if (name == "key") result.is_key = argument != "FALSE";
      if (name == "optional") result.is_optional = argument != "FALSE";
      if (name == "value") result.value = number;
      const std::string extensibility = name == "extensibility" ? argument : name;
      if (extensibility == "final" || extensibility == "FINAL") result.extensibility = Extensibility::kFinal;
      if (extensibility == "appendable" || extensibility == "APPENDABLE")
        result.extensibility = Extensibility::kAppendable;
      if (extensibility == "mutable" || extensibility == "MUTABLE")
        result.extensibility = Extensibility::kMutable;
    }
    return result;
  }

  void parse_definition() {
    if (++nesting_ > kMaxNesting) fail("definitions are nested too deeply");
    const Annotations annotations = parse_annotations();
    if (take_if("module"))
      parse_module();
    else if (take_if("struct"))
      parse_struct(annotations);
    else if (take_if("enum"))
      parse_enum();
    else if (take_if("typedef"))
      parse_typedef();
    else if (take_if("const"))
      parse_constant();
    else if (!is_next(";"))
      fail(fmt::format("expected a module, struct, enum, typedef or const, got '{}'", peek().text));
    take_if(";");
    --nesting_;
  }

  void parse_module() {
    modules_.push_back(take_name());
    expect("{");
    while (!take_if("}")) parse_definition();
    modules_.pop_back();
  }

  void parse_struct(const Annotations& annotations) {
    IdlType type;
    type.kind = Kind::kStruct;
    type.name = full_name(take_name());
    if (is_next(";")) return;  // a forward declaration
    if (take_if(":")) {
      const std::string base_name = take();
      const IdlTypePtr* base = find(types_, base_name);
      if (base == nullptr || (*base)->kind != Kind::kStruct)
        fail(fmt::format("there is no struct '{}'", base_name));
      type.members = (*base)->members;
      type.extensibility = (*base)->extensibility;
    }
    if (annotations.extensibility) type.extensibility = *annotations.extensibility;
    expect("{");
    while (!take_if("}")) {
      const Annotations member = parse_annotations();
      const IdlTypePtr member_type = parse_type();
      do {
        std::string name = take_name();
        type.members.push_back(
            {std::move(name), parse_array(member_type), member.is_key, member.is_optional});
      } while (take_if(","));
      expect(";");
    }
    define(std::move(type));
  }

  void parse_enum() {
    IdlType type;
    type.kind = Kind::kEnum;
    type.name = full_name(take_name());
    expect("{");
    std::int64_t next = 0;
    do {
      if (is_next("}")) break;  // after a trailing comma
      const Annotations annotations = parse_annotations();
      if (annotations.value) next = *annotations.value;
      if (next < 0 || next > 0x7fffffff) fail("an enumerator's value does not fit 31 bits");
      const std::string name = take_name();
      constants_[full_name(name)] = next;
      type.enumerators[static_cast<std::uint32_t>(next++)] = name;
    } while (take_if(","));
    expect("}");
    define(std::move(type));
  }

  void parse_typedef() {
    const IdlTypePtr type = parse_type();
    do {
      const std::string name = full_name(take_name());
      aliases_[name] = parse_array(type);
    } while (take_if(","));
  }

  void parse_constant() {
    const IdlTypePtr type = parse_type();
    const std::string name = full_name(take_name());
    expect("=");
    const bool is_whole = type->kind != Kind::kFloat && type->kind != Kind::kDouble &&
                          type->kind != Kind::kString && type->kind != Kind::kBoolean &&
                          type->kind != Kind::kChar;
    if (is_whole)
      constants_[name] = parse_number();
    else
      while (!is_next(";")) take();
  }

  void define(IdlType type) {
    if (type.kind == Kind::kStruct) type.values = 0;
    for (const IdlMember& member : type.members) {
      type.depth = std::max(type.depth, 1 + member.type->depth);
      type.values += member.type->values;
    }
    check_size(type);
    const std::string name = type.name;
    types_[name] = std::make_shared<const IdlType>(std::move(type));
  }

  void check_size(const IdlType& type) const {
    if (type.depth > kMaxNesting) fail("a type is nested too deeply");
    if (type.values > kMaxValues)
      fail(fmt::format("a message of this type has {} values, more than {}", type.values, kMaxValues));
  }

  /// Refuses elements without values: an empty message could contain any number of them.
  void check_element(const IdlType& element) const {
    if (element.values == 0) fail("the elements of a list contain no values");
  }

  IdlTypePtr array_of(IdlTypePtr element, std::uint32_t size) const {
    check_element(*element);
    IdlType type;
    type.kind = Kind::kArray;
    type.element = std::move(element);
    type.bound = size;
    type.depth = 1 + type.element->depth;
    type.values = size * type.element->values;  // both are below 2^31
    check_size(type);
    return std::make_shared<const IdlType>(std::move(type));
  }

  /// The type of a declarator: an array if dimensions follow.
  IdlTypePtr parse_array(const IdlTypePtr& element) {
    std::vector<std::uint32_t> sizes;
    while (take_if("[")) {
      sizes.push_back(positive(parse_number()));
      if (std::cmp_greater(sizes.size(), kMaxNesting)) fail("an array has too many dimensions");
      expect("]");
    }
    IdlTypePtr type = element;
    for (auto size = sizes.rbegin(); size != sizes.rend(); ++size) type = array_of(type, *size);
    return type;
  }

  std::uint32_t positive(std::int64_t number) const {
    if (number < 1 || number > 0x7fffffff) fail(fmt::format("expected a positive number, got {}", number));
    return static_cast<std::uint32_t>(number);
  }

  /// A sum of products of literals, constants and enumerators.
  std::int64_t parse_number() {
    std::int64_t sum = parse_product();
    for (;;) {
      bool is_overflow = false;
      if (take_if("+"))
        is_overflow = __builtin_add_overflow(sum, parse_product(), &sum);
      else if (take_if("-"))
        is_overflow = __builtin_sub_overflow(sum, parse_product(), &sum);
      else
        return sum;
      if (is_overflow) fail("a number is too large");
    }
  }
  std::int64_t parse_product() {
    std::int64_t product = parse_factor();
    while (take_if("*"))
      if (__builtin_mul_overflow(product, parse_factor(), &product)) fail("a number is too large");
    return product;
  }
  std::int64_t parse_factor() {
    if (++nesting_ > kMaxNesting) fail("an expression is nested too deeply");
    std::int64_t result = 0;
    if (take_if("-")) {
      if (__builtin_sub_overflow(std::int64_t{0}, parse_factor(), &result)) fail("a number is too large");
    } else if (take_if("(")) {
      result = parse_number();
      expect(")");
    } else {
      const std::string text = take();
      const bool is_hexadecimal = text.starts_with("0x") || text.starts_with("0X");
      const char* begin = text.data() + (is_hexadecimal ? 2 : 0);
      const auto [end, error] =
          std::from_chars(begin, text.data() + text.size(), result, is_hexadecimal ? 16 : 10);
      if (error != std::errc() || end != text.data() + text.size()) {
        const std::int64_t* constant = find(constants_, text);
        if (constant == nullptr) {
          --at_;
          fail(fmt::format("expected a whole number or the name of a constant, got '{}'", text));
        }
        result = *constant;
      }
    }
    --nesting_;
    return result;
  }

  IdlTypePtr parse_type() {
    if (++nesting_ > kMaxNesting) fail("a type is nested too deeply");
    IdlTypePtr type = parse_type_inside();
    --nesting_;
    return type;
  }

  IdlTypePtr parse_type_inside() {
    parse_annotations();
    const std::string word = take();
    if (word == "sequence") return parse_sequence();
    if (word == "string") {
      IdlType type;
      type.kind = Kind::kString;
      if (take_if("<")) {
        type.bound = positive(parse_number());
        expect(">");
      }
      return std::make_shared<const IdlType>(std::move(type));
    }
    if (word == "unsigned") {
      if (take_if("short")) return type_of(Kind::kUint16);
      expect("long");
      return type_of(take_if("long") ? Kind::kUint64 : Kind::kUint32);
    }
    if (word == "long") {
      if (take_if("double")) fail("long double is not supported");
      return type_of(take_if("long") ? Kind::kInt64 : Kind::kInt32);
    }
    static const std::map<std::string, Kind> simple = {
        {"boolean", Kind::kBoolean}, {"octet", Kind::kOctet},   {"uint8", Kind::kOctet},
        {"char", Kind::kChar},       {"int8", Kind::kInt8},     {"short", Kind::kInt16},
        {"int16", Kind::kInt16},     {"int32", Kind::kInt32},   {"int64", Kind::kInt64},
        {"uint16", Kind::kUint16},   {"uint32", Kind::kUint32}, {"uint64", Kind::kUint64},
        {"float", Kind::kFloat},     {"double", Kind::kDouble}};
    if (const auto found = simple.find(word); found != simple.end()) return type_of(found->second);
    if (const IdlTypePtr* type = find(types_, word)) return *type;
    if (const IdlTypePtr* alias = find(aliases_, word)) return *alias;
    --at_;
    fail(fmt::format("there is no type '{}', or it is not supported", word));
  }

  IdlTypePtr parse_sequence() {
    IdlType type;
    type.kind = Kind::kSequence;
    expect("<");
    type.element = parse_type();
    check_element(*type.element);
    if (take_if(",")) type.bound = positive(parse_number());
    expect(">");
    type.depth = 1 + type.element->depth;
    check_size(type);
    return std::make_shared<const IdlType>(std::move(type));
  }

  std::vector<IdlToken> tokens_{{"", 1}};
  std::string file_name_;
  std::size_t at_ = 0;
  int nesting_ = 0;
  std::vector<std::string> modules_;
  IdlTypes types_;
  std::map<std::string, IdlTypePtr> aliases_;
  std::map<std::string, std::int64_t> constants_;
  std::set<std::string> files_;
};

}  // namespace

IdlTypes parse_idl(std::string_view text, const std::string& file_name) {
  Parser parser;
  parser.parse_tokens(tokens_of_idl(text, file_name).tokens, file_name);
  return parser.take_types();
}

IdlTypes load_idl(const std::string& path) {
  Parser parser;
  parser.parse_file(path);
  return parser.take_types();
}

}  // namespace sidestep
