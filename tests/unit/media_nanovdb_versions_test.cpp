// NanoVDB files as versions other than the installed one write them. Between 32.3 and 32.9 the layout is the same; the magic
// numbers, the version and the checksum are not (nanovdb/NanoVDB.h and nanovdb/tools/GridChecksum.h of these versions).

#include "media/grid_import.h"

#include <cstring>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "media_dense_field.h"
#include "media_volume_files.h"
#include "support/content.h"

namespace tyndall {
namespace {

namespace fs = std::filesystem;
using test::VolumeSpec;
using ::testing::HasSubstr;

const fs::path& folder() {
    static const fs::path path = test::scratchDir("nanovdb-versions");
    return path;
}

VolumeSpec cloud() {
    VolumeSpec spec;
    test::Draw draw(11);
    for (int z = 0; z < 20; ++z)
        for (int y = 0; y < 9; ++y)
            for (int x = 0; x < 9; ++x)
                spec.voxels.emplace_back(ivec3(x, y, z), draw.uniform(0.25, 4));
    return spec;
}

/// CRC-32 (ISO 3309) bit by bit.
uint32_t crc32(std::string_view bytes) {
    uint32_t crc = ~0u;
    for (const char byte : bytes) {
        crc ^= uint8_t(byte);
        for (int i = 0; i < 8; ++i) crc = (crc >> 1) ^ (crc & 1 ? 0xEDB88320u : 0u);
    }
    return ~crc;
}

// Places in an uncompressed file of one grid called "density" (with its terminator), and in a grid.
constexpr size_t kGrid = 16 + 176 + 8, kChecksum = 8, kVersion = 16, kBody = 672 + 64;

std::string contentOf(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void put(std::string& content, size_t at, uint32_t value) {
    std::memcpy(content.data() + at, &value, sizeof value);
}

enum class Checksum { Kept = 0, None = 1, Head = 2, Full = 3 };

/// Both checksums of a grid as 32.6.1 and later define them.
void putChecksum(std::string& content, Checksum kind) {
    if (kind == Checksum::Kept) return;
    const std::string_view grid = std::string_view(content).substr(kGrid),
                           body = grid.substr(kBody);
    std::string pieces;
    for (size_t i = 0; i < body.size() / 4096; ++i) {
        const bool last = i + 1 == body.size() / 4096;
        const uint32_t crc = crc32(body.substr(i * 4096, last ? std::string::npos : 4096));
        pieces.append(reinterpret_cast<const char*>(&crc), sizeof crc);
    }
    const uint32_t head = crc32(grid.substr(kVersion, kBody - kVersion)), tail = crc32(pieces);
    put(content, kGrid + kChecksum, kind == Checksum::None ? ~0u : head);
    put(content, kGrid + kChecksum + 4, kind == Checksum::Full ? tail : ~0u);
}

/// The file of this version, with "NanoVDB" followed by these digits as magic numbers.
std::string fileOf(uint32_t major, uint32_t minor, uint32_t patch, char fileDigit, char gridDigit,
                   Checksum checksum) {
    test::writeNanoVdb(folder() / "installed.nvdb", cloud(), test::NanoType::Float,
                       test::NanoCodec::None);
    std::string content = contentOf(folder() / "installed.nvdb");
    const uint32_t version = major << 21 | minor << 10 | patch;
    content[7] = fileDigit;
    put(content, 8, version);
    content[kGrid + 7] = gridDigit;
    put(content, kGrid + kVersion, version);
    putChecksum(content, checksum);
    return content;
}

Result<GridFile> import(const std::string& content) {
    const fs::path path = folder() / "version.nvdb";
    std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
    return importGrid(path);
}

void expectTheCloud(const Result<GridFile>& file) {
    ASSERT_TRUE(file.ok()) << file.message();
    for (const auto& [index, value] : cloud().voxels)
        ASSERT_EQ(file->density->sample(dvec3(index)), double(float(value)));
}

TEST(NanoVdbVersions, LaterFilesOfTheSameLayoutHaveTheSameVoxels) {
    expectTheCloud(import(fileOf(32, 4, 2, '0', '0', Checksum::Kept)));
    for (const Checksum checksum : {Checksum::None, Checksum::Head, Checksum::Full}) {
        expectTheCloud(import(fileOf(32, 6, 1, '0', '0', checksum)));
        expectTheCloud(import(fileOf(32, 7, 0, '2', '1', checksum)));
        expectTheCloud(import(fileOf(32, 9, 1, '2', '1', checksum)));
        expectTheCloud(import(fileOf(32, 9, 1, '2', '0', checksum)));
    }
    EXPECT_EQ(gridInfo(folder() / "version.nvdb")->format, "NanoVDB 32.9.1");
}

TEST(NanoVdbVersions, DamageIsSeenByTheLaterChecksums) {
    const std::string good = fileOf(32, 7, 0, '2', '1', Checksum::Full);
    for (const size_t at : {kGrid + 296, kGrid + kBody + 5000, good.size() - 1}) {
        std::string bad = good;
        bad[at] = char(bad[at] ^ 1);
        const Result<GridFile> file = import(bad);
        ASSERT_FALSE(file.ok()) << at;
        EXPECT_THAT(file.message(), HasSubstr("its checksum does not match its content"));
    }
}

TEST(NanoVdbVersions, ABareGridIsCalledThat) {
    for (const char digit : {'0', '1'})
        for (const Checksum checksum : {Checksum::None, Checksum::Head, Checksum::Full}) {
            const Result<GridFile> file =
                import(fileOf(32, 7, 0, '0', digit, checksum).substr(kGrid));
            ASSERT_FALSE(file.ok());
            EXPECT_THAT(file.message(),
                        HasSubstr("it is a bare grid: the bytes of a NanoVDB 32.7.0 "
                                  "grid without the header of a file"));
        }
}

TEST(NanoVdbVersions, OtherVersionsAreNamedWithWhatToDo) {
    const Result<GridFile> later = import(fileOf(33, 0, 0, '2', '1', Checksum::Full)),
                           unknown = import(fileOf(32, 7, 0, '7', '1', Checksum::Full));
    EXPECT_THAT(later.message(), HasSubstr("NanoVDB 33.0.0; version 32 is understood: convert"));
    EXPECT_THAT(unknown.message(), HasSubstr("version 32 is understood: convert the volume again"));
}

} // namespace
} // namespace tyndall
