#include "gl/buffer.h"

#include <gmock/gmock.h>

#include <cstring>
#include <numeric>
#include <random>

#include "gl/gl_fixture.h"
#include "support/content.h"

namespace tyndall::gl {
namespace {

class BufferTest : public test::GlTest {};
TYNDALL_GL_TESTS(BufferTest);

std::vector<uint32_t> counting(size_t count, uint32_t first) {
    std::vector<uint32_t> values(count);
    std::iota(values.begin(), values.end(), first);
    return values;
}

TEST_P(BufferTest, HoldsWhatItWasMadeWith) {
    const std::vector<uint32_t> values = counting(100, 5);
    const Buffer buffer("values", std::as_bytes(std::span(values)));
    EXPECT_EQ(buffer.bytes(), 400u);
    EXPECT_EQ(buffer.readAll<uint32_t>(), values);
}

TEST_P(BufferTest, WritesCopiesAndClearsInPlace) {
    Buffer buffer("target", 32, BufferAccess::CpuUpdates);
    buffer.clear(0xdeadbeefu);
    const uint32_t two[2] = {1, 2};
    buffer.write(8, two, sizeof two);
    const Buffer source("source", std::as_bytes(std::span(two)));
    buffer.copyFrom(source.id(), 4, 28, 4);
    const uint32_t old = 0xdeadbeefu;
    EXPECT_EQ(buffer.readAll<uint32_t>(),
              (std::vector<uint32_t>{old, old, 1, 2, old, old, old, 2}));
    uint32_t part[2] = {};
    buffer.read(12, part, sizeof part);
    EXPECT_EQ(part[0], 2u);
    EXPECT_EQ(part[1], old);
}

TEST_P(BufferTest, RefusesWhatIsOutside) {
    Buffer fixed("fixed", 16);
    Buffer open("open", 16, BufferAccess::CpuUpdates);
    uint32_t value[8] = {};
    EXPECT_THROW(fixed.write(0, value, 4), CheckFailure);
    EXPECT_THROW(open.write(16, value, 4), CheckFailure);
    EXPECT_THROW(open.write(uint64_t(0) - 4, value, 8), CheckFailure);
    EXPECT_THROW(open.read(4, value, 16), CheckFailure);
    EXPECT_THROW(Buffer("none", uint64_t(0)), CheckFailure);
}

TEST_P(BufferTest, ASizeThatNoGpuHasIsAnErrorWithTheName) {
    const Result<Buffer> buffer = Buffer::create("enormous", uint64_t(1) << 60);
    ASSERT_FALSE(buffer.ok());
    EXPECT_THAT(buffer.message(), ::testing::HasSubstr("enormous"));
}

/// Frames of random sizes go through a ring that is much smaller than their sum; the GPU copies each slice to a buffer
/// that is only looked at in the end. A slice that was reused too early would show a later frame's numbers.
TEST_P(BufferTest, TheRingNeverOverwritesWhatTheGpuHasYetToRead) {
    std::mt19937 random(uint32_t(test::seed()));
    UploadRing ring("ring", 8192);
    constexpr uint32_t kFrames = 200, kSlices = 4, kMostWords = 300;
    Buffer result("result", uint64_t(kFrames) * kSlices * kMostWords * 4);
    result.clear(0);
    std::vector<uint32_t> expected(size_t(kFrames) * kSlices * kMostWords, 0);
    uint32_t next = 1;
    for (uint32_t frame = 0; frame < kFrames; ++frame) {
        for (uint32_t slice = 0; slice < kSlices; ++slice) {
            const std::vector<uint32_t> values = counting(1 + random() % kMostWords, next);
            next += uint32_t(values.size());
            const uint64_t alignment = uint64_t(1) << (2 + random() % 7);
            const UploadRing::Slice piece =
                ring.upload(values.data(), values.size() * 4, alignment);
            EXPECT_EQ(piece.offset % alignment, 0u);
            const size_t at = (size_t(frame) * kSlices + slice) * kMostWords;
            result.copyFrom(piece.buffer, piece.offset, at * 4, values.size() * 4);
            std::copy(values.begin(), values.end(), expected.begin() + std::ptrdiff_t(at));
        }
        ring.endFrame();
    }
    EXPECT_TRUE(result.readAll<uint32_t>() == expected) << "seed " << test::seed();
    EXPECT_GT(ring.statistics().wraps, 10u) << "the test must go round";
}

TEST_P(BufferTest, TheRingGrowsForAFrameThatDoesNotFitAndKeepsWhatWasThere) {
    UploadRing ring("ring", 256);
    const std::vector<uint32_t> small = counting(32, 1), large = counting(1000, 5000);
    const UploadRing::Slice first = ring.upload(small.data(), 128, 16);
    const UploadRing::Slice second = ring.upload(large.data(), 4000, 16);
    EXPECT_NE(first.buffer, second.buffer);
    EXPECT_GE(ring.capacity(), 4000u);
    EXPECT_EQ(ring.statistics().grown, 1u);
    Buffer result("result", 4128);
    result.copyFrom(first.buffer, first.offset, 0,
                    128); // the old memory lives as long as the frame
    result.copyFrom(second.buffer, second.offset, 128, 4000);
    ring.endFrame();
    const std::vector<uint32_t> values = result.readAll<uint32_t>();
    EXPECT_TRUE(std::equal(small.begin(), small.end(), values.begin()));
    EXPECT_TRUE(std::equal(large.begin(), large.end(), values.begin() + 32));
    for (int frame = 0; frame < 4; ++frame) {
        glFinish();
        ring.upload(small.data(), 128, 16);
        ring.endFrame();
    }
    EXPECT_EQ(context().liveObjects().count(ObjectKind::Buffer), 2)
        << "the old memory goes when its frame is done";
}

TEST_P(BufferTest, ARingThatIsLongEnoughDoesNotGrow) {
    UploadRing ring("ring", 64 * 1024);
    const std::vector<uint32_t> values = counting(256, 1);
    for (int frame = 0; frame < 500; ++frame) {
        ring.upload(values.data(), 1024, 256);
        ring.endFrame();
    }
    EXPECT_EQ(ring.statistics().grown, 0u);
    EXPECT_EQ(ring.capacity(), 64u * 1024u);
}

TEST_P(BufferTest, AMovedFromRingIsEmpty) {
    UploadRing ring("ring", 1024);
    UploadRing moved = std::move(ring);
    EXPECT_THROW(ring.allocate(4, 4), CheckFailure); // NOLINT: that is the point
    EXPECT_NE(moved.allocate(4, 4).data, nullptr);
}

} // namespace
} // namespace tyndall::gl
