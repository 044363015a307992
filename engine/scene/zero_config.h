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

/// What a camera inside of an interior sees of it.
struct Interior {
    dvec3 middle;
    double reach;      // metres from the middle to what is around it, the mean
    double open;       // part of all directions from the middle in which nothing is
    double seenByLamp; // lux that a lamp in the middle brings to what the camera sees, over those that it brings to what faces it at `reach`
};

/// A perspective camera at the height of an eye that looks along the longest way free, where the scene is an interior: closed around
/// the middle of its bounds by surfaces that show their fronts. Nothing where it is not, or where there is an active camera.
std::optional<Interior> supplyCameraInside(LoadedScene& loaded);

/// A perspective camera that sees the largest cluster of things (scene_reach.h) from the front, a little from the right and from above;
/// nothing where there is an active camera.
void supplyCamera(LoadedScene& loaded);

/// A sun and a dim sky, and in an interior a lamp, where the scene has no light, no emission and no environment. Is there a lamp?
bool supplyLight(LoadedScene& loaded, const std::optional<Interior>& interior = {});

/// EV100 for the light that arrives at the middle of the scene, unshadowed; or, in an interior with a supplied lamp, for that on what the camera sees
/// (incident metering, calibration constant 250 lx s).
void supplyExposure(LoadedScene& loaded, const std::optional<Interior>& interior = {});

/// A node with the grid of a .vdb or .nvdb file, its own transform kept, as a medium of albedo 0.99 and
/// an optical depth of about 4 across the largest extent.
/// `grid` is the density grid's name; "": as importGrid() finds it.
Result<void> supplyMedium(LoadedScene& loaded, const std::filesystem::path& file,
                          const std::string& grid);

} // namespace tyndall
