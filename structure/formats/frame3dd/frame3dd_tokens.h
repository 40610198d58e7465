#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace topple::structure {

/// The numbers of a Frame3DD file in order, each with its line, read one by one with what they should be.
class Frame3ddTokens {
 public:
  /// The first line is the title; after it '#' and '%' start a comment, and white space, commas, semicolons and quotes
  /// separate numbers (Frame3DD writes and reads its spreadsheets' CSV in this way).
  Frame3ddTokens(std::string_view text, std::string file);

  [[nodiscard]] const std::string& title() const { return title_; }
  [[nodiscard]] bool at_end() const { return next_ == tokens_.size(); }

  /// The next number, finite. `what` names it in messages ("x of node 3").
  double number(const std::string& what);
  double number_from(const std::string& what, double least);
  double number_above(const std::string& what, double bound);
  /// The next number as a whole one within [least, most].
  int whole(const std::string& what, int least, int most);
  /// The next number as a count of things of which each takes `numbers_each` more numbers: one that the rest of the
  /// file cannot hold is refused before anything is made for it.
  int count(const std::string& what, int least, int numbers_each);
  bool flag(const std::string& what);

  /// Throws InputError at the token read last.
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  struct Token {
    std::string_view text;
    int line = 0;
  };
  const Token& next_token(const std::string& what);

  std::string file_, title_;
  std::vector<Token> tokens_;
  std::size_t next_ = 0;
  int last_line_ = 1;
};

}  // namespace topple::structure
