#include "app/frame_recorder.h"

#include "core/cpu_profiler.h"
#include "core/image_metrics.h"
#include "gl/object.h"

namespace tyndall {

Result<void> FrameRecorder::renderNext() {
    FrameRequest request = session_.request();
    request.frameIndex = uint32_t(count());
    request.converge = frames_.converge;
    request.separateTerms = frames_.separateTerms;
    request.statistics = frames_.statistics;
    if (!frames_.converge) request.time += double(count()) * frames_.timeStep;
    CaptureReport::Frame frame;
    frame.startMicroseconds = processMicroseconds();
    Result<FrameResult> result = session_.renderer().renderFrame(request);
    if (!result.ok()) return result.error();
    gl::Fence::insert().wait();
    frame.durationMicroseconds = processMicroseconds() - frame.startMicroseconds;
    if (report_.frames.empty()) report_.startupMs = processMicroseconds() / 1000;
    report_.frames.push_back(frame);
    result_ = std::move(*result);
    return {};
}

Image FrameRecorder::beauty() {
    Image image = session_.renderer().readBeauty();
    countInvalid(image);
    return image;
}

std::vector<TermImage> FrameRecorder::terms() {
    std::vector<TermImage> terms = session_.renderer().readTerms();
    for (const TermImage& term : terms) countInvalid(term.image);
    return terms;
}

void FrameRecorder::countInvalid(const Image& image) {
    const ValueCounts counts = countValues(image);
    report_.nonFinite += counts.nonFinite;
    report_.negative += counts.negative;
}

CaptureReport FrameRecorder::report() {
    CaptureReport report = report_;
    const gl::Capabilities& capabilities = session_.context().capabilities();
    report.scene = session_.options().scene;
    report.width = session_.request().width;
    report.height = session_.request().height;
    report.backend = session_.context().backendName();
    report.glVendor = capabilities.vendor;
    report.glRenderer = capabilities.renderer;
    report.glVersion = capabilities.version;
    report.setPlan(result_.plan);
    session_.renderer().waitForTimings();
    report.setPasses(session_.renderer().report());
    report.setStatistics(session_.renderer().readStatistics());
    report.glErrors = session_.context().debugLog().count(gl::Severity::High);
    report.peakResidentBytes = peakResidentBytes();
    if (frames_.converge) {
        report.iterations["converge"] = result_.accumulatedFrames;
        report.residuals["converge"] = result_.estimatedError;
    }
    return report;
}

} // namespace tyndall
