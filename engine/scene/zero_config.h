#pragma once
// What a bare file needs to make a picture: a camera that frames it, a light, an exposure, and for a volume a medium. Each
// function adds to LoadedScene::supplied what it added to the scene.

#include <filesystem>
#include <optional>

#include "core/result.h"
#include "scene/scene_file.h"

namespace tyndall {

/// The rotation that turns -Z to `forward` (unit), with +Y as far up as it goes.
dquat rotationLookingAlong(const dvec3& forward);

struct SuppliedLamp {
    dvec3 position;
    double reach; // metres, to what it lights
};

/// A perspective camera at the height of an eye that looks along the longest way free, where the scene is an interior: closed around
/// the middle of its bounds by surfaces that show their fronts. Nothing where it is not, or where there is an active camera.
/// Returns where a lamp would light the interior.
std::optional<SuppliedLamp> supplyCameraInside(LoadedScene& loaded);

/// A perspective camera that sees the largest cluster of things (scene_reach.h) from the front, a little from the right and from above;
/// nothing where there is an active camera.
void supplyCamera(LoadedScene& loaded);

/// A sun and a dim sky, and the lamp where there is one, where the scene has no light, no emission and no environment.
void supplyLight(LoadedScene& loaded, const std::optional<SuppliedLamp>& lamp = {});

/// EV100 for the light that arrives at the middle of the scene (incident metering, calibration constant 250 lx s).
void supplyExposure(LoadedScene& loaded);

/// A node with the grid of a .vdb or .nvdb file, its own transform kept, as a medium of albedo 0.99 and
/// an optical depth of about 4 across the largest extent.
/// `grid` is the density grid's name; "": as importGrid() finds it.
Result<void> supplyMedium(LoadedScene& loaded, const std::filesystem::path& file,
                          const std::string& grid);

} // namespace tyndall
