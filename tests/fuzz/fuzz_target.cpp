// One fuzzer for each target (fuzz_NAME): libFuzzer's entry, and a mutation that knows what numbers and names look
// like.
#include <cctype>
#include <random>

#include "fuzz/targets.h"

#ifndef FUZZ_TARGET
#error "FUZZ_TARGET names the target"
#endif

extern "C" {

std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  topple::fuzz::FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
  return 0;
}

/// Half of the time a whole token of a text becomes another one; else any bytes change.
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  static constexpr std::array tokens{
      "0",   "-0",  "-1",   "1",    "1e100", "-1e100", "1e-100", "1e308", "5e-324", "2147483648", "9223372036854775808",
      "0.5", "nan", "null", "true", "\"\"",  "[]",     "{}",     "\"A\"", "1e6",    "1e-6",       "1000000"};
  std::minstd_rand random(seed);
  const auto in_token = [&](std::size_t i) { return std::isalnum(data[i]) != 0 || data[i] == '.' || data[i] == '-'; };
  if (size == 0 || random() % 2 == 0) return LLVMFuzzerMutate(data, size, most);
  std::size_t begin = random() % size;
  while (begin < size && !in_token(begin)) ++begin;
  if (begin == size) return LLVMFuzzerMutate(data, size, most);
  std::size_t end = begin;
  while (begin > 0 && in_token(begin - 1)) --begin;
  while (end < size && in_token(end)) ++end;
  const std::string_view token = tokens[random() % tokens.size()];
  const std::size_t changed = size - (end - begin) + token.size();
  if (changed > most) return LLVMFuzzerMutate(data, size, most);
  std::memmove(data + begin + token.size(), data + end, size - end);
  std::memcpy(data + begin, token.data(), token.size());
  return changed;
}

}  // extern "C"
