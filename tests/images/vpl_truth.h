#pragma once
// Virtual point lights against the path tracer, which renders its pictures here and now.

#include <string>
#include <vector>

#include "scene/scene.h"
#include "transport/terms.h"

namespace tyndall::test {

struct Case {
    const char* name;
    std::string nodes; // each followed by a comma
    double relmse;     // beside the reference's own noise
    double energy;
    TermSet terms = kIndirectInMedia;
    std::vector<std::string> settings = {"gi.vpl.walks=1024"};
};

/// An eye that looks at the origin from the front, and what else there is.
Scene sceneOf(const Case& about);

/// Relmse and energy of the average of 24 small frames, by `about.settings`, against the path tracer.
struct Against {
    double relmse = 0, energy = 0;
    double noise = 0; // relmse that a perfect picture has
};
Against againstTruth(const Scene& scene, const Case& about);

/// Expects `about.relmse` and `about.energy`.
void expectTheTruth(const Scene& scene, const Case& about);
inline void expectTheTruth(const Case& about) { expectTheTruth(sceneOf(about), about); }

/// Nodes of a room without a front and without a lamp.
extern const std::string kDarkRoom;

} // namespace tyndall::test
