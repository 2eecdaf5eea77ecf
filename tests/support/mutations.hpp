// Texts that differ from valid ones by a few accidents, or by malice.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "kernel/core/random.hpp"

namespace traceraft::testing {

class Mutations {
 public:
  // `samples`: valid texts; `tokens`: what is put among them.
  Mutations(std::vector<std::string> samples, std::vector<std::string> tokens)
      : samples_(std::move(samples)), tokens_(std::move(tokens)) {}

  std::string text(std::uint64_t number) const {
    Dice dice{number};
    std::string result = dice.of(samples_);
    for (std::size_t k = 1 + dice.below(6); k > 0; --k) mutate(dice, result);
    return result;
  }

 private:
  struct Dice {
    std::uint64_t number, count = 0;
    std::size_t below(std::size_t n) {
      return static_cast<std::size_t>(uniform_random(17, number, count++) * static_cast<double>(n));
    }
    const std::string& of(const std::vector<std::string>& list) { return list[below(list.size())]; }
  };

  void mutate(Dice& dice, std::string& text) const {
    const std::size_t at = dice.below(text.size() + 1);
    const std::size_t length = std::min(dice.below(20), text.size() - at);
    switch (dice.below(8)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << dice.below(8)));
        break;
      case 1:
        text.insert(at, 1, static_cast<char>(dice.below(256)));
        break;
      case 2:
        text.erase(at, length);
        break;
      case 3:
        text.insert(at, text.substr(at, length));
        break;
      case 4:
        text.resize(at);
        break;
      case 5: {
        const std::string& other = dice.of(samples_);
        text = text.substr(0, at) + other.substr(dice.below(other.size() + 1));
        break;
      }
      case 6:  // a token in place of one
        text.replace(at, length, dice.of(tokens_));
        break;
      default:
        text.insert(at, dice.of(tokens_));
    }
  }

  std::vector<std::string> samples_, tokens_;
};

}  // namespace traceraft::testing
