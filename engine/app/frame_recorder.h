#pragma once
// Frames of a session, one after another, with what a report says of them: a render and its report from code.

#include <vector>

#include "app/capture_report.h"
#include "app/render_session.h"
#include "core/image.h"

namespace tyndall {

struct RecordedFrames {
    bool converge = false;      // average frames of the still scene, whose clock then stands
    bool separateTerms = false; // for terms()
    bool statistics = false;    // numbers of techniques in the report
    double timeStep = 1.0 / 60; // seconds of the scene's clock from frame to frame
};

/// The session outlives it, and nobody else renders with it meanwhile.
class FrameRecorder {
public:
    FrameRecorder(RenderSession& session, const RecordedFrames& frames)
        : session_(session), frames_(frames) {}

    /// Renders the next frame and waits for the GPU. Errors: as Renderer::renderFrame.
    Result<void> renderNext();
    [[nodiscard]] size_t count() const { return report_.frames.size(); }
    /// Of the last frame.
    [[nodiscard]] const FrameResult& result() const { return result_; }

    // Read-backs of the last frame, linear. Their invalid values are counted in the report.
    [[nodiscard]] Image beauty();
    /// Only where separate terms were asked for.
    [[nodiscard]] std::vector<TermImage> terms();

    /// Of all frames so far; passes and statistics are those of the last. Waits for the GPU's times.
    [[nodiscard]] CaptureReport report();

private:
    void countInvalid(const Image& image);

    RenderSession& session_;
    RecordedFrames frames_;
    FrameResult result_;
    CaptureReport report_;
};

} // namespace tyndall
