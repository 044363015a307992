// Truncated and bit-flipped volume files: each is taken or refused with one sentence, in bounded time. The cases are
// seeded; a failure prints the command that repeats it alone (TYNDALL_CASE). TYNDALL_CASES sets how many are tried.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <string>

#include "media/grid_import.h"
#include "media_volume_files.h"
#include "support/content.h"

namespace tyndall {
namespace {

namespace fs = std::filesystem;

long fromEnvironment(const char* name, long otherwise) {
    const char* value = std::getenv(name);
    return value && *value ? std::strtol(value, nullptr, 10) : otherwise;
}

uint64_t scramble(uint64_t z) { // SplitMix64
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/// One of five kinds of damage; most flips hit the head, where the structure is.
std::string damaged(std::string bytes, uint64_t seed) {
    uint64_t state = scramble(seed);
    const auto draw = [&](uint64_t below) { return (state = scramble(state)) % below; };
    const auto flip = [&](uint64_t below) {
        bytes[draw(std::min<uint64_t>(below, bytes.size()))] ^= char(1u << draw(8));
    };
    switch (draw(5)) {
    case 0: bytes.resize(draw(bytes.size())); break;
    case 1: flip(bytes.size()); break;
    case 2: flip(2048); break;
    case 3:
        for (uint64_t i = 0, count = 1 + draw(64); i < count; ++i) flip(bytes.size());
        break;
    default: { // a number overwritten with an extreme one
        const size_t at = draw(std::min<uint64_t>(bytes.size() - 8, draw(2) ? 4096 : bytes.size()));
        const uint64_t extremes[] = {0,
                                     ~uint64_t(0),
                                     0x7fffffffffffffffu,
                                     0x8000000080000000u,
                                     0x7fc000007fc00000u,
                                     0x0000001000000010u};
        const uint64_t value = extremes[draw(std::size(extremes))];
        for (int i = 0; i < (draw(2) ? 4 : 8); ++i) bytes[at + size_t(i)] = char(value >> (8 * i));
    }
    }
    return bytes;
}

bool isOneSentence(const std::string& message, const fs::path& file) {
    if (message.size() < 20 || message.size() > 1500 ||
        message.find(file.filename().string()) == std::string::npos)
        return false;
    for (const char c : message)
        if (static_cast<unsigned char>(c) < 0x20) return false;
    return true;
}

bool isSound(const GridFile& file) {
    const BrickGrid& grid = *file.density;
    for (const float sample : grid.samples)
        if (!(sample >= 0 && sample <= kMaximumVoxel)) return false;
    for (const Brick& brick : grid.bricks)
        if (!(brick.minimum >= 0 && brick.minimum <= brick.maximum &&
              brick.maximum <= kMaximumVoxel))
            return false;
    return true;
}

void survive(const fs::path& original, long cases) {
    std::ifstream stream(original, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    const fs::path folder = test::scratchDir("damage"),
                   path = folder / ("damaged" + original.extension().string());
    GridRequest request;
    request.limits.seconds = 20;
    request.limits.readerBytes = uint64_t(2) << 30;
    request.limits.sampleBytes = uint64_t(1) << 28;
    request.limits.brickCount = uint64_t(1) << 21;

    const long only = fromEnvironment("TYNDALL_CASE", -1);
    const auto began = std::chrono::steady_clock::now();
    std::map<std::string, int> outcomes;
    double slowest = 0;
    for (long i = only < 0 ? 0 : only; i < (only < 0 ? cases : only + 1); ++i) {
        std::ofstream(path, std::ios::binary | std::ios::trunc)
            << damaged(bytes, test::seed() * 1000003 + uint64_t(i));
        const auto start = std::chrono::steady_clock::now();
        const Result<GridFile> file = importGrid(path, request);
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        slowest = std::max(slowest, seconds);
        const std::string repeat = "repeat: TYNDALL_SEED=" + std::to_string(test::seed()) +
                                   " TYNDALL_CASE=" + std::to_string(i);
        if (file.ok()) {
            ASSERT_TRUE(isSound(*file)) << repeat;
        } else {
            ASSERT_TRUE(isOneSentence(file.message(), path)) << file.message() << "\n" << repeat;
        }
        ASSERT_LT(seconds, request.limits.seconds + 20) << repeat;
        const std::string kind =
            file.ok() ? "taken" : file.message().substr(file.message().find("' ") + 2);
        outcomes[kind.substr(0, 90)] += 1;
    }
    const double total =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    std::printf("%ld damaged copies of %s in %.1f s, the slowest %.2f s\n", cases,
                original.filename().c_str(), total, slowest);
    for (const auto& [kind, count] : outcomes) std::printf("%6d  %s\n", count, kind.c_str());
    if (only < 0 && cases >= 50) {
        EXPECT_GT(outcomes["taken"], 0) << "some damage is harmless";
        EXPECT_GT(outcomes.size(), 3u) << "the damage is too uniform to mean anything";
    }
}

#ifdef TYNDALL_LONG_RUN
constexpr long kCases = 1000;
#else
constexpr long kCases = 50;
#endif

long casesToTry() { return fromEnvironment("TYNDALL_CASES", kCases); }

TEST(DamagedGrids, OpenVdbIsTakenOrRefusedInOneSentence) {
    survive(REQUIRE_CONTENT("vdb/sphere_fog_tiny.vdb"), casesToTry());
}

TEST(DamagedGrids, BloscOpenVdbIsTakenOrRefusedInOneSentence) {
    survive(REQUIRE_CONTENT("vdb/smoke_doublegrid_blosc.vdb"), casesToTry() / 2);
}

TEST(DamagedGrids, ZippedNanoVdbIsTakenOrRefusedInOneSentence) {
    survive(REQUIRE_CONTENT("nvdb/wdas_cloud_sixteenth_fpN_zip.nvdb"), casesToTry() / 2);
}

TEST(DamagedGrids, PlainNanoVdbIsTakenOrRefusedInOneSentence) {
    // Nothing but the checks of the tree stands between the damage and the memory.
    const fs::path plain = test::scratchDir("plain") / "plain.nvdb";
    test::convertToNanoVdb(REQUIRE_CONTENT("vdb/sphere_fog_tiny.vdb"), plain, test::NanoType::FpN,
                           test::NanoCodec::None);
    survive(plain, casesToTry());
}

} // namespace
} // namespace tyndall
