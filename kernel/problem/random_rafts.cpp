#include "kernel/problem/initial_data.hpp"

namespace traceraft::problem {

discs::StartingDiscs random_discs(const InitialRequest& request, const Parameters& parameters) {
  return discs::random_discs({static_cast<int>(parameters["number"]), parameters["spread"],
                              request.raft_fraction, request.well, request.epsilon, request.seed});
}

InitialEntry disc_rafts() {
  return {"discs",
          "round rafts at random places, with equilibrium profiles",
          {{"number", "", 40, 1, 10000, "of rafts", ParameterKind::integer},
           {"spread", "", 0.3, 0, 2, "standard deviation of the logarithm of their areas"}},
          {},
          [](const InitialRequest& request, const Parameters& parameters) {
            const discs::StartingDiscs start = random_discs(request, parameters);
            std::vector<CapRaft> caps;
            for (const discs::Disc& disc : start.discs)
              caps.push_back({disc.centre, discs::half_angle(disc.area)});
            return [around = start.background,
                    profile = profile_around(caps, request.well, request.epsilon)](const Point& x) {
              return around + (1 - around) * profile(x);
            };
          }};
}

}  // namespace traceraft::problem
