#pragma once
// The viewport's camera: fly, orbit, pan, dolly, frame. Knows nothing of windows: the viewport pane feeds it.

#include "core/math.h"

namespace tyndall::editor {

class CameraController {
public:
    /// Starts from a camera of the scene (scale is dropped). `sceneSize` in metres sets speed and the distance of the pivot.
    void reset(const dmat4& worldFromCamera, double sceneSize);
    [[nodiscard]] dmat4 worldFromCamera() const;
    [[nodiscard]] const dvec3& position() const { return position_; }
    [[nodiscard]] const dquat& rotation() const { return rotation_; }
    /// The point that orbiting turns about and dollying approaches.
    [[nodiscard]] dvec3 pivot() const { return position_ + pivotDistance_ * forward(); }
    [[nodiscard]] double pivotDistance() const { return pivotDistance_; }
    [[nodiscard]] dvec3 forward() const { return rotation_ * dvec3(0, 0, -1); }
    /// Metres per second of flying.
    [[nodiscard]] double speed() const { return speed_; }

    /// Turns in place: pixels to the right and down. The horizon stays level and the zenith is not crossed.
    void look(const dvec2& pixels);
    /// Moves along the camera's right, up and forward axes, each -1 to 1.
    void fly(const dvec3& axes, double seconds);
    /// Each notch of the wheel is a factor of 1.2.
    void changeSpeed(double notches);
    /// Turns about the pivot, which keeps its place in the picture.
    void orbit(const dvec2& pixels);
    /// Moves parallel to the picture, so that the scene follows the cursor. `metresPerPixel`: at the pivot.
    void pan(const dvec2& pixels, double metresPerPixel);
    /// Nearer to the pivot (positive) or away: a tenth of the distance a notch.
    void dolly(double notches);
    /// Moves back or forth until `bounds` fit into the picture, in whose middle they then are. `yfov` in radians; nothing
    /// happens for empty bounds.
    void frame(const Bounds& bounds, double yfov, double aspect);

private:
    void turn(const dvec2& pixels);

    dvec3 position_{0};
    dquat rotation_{1, 0, 0, 0};
    double pivotDistance_ = 5, speed_ = 1;
};

} // namespace tyndall::editor
