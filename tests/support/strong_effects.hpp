// Every effect, strong enough to be seen beside the base model, in units of R and R²/D.
#pragma once

#include <string>
#include <vector>

namespace traceraft::testing {

inline const std::vector<std::string> kStrong = {"allen-cahn:rate=0.7",
                                                 "asymmetry:strength=0.1",
                                                 "bulk-mobility:strength=0.4",
                                                 "cooling:rate=3,out=0.2,in=0.1,activation=0.3",
                                                 "curvature:strength=0.8",
                                                 "exchange:rate=0.9,target=0.3",
                                                 "flow:capillary=300,water=0.8",
                                                 "flow:thermal=0.5,water=0.8",
                                                 "gravity:strength=0.6",
                                                 "line-tension:excess=0.7",
                                                 "mobility-contrast:strength=0.8",
                                                 "mobility-exponent:excess=0.6",
                                                 "ohta-kawasaki:strength=2,range=0.7",
                                                 "rotation:rate=1.3,x=1,y=-1,z=0.5",
                                                 "thermal:strength=0.01,time=0.1,seed=3",
                                                 "uptake:rate=0.6"};

}  // namespace traceraft::testing
