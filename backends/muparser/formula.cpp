#include "backends/muparser/formula.hpp"

#include <muParser.h>

#include <memory>
#include <mutex>
#include <string>

#include "kernel/core/error.hpp"

namespace traceraft::muparser {
namespace {

// muParser's "=" gives a variable another value. Comparisons are "==", "<=", ">=" and "!=".
void refuse_assignment(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool pair = i + 1 < text.size() && text[i + 1] == '=';
    if (pair && std::string("=<>!").find(text[i]) != std::string::npos)
      ++i;
    else if (text[i] == '=')
      throw mu::Parser::exception_type("'=' assigns; write == to compare");
  }
}

class Formula {
 public:
  explicit Formula(const std::string& text) {
    refuse_assignment(text);
    parser_.DefineVar("x", &x_[0]);
    parser_.DefineVar("y", &x_[1]);
    parser_.DefineVar("z", &x_[2]);
    parser_.DefineConst("pi", 3.14159265358979323846);
    parser_.DefineConst("e", 2.71828182845904523536);
    parser_.SetExpr(text);
    parser_.Eval();  // compiles, so that errors show up here
    if (parser_.GetNumResults() != 1)
      throw mu::Parser::exception_type("it is a list; write decimal points, not commas");
  }
  double operator()(const Point& x) {
    // muParser evaluates with the variables it is bound to.
    const std::lock_guard<std::mutex> lock(mutex_);
    for (int axis = 0; axis < 3; ++axis) x_[axis] = x[axis];
    return parser_.Eval();
  }

 private:
  mu::Parser parser_;
  double x_[3] = {0.1, 0.2, 0.3};
  std::mutex mutex_;
};

}  // namespace

std::function<double(const Point&)> parse_formula(const std::string& context,
                                                  const std::string& formula) {
  try {
    auto parsed = std::make_shared<Formula>(formula);
    return [parsed](const Point& x) { return (*parsed)(x); };
  } catch (const mu::Parser::exception_type& error) {
    std::string why = error.GetCode() == mu::ecINTERNAL_ERROR ? "it is incomplete" : error.GetMsg();
    while (!why.empty() && (why.back() == '\n' || why.back() == '.')) why.pop_back();
    throw InputError(context + ": cannot read '" + formula.substr(0, 80) + "': " + why +
                     " (variables: x, y, z)");
  }
}

}  // namespace traceraft::muparser
