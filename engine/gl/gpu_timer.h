#pragma once
// How long commands take on the GPU: two timestamps around each, read some frames later.

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "gl/object.h"

namespace tyndall::gl {

/// The times of one frame.
struct FrameTimes {
    struct Span {
        std::string name;
        double milliseconds = 0; // from the end of the commands before to the end of its own
    };
    uint64_t frame = 0;
    std::vector<Span> spans; // in order of begin()
};

/// Times spans of commands without ever waiting for the GPU. Spans may nest. Empty when moved from.
class GpuTimer {
public:
    GpuTimer() = default;
    /// At most `framesInFlight` frames wait for their times; while so many do, further frames go untimed and are
    /// counted.
    explicit GpuTimer(int framesInFlight);
    GpuTimer(GpuTimer&& other) noexcept;
    GpuTimer& operator=(GpuTimer&& other) noexcept;

    /// Everything until endFrame() belongs to `frame`, a number of the caller's that comes back with the times.
    void beginFrame(uint64_t frame);
    /// Starts a span and returns its number, for end().
    size_t begin(std::string_view name);
    void end(size_t span);
    /// CHECKs that every span has ended.
    void endFrame();

    /// The frames whose times have come since the last call, oldest first. Never waits.
    std::vector<FrameTimes> collect();
    /// All that are left, waiting for them: for the end of a run.
    std::vector<FrameTimes> collectAll();

    /// False where the driver has no timestamps: frames then come back without spans.
    [[nodiscard]] bool available() const { return available_; }
    [[nodiscard]] size_t framesWaiting() const { return waiting_.size(); }
    [[nodiscard]] uint64_t framesUntimed() const { return untimed_; }

private:
    struct Span {
        std::string name;
        Object begin, end;
    };
    struct Frame {
        uint64_t number = 0;
        std::vector<Span> spans;
    };
    Object takeQuery();
    Object stamp();
    FrameTimes read(Frame& frame);
    static bool complete(const Frame& frame);

    size_t framesInFlight_ = 0;
    bool available_ = false;
    bool flushes_ = false;   // Workaround::FlushTimestamps
    bool recording_ = false; // between beginFrame and endFrame
    bool timing_ = false;    // and this frame is timed
    Frame current_;
    std::deque<Frame> waiting_;
    std::vector<Object> free_;
    uint64_t untimed_ = 0;
};

} // namespace tyndall::gl
