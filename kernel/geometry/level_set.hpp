// Surfaces are zero level sets: Γ = {x : φ(x) = 0}, φ < 0 inside. Coordinates are in units of the
// surface scale R (the radius, for a sphere).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kernel/core/named_list.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/types.hpp"

namespace traceraft::geometry {

// Surfaces lie in the box [−5/3, 5/3]³, as in the reference results.
inline constexpr double kBoxHalfWidth = 5.0 / 3.0;

// Contract: continuously differentiable with ∇φ ≠ 0 near Γ, finite in the whole box, thread-safe.
// φ need not be a distance: the discretisation uses its zero set and its normalised gradient.
class LevelSet {
 public:
  virtual ~LevelSet() = default;
  virtual double value(const Point& x) const = 0;
};

using LevelSetPtr = std::shared_ptr<const LevelSet>;

// φ given as a function, e.g. a formula parsed elsewhere.
class FunctionLevelSet final : public LevelSet {
 public:
  explicit FunctionLevelSet(std::function<double(const Point&)> phi) : phi_(std::move(phi)) {}
  double value(const Point& x) const override { return phi_(x); }

 private:
  std::function<double(const Point&)> phi_;
};

// φ(x − offset): the same surface moved against the mesh. Used to test that results do not depend
// on how the mesh cuts the surface.
class ShiftedLevelSet final : public LevelSet {
 public:
  ShiftedLevelSet(LevelSetPtr base, const Point& offset)
      : base_(std::move(base)), offset_(offset) {}
  double value(const Point& x) const override { return base_->value(x - offset_); }

 private:
  LevelSetPtr base_;
  Point offset_;
};

struct SurfaceEntry {
  std::string name;
  std::string summary;
  std::vector<ParameterSpec> parameters;
  std::function<LevelSetPtr(const Parameters&)> make;
};

// The built-in surfaces; adding one is one file and one line in surfaces.cpp.
const NamedList<SurfaceEntry>& surfaces();

// "torus:major=0.9,minor=0.4" -> the level set. Throws InputError.
LevelSetPtr make_surface(const std::string& specification);

}  // namespace traceraft::geometry
