// Volume files that were cut off: refused with the byte where they end, never a thinner cloud.

#include "media/grid_import.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "media_dense_field.h"
#include "media_volume_files.h"
#include "support/content.h"

namespace tyndall {
namespace {

namespace fs = std::filesystem;
using test::VdbLayout;
using test::VolumeSpec;
using ::testing::HasSubstr;
using ::testing::Not;

const fs::path& folder() {
    static const fs::path path = test::scratchDir("cut");
    return path;
}

/// Noise in a few leaves, with a tile and background beside it: every part of the format that a small file can have.
VolumeSpec cloud(const std::string& name, VolumeSpec::Type type = VolumeSpec::Type::Float) {
    VolumeSpec spec;
    spec.name = name;
    spec.type = type;
    test::Draw draw(7);
    for (int z = 0; z < 12; ++z)
        for (int y = 0; y < 12; ++y)
            for (int x = 0; x < 12; ++x)
                if ((x + y + z) % 3)
                    spec.voxels.emplace_back(ivec3(x, y, z), draw.uniform(0.25, 4));
    spec.tiles.push_back({{128, 0, 0}, {135, 7, 7}, 0.5});
    return spec;
}

std::string contentOf(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

GridRequest only(const std::string& density) {
    GridRequest request;
    request.density = density;
    return request;
}

/// Lengths of strict prefixes: the shortest, the longest, and some at random from all parts of the file.
std::vector<size_t> cuts(size_t bytes, size_t count) {
    std::vector<size_t> lengths = {1, 8, 30, 61, 70, bytes / 2, bytes - 8, bytes - 2, bytes - 1};
    std::mt19937_64 random(test::seed());
    while (lengths.size() < count) lengths.push_back(1 + random() % (bytes - 1));
    return lengths;
}

void expectEveryCutRefused(const fs::path& path, const std::string& density, size_t count) {
    const std::string whole = contentOf(path);
    const Result<GridFile> right = importGrid(path, only(density));
    ASSERT_TRUE(right.ok()) << right.message();
    ASSERT_GT(right->density->maximum, 0.0f) << "else nothing could be missing";
    const fs::path cut = folder() / ("cut" + path.extension().string());
    for (const size_t length : cuts(whole.size(), count)) {
        SCOPED_TRACE(std::to_string(length) + " of " + std::to_string(whole.size()) +
                     " bytes, seed " + std::to_string(test::seed()));
        std::ofstream(cut, std::ios::binary | std::ios::trunc) << whole.substr(0, length);
        const Result<GridFile> file = importGrid(cut, only(density));
        ASSERT_FALSE(file.ok());
        if (length + 1 == whole.size()) {
            ASSERT_FALSE(gridInfo(cut).ok());
        }
        EXPECT_THAT(file.message(), HasSubstr(cut.filename().string()));
        EXPECT_THAT(file.message(), Not(HasSubstr("\n")));
        // Shorter ones may not even begin like a volume.
        if (length >= 8) {
            EXPECT_THAT(file.message(),
                        HasSubstr("ends after " + std::to_string(length) + " bytes"));
        }
    }
}

TEST(CutVolumes, EveryCutOfAnOpenVdbFileIsRefusedWithThePlaceWhereItEnds) {
    const fs::path path = folder() / "a.vdb";
    for (const VdbLayout::Codec codec :
         {VdbLayout::Codec::None, VdbLayout::Codec::Zip, VdbLayout::Codec::Blosc})
        for (const bool offsets : {true, false}) {
            SCOPED_TRACE("codec " + std::to_string(int(codec)) + (offsets ? "" : ", a stream"));
            test::writeOpenVdb(path, {cloud("density")}, {codec, offsets});
            ASSERT_NO_FATAL_FAILURE(expectEveryCutRefused(path, "density", 12));
        }
}

TEST(CutVolumes, OfSeveralGridsEachMayBeTheOneThatIsCut) {
    const fs::path path = folder() / "several.vdb";
    VolumeSpec wind = cloud("wind");
    wind.type = VolumeSpec::Type::Vector;
    for (const bool offsets : {true, false}) {
        test::writeOpenVdb(path,
                           {cloud("density", VolumeSpec::Type::HalfStored), wind,
                            cloud("temperature", VolumeSpec::Type::Double)},
                           {VdbLayout::Codec::Default, offsets});
        ASSERT_NO_FATAL_FAILURE(expectEveryCutRefused(path, "density", 14));
        ASSERT_NO_FATAL_FAILURE(expectEveryCutRefused(path, "temperature", 10));
    }
}

TEST(CutVolumes, EveryCutOfANanoVdbFileIsRefusedWithThePlaceWhereItEnds) {
    const fs::path path = folder() / "a.nvdb";
    for (const test::NanoCodec codec :
         {test::NanoCodec::None, test::NanoCodec::Zip, test::NanoCodec::Blosc}) {
        test::writeNanoVdb(path, cloud("density"), test::NanoType::Float, codec);
        ASSERT_NO_FATAL_FAILURE(expectEveryCutRefused(path, "density", 12));
    }
}

TEST(CutVolumes, DelayedLoadingOfTheLibraryMakesNoDifference) {
    const fs::path path = folder() / "delayed.vdb";
    ::setenv("OPENVDB_DISABLE_DELAYED_LOAD", "1", 1);
    test::writeOpenVdb(path, {cloud("density")});
    expectEveryCutRefused(path, "density", 9);
    ::unsetenv("OPENVDB_DISABLE_DELAYED_LOAD");
    expectEveryCutRefused(path, "density", 9);
}

TEST(CutVolumes, TheSmokeOfTheSharedContentIsRefusedWhereverItIsCut) {
    const fs::path path = REQUIRE_CONTENT("vdb/smoke1.vdb");
    expectEveryCutRefused(path, "density", 16);
    const std::string whole = contentOf(path);
    for (const size_t length : {size_t(20000), size_t(2000000)}) {
        const fs::path cut = folder() / "smoke.vdb";
        std::ofstream(cut, std::ios::binary | std::ios::trunc) << whole.substr(0, length);
        EXPECT_THAT(importGrid(cut).message(),
                    HasSubstr("ends after " + std::to_string(length) +
                              " bytes, and its grid 'density' goes on to byte " +
                              std::to_string(whole.size())));
    }
}

TEST(WholeVolumes, AFileWithoutOffsetsHasTheSameVoxels) {
    const std::vector<VolumeSpec> grids = {cloud("density"), cloud("other")};
    test::writeOpenVdb(folder() / "file.vdb", grids);
    test::writeOpenVdb(folder() / "stream.vdb", grids, {VdbLayout::Codec::Default, false});
    const Result<GridFile> file = importGrid(folder() / "file.vdb"),
                           stream = importGrid(folder() / "stream.vdb");
    ASSERT_TRUE(file.ok()) << file.message();
    ASSERT_TRUE(stream.ok()) << stream.message();
    EXPECT_EQ(file->density->samples, stream->density->samples);
    for (const auto& [index, value] : grids[0].voxels)
        EXPECT_EQ(stream->density->sample(dvec3(index)), double(float(value)));
}

TEST(WholeVolumes, GridsThatShareATreeAllHaveIt) {
    const VolumeSpec spec = cloud("density");
    test::writeOpenVdb(folder() / "one.vdb", {spec});
    test::writeInstances(folder() / "shared.vdb", spec, {"density", "dust", "smoke"});
    EXPECT_LT(fs::file_size(folder() / "shared.vdb"), 2 * fs::file_size(folder() / "one.vdb"))
        << "the tree is stored once";
    const Result<GridFile> one = importGrid(folder() / "one.vdb");
    ASSERT_TRUE(one.ok()) << one.message();
    for (const char* name : {"density", "dust", "smoke"}) {
        const Result<GridFile> file = importGrid(folder() / "shared.vdb", only(name));
        ASSERT_TRUE(file.ok()) << file.message();
        EXPECT_EQ(file->density->samples, one->density->samples) << name;
    }
}

} // namespace
} // namespace tyndall
