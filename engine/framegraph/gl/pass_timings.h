#pragma once
// GPU times of passes, read frames later, found again by the pass's name.

#include <array>
#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "gl/gpu_timer.h"

namespace tyndall::fg {

class PassTimings {
public:
    explicit PassTimings(bool enabled);

    void beginFrame();
    /// A number for this pass that is the same in every frame: of its name, and its place among passes of one name.
    uint64_t keyOf(std::string_view passName);
    void begin(uint64_t key, std::string_view passName);
    void end();
    void endFrame();

    /// Waits for all measurements that are under way.
    void finish();

    /// Milliseconds of the last measurement that has arrived; −1: none.
    [[nodiscard]] double lastMs(uint64_t key) const;

private:
    static constexpr size_t kFramesInFlight = 4;
    struct Seen {
        uint64_t frame;
        uint64_t count;
    };
    void keep(const std::vector<gl::FrameTimes>& arrived);

    bool enabled_;
    gl::GpuTimer timer_;
    uint64_t frame_ = 0, untimed_ = 0;
    size_t span_ = 0;
    struct FrameKeys {
        uint64_t frame = 0;
        std::vector<uint64_t> keys; // of its spans
    };
    std::array<FrameKeys, kFramesInFlight + 1>
        frames_; // those that wait, and the one being recorded
    size_t current_ = 0;
    std::unordered_map<uint64_t, Seen> seen_; // by name
    std::unordered_map<uint64_t, double> lastMs_;
};

} // namespace tyndall::fg
