#include "media/grid_import.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "media/segment_integral.h"
#include "media_dense_field.h"
#include "media_volume_files.h"
#include "support/content.h"

namespace tyndall {
namespace {

namespace fs = std::filesystem;
using test::Draw;
using test::NanoCodec;
using test::NanoType;
using test::VolumeOracle;
using test::VolumeSpec;

const fs::path& folder() {
    static const fs::path path = test::scratchDir("import");
    return path;
}

/// A small cloud of voxels about the origin, all of its indices within ±12.
VolumeSpec cloud(const std::string& name = "density") {
    VolumeSpec spec;
    spec.name = name;
    Draw draw(42);
    for (int z = -12; z <= 12; ++z)
        for (int y = -9; y <= 9; ++y)
            for (int x = -12; x <= 12; ++x)
                if (x * x + y * y + z * z < 120)
                    spec.voxels.emplace_back(ivec3(x, y, z), draw.uniform(0.25, 4));
    return spec;
}

dmat4 generalTransform() {
    dmat4 shear(1.0);
    shear[1][0] = 0.3;
    return glm::translate(dmat4(1.0), dvec3(3, -1, 0.5)) *
           glm::rotate(dmat4(1.0), 0.7, glm::normalize(dvec3(1, 2, 3))) * shear *
           glm::scale(dmat4(1.0), dvec3(0.1, 0.25, 0.05));
}

std::string message(const Result<GridFile>& file) { return file.ok() ? "taken" : file.message(); }

bool mentions(const std::vector<std::string>& notes, const std::string& text) {
    for (const std::string& note : notes)
        if (note.find(text) != std::string::npos) return true;
    return false;
}

/// Every voxel of the oracle's box, and a rim around it.
void expectSameVoxels(const BrickGrid& grid, const VolumeOracle& oracle, double tolerance) {
    auto [low, high] = oracle.activeBox();
    for (int z = low.z - 2; z <= high.z + 2; ++z)
        for (int y = low.y - 2; y <= high.y + 2; ++y)
            for (int x = low.x - 2; x <= high.x + 2; ++x)
                ASSERT_NEAR(grid.sample({x, y, z}), oracle.voxel({x, y, z}), tolerance)
                    << x << " " << y << " " << z;
}

/// Transmittance along seeded rays through the volume against OpenVDB's own trilinear sampler; the extinction is such that
/// the mean optical depth is about 1, where transmittance is most sensitive.
void expectSameTransmittance(const fs::path& path, const std::string& name, int rays, int steps) {
    const Result<GridFile> file = importGrid(
        path, {.density = name, .temperature = {}, .findTemperature = false, .limits = {}});
    ASSERT_TRUE(file.ok()) << file.message();
    const VolumeOracle oracle(path, name);
    const auto [low, high] = oracle.activeBox();
    Bounds world;
    for (int corner = 0; corner < 8; ++corner)
        world.include(
            oracle.world({corner & 1 ? high.x + 1 : low.x - 1, corner & 2 ? high.y + 1 : low.y - 1,
                          corner & 4 ? high.z + 1 : low.z - 1}));
    const double length = 1.2 * glm::length(world.extent());
    Draw draw(test::seed());
    double sum = 0, worst = 0, halfVoxel = 0;
    std::vector<std::pair<RaySegment, double>> expected;
    for (int i = 0; i < rays; ++i) {
        const dvec3 target = oracle.world(glm::mix(
            dvec3(low), dvec3(high),
            dvec3(draw.uniform(0.1, 0.9), draw.uniform(0.1, 0.9), draw.uniform(0.1, 0.9))));
        const dvec3 direction = draw.unitVector();
        const RaySegment segment{target - 0.5 * length * direction, direction, length};
        expected.emplace_back(segment, oracle.integrate(segment.origin, direction, length, steps));
        sum += expected.back().second;
    }
    ASSERT_GT(sum, 0);
    const double sigma = rays / sum;
    const dmat4 shifted = glm::translate(file->density->worldFromIndex, dvec3(0.5));
    for (const auto& [segment, integral] : expected) {
        worst = std::max(
            worst,
            std::abs(std::exp(-sigma * integrateGrid(*file->density, file->density->worldFromIndex,
                                                     segment)) -
                     std::exp(-sigma * integral)));
        halfVoxel = std::max(
            halfVoxel, std::abs(std::exp(-sigma * integrateGrid(*file->density, shifted, segment)) -
                                std::exp(-sigma * integral)));
    }
    std::printf("worst transmittance error %.2g; half a voxel off it would be %.2g\n", worst,
                halfVoxel);
    EXPECT_LT(worst, 1e-4);
    EXPECT_GT(halfVoxel, 3e-4) << "this test would not notice half a voxel";
}

TEST(ImportGrid, TransmittanceOfRealFilesMatchesOpenVdb) {
    for (const char* name : {"vdb/smoke1.vdb", "vdb/dragon_fog_xform.vdb",
                             "vdb/wdas_cloud_sixteenth.vdb", "vdb/sphere_fog_tiny.vdb"}) {
        SCOPED_TRACE(name);
        expectSameTransmittance(REQUIRE_CONTENT(name), "density", 12, 40000);
    }
}

TEST(ImportGrid, TransmittanceUnderAGeneralTransformMatchesOpenVdb) {
    VolumeSpec spec = cloud();
    spec.worldFromIndex = generalTransform();
    test::writeOpenVdb(folder() / "general.vdb", {spec});
    expectSameTransmittance(folder() / "general.vdb", "density", 30, 20000);
    spec.worldFromIndex[0] = -spec.worldFromIndex[0]; // mirrored
    test::writeOpenVdb(folder() / "mirrored.vdb", {spec});
    expectSameTransmittance(folder() / "mirrored.vdb", "density", 30, 20000);
}

TEST(ImportGrid, FloatHalfAndDoubleLoadAlike) {
    VolumeSpec spec = cloud();
    for (auto& [index, value] : spec.voxels)
        value = std::round(value * 256) / 256; // exact in half precision
    for (const VolumeSpec::Type type :
         {VolumeSpec::Type::Float, VolumeSpec::Type::HalfStored, VolumeSpec::Type::Double}) {
        spec.type = type;
        const fs::path path = folder() / "typed.vdb";
        test::writeOpenVdb(path, {spec});
        const Result<GridFile> file = importGrid(path);
        ASSERT_TRUE(file.ok()) << file.message();
        EXPECT_TRUE(file->notes.empty());
        for (const auto& [index, value] : spec.voxels)
            ASSERT_EQ(file->density->sample(dvec3(index)), value);
    }
}

TEST(ImportGrid, DoubleGridOfTheSharedContentMatchesVoxelByVoxel) {
    const fs::path path = REQUIRE_CONTENT("vdb/smoke_doublegrid_blosc.vdb");
    const Result<GridFile> file = importGrid(path);
    ASSERT_TRUE(file.ok()) << file.message();
    expectSameVoxels(*file->density, VolumeOracle(path, "density"), 1e-7);
}

TEST(ImportGrid, NanoVdbOfEveryTypeAndCodecEqualsTheVdb) {
    VolumeSpec spec = cloud();
    spec.worldFromIndex = generalTransform();
    spec.tiles.push_back(
        {{128, 0, 0}, {255, 127, 127}, 0.5}); // a tile of the lower internal nodes' level
    const fs::path vdb = folder() / "same.vdb", nvdb = folder() / "same.nvdb";
    test::writeOpenVdb(vdb, {spec});
    const Result<GridFile> original = importGrid(vdb);
    ASSERT_TRUE(original.ok()) << original.message();
    // Codes of n bits spread over the range of a leaf (at most 4): half a step; FpN chooses bits for an error of 0.01 by default.
    const std::pair<NanoType, double> types[] = {{NanoType::Float, 0},
                                                 {NanoType::Double, 1e-7},
                                                 {NanoType::Fp4, 4.0 / 15 / 2 + 1e-6},
                                                 {NanoType::Fp8, 4.0 / 255 / 2 + 1e-6},
                                                 {NanoType::Fp16, 4.0 / 65535 / 2 + 1e-6},
                                                 {NanoType::FpN, 0.05}};
    for (const auto& [type, tolerance] : types)
        for (const NanoCodec codec : {NanoCodec::None, NanoCodec::Zip, NanoCodec::Blosc}) {
            SCOPED_TRACE(std::to_string(int(type)) + " codec " + std::to_string(int(codec)));
            test::writeNanoVdb(nvdb, spec, type, codec);
            const Result<GridFile> file = importGrid(nvdb);
            ASSERT_TRUE(file.ok()) << file.message();
            for (const auto& [index, value] : spec.voxels)
                ASSERT_NEAR(file->density->sample(dvec3(index)),
                            original->density->sample(dvec3(index)), tolerance);
            EXPECT_DOUBLE_EQ(file->density->sample({200, 100.5, 100}), 0.5);
            EXPECT_EQ(file->density->sample({20, 0, 0}), 0);
            for (int column = 0; column < 4; ++column)
                EXPECT_NEAR(glm::length(file->density->worldFromIndex[column] -
                                        spec.worldFromIndex[column]),
                            0, 1e-12);
        }
}

TEST(ImportGrid, NanoVdbOfTheSharedContentEqualsTheVdb) {
    const Result<GridFile> original = importGrid(REQUIRE_CONTENT("vdb/wdas_cloud_sixteenth.vdb"));
    const Result<GridFile> blosc =
        importGrid(REQUIRE_CONTENT("nvdb/wdas_cloud_sixteenth_blosc.nvdb"));
    const Result<GridFile> quantised =
        importGrid(REQUIRE_CONTENT("nvdb/wdas_cloud_sixteenth_fpN_zip.nvdb"));
    ASSERT_TRUE(original.ok() && blosc.ok() && quantised.ok());
    EXPECT_EQ(blosc->density->samples, original->density->samples);
    EXPECT_EQ(blosc->density->origin, original->density->origin);
    double worst = 0;
    const Bounds bounds = original->density->indexBounds();
    for (double z = bounds.minimum.z; z < bounds.maximum.z; z += 1)
        for (double y = bounds.minimum.y; y < bounds.maximum.y; y += 3)
            for (double x = bounds.minimum.x; x < bounds.maximum.x; x += 1)
                worst = std::max(worst, std::abs(original->density->sample({x, y, z}) -
                                                 quantised->density->sample({x, y, z})));
    EXPECT_LT(worst, 0.05) << "of a range of 1";
}

TEST(ImportGrid, ValuesOfInactiveVoxelsCountAndTheBackgroundDoesNot) {
    VolumeSpec spec;
    spec.voxels = {{{0, 0, 0}, 2.0}, {{300, 0, 0}, 1.0}};
    spec.inactiveVoxels = {{{3, 0, 0}, 5.0}};
    spec.background = 0.75; // would fill the world
    for (const bool nano : {false, true}) {
        const fs::path path = folder() / (nano ? "background.nvdb" : "background.vdb");
        if (nano)
            test::writeNanoVdb(path, spec, NanoType::Float, NanoCodec::None);
        else
            test::writeOpenVdb(path, {spec});
        const Result<GridFile> file = importGrid(path);
        ASSERT_TRUE(file.ok()) << file.message();
        EXPECT_EQ(file->density->sample({0, 0, 0}), 2);
        EXPECT_EQ(file->density->sample({3, 0, 0}), 5);
        EXPECT_EQ(file->density->sample({1, 0, 0}), 0);
        EXPECT_EQ(file->density->sample({100, 50, 0}), 0);
        EXPECT_EQ(file->density->sample({300, 0, 0}), 1);
    }
}

TEST(ImportGrid, HugeTilesAndFarVoxelsAreAffordableOrRefused) {
    VolumeSpec tiled;
    tiled.tiles.push_back({{0, 0, 0}, {1023, 511, 511}, 0.5});
    test::writeOpenVdb(folder() / "tiled.vdb", {tiled});
    const Result<GridFile> file = importGrid(folder() / "tiled.vdb");
    ASSERT_TRUE(file.ok()) << file.message();
    EXPECT_DOUBLE_EQ(file->density->sample({1000.5, 3, 400}), 0.5);
    EXPECT_LT(file->density->slotCount(), 60000u) << "of half a million bricks";

    VolumeSpec far;
    far.voxels = {{{-9000000, 0, 0}, 1.0}, {{9000000, 9000000, 9000000}, 1.0}};
    test::writeOpenVdb(folder() / "far.vdb", {far});
    EXPECT_NE(
        message(importGrid(folder() / "far.vdb")).find("lie in a box of 18000001×9000001×9000001"),
        std::string::npos)
        << message(importGrid(folder() / "far.vdb"));
    VolumeSpec farther;
    farther.voxels = {{{2000000000, 0, 0}, 1.0}};
    test::writeOpenVdb(folder() / "farther.vdb", {farther});
    EXPECT_NE(message(importGrid(folder() / "farther.vdb")).find("farther out"), std::string::npos)
        << message(importGrid(folder() / "farther.vdb"));
}

TEST(ImportGrid, BadVoxelsAreRepairedCountedAndReported) {
    VolumeSpec spec;
    spec.voxels = {{{0, 0, 0}, 1.0},
                   {{1, 0, 0}, std::nan("")},
                   {{2, 0, 0}, std::numeric_limits<double>::infinity()},
                   {{3, 0, 0}, -1.0},
                   {{4, 0, 0}, 1e38},
                   {{5, 0, 0}, -2.0}};
    for (const VolumeSpec::Type type : {VolumeSpec::Type::Float, VolumeSpec::Type::Double}) {
        spec.type = type;
        test::writeOpenVdb(folder() / "bad.vdb", {spec});
        const Result<GridFile> file = importGrid(folder() / "bad.vdb");
        ASSERT_TRUE(file.ok()) << file.message();
        EXPECT_TRUE(mentions(file->notes, "grid 'density': 2 non-finite voxels were set to 0"));
        EXPECT_TRUE(mentions(file->notes, "2 negative voxels were set to 0"));
        EXPECT_TRUE(mentions(file->notes, "1 huge voxel was set to 1e+20"));
        EXPECT_EQ(file->density->sample({0, 0, 0}), 1);
        for (const int x : {1, 2, 3, 5}) EXPECT_EQ(file->density->sample({x, 0, 0}), 0);
        EXPECT_EQ(file->density->sample({4, 0, 0}), double(kMaximumVoxel));
    }
}

TEST(ImportGrid, AGridOfZerosIsEmptyNotAnError) {
    VolumeSpec spec;
    spec.voxels = {{{0, 0, 0}, 0.0}};
    test::writeOpenVdb(folder() / "zeros.vdb", {spec});
    const Result<GridFile> file = importGrid(folder() / "zeros.vdb");
    ASSERT_TRUE(file.ok()) << file.message();
    EXPECT_TRUE(file->density->bricks.empty());
}

TEST(ImportGrid, SynonymsAreMappedAndSaid) {
    VolumeSpec heat = cloud("Heat"), vectors = cloud("v");
    heat.gridClass = VolumeSpec::Class::Unknown;
    vectors.type = VolumeSpec::Type::Vector;
    test::writeOpenVdb(folder() / "smoke.vdb", {vectors, heat, cloud("other"), cloud("Smoke")});
    const Result<GridFile> file =
        importGrid(folder() / "smoke.vdb",
                   {.density = {}, .temperature = {}, .findTemperature = true, .limits = {}});
    ASSERT_TRUE(file.ok()) << file.message();
    EXPECT_EQ(file->densityName, "Smoke");
    EXPECT_EQ(file->temperatureName, "Heat");
    ASSERT_NE(file->temperature, nullptr);
    EXPECT_TRUE(mentions(file->notes, "grid 'Smoke' is taken as density"));
    EXPECT_TRUE(mentions(file->notes, "grid 'Heat' is taken as temperature"));

    const Result<GridFile> named = importGrid(
        folder() / "smoke.vdb",
        {.density = "other", .temperature = "Heat", .findTemperature = false, .limits = {}});
    ASSERT_TRUE(named.ok());
    EXPECT_EQ(named->densityName, "other");
    EXPECT_TRUE(named->notes.empty());

    VolumeSpec odd = cloud("xyz");
    odd.gridClass = VolumeSpec::Class::Unknown;
    test::writeOpenVdb(folder() / "odd.vdb", {odd, vectors});
    const Result<GridFile> only = importGrid(folder() / "odd.vdb");
    ASSERT_TRUE(only.ok()) << only.message();
    EXPECT_TRUE(mentions(only->notes, "being the only one"));
    EXPECT_TRUE(mentions(only->notes, "does not say its class"));
}

TEST(ImportGrid, RefusesWhatIsNoDensityByNameAndClass) {
    VolumeSpec surface = cloud("ls_thing"), vectors = cloud("density"), numbers = cloud("ids"),
               frustum = cloud("density"), flat = cloud("density");
    surface.gridClass = VolumeSpec::Class::LevelSet;
    vectors.type = VolumeSpec::Type::Vector;
    numbers.type = VolumeSpec::Type::Integer;
    frustum.frustum = true;
    test::writeOpenVdb(folder() / "surface.vdb", {surface});
    EXPECT_NE(message(importGrid(folder() / "surface.vdb"))
                  .find("grid 'ls_thing' cannot be density, because it is a level set"),
              std::string::npos);
    EXPECT_NE(message(importGrid(folder() / "surface.vdb", {.density = "ls_thing",
                                                            .temperature = {},
                                                            .findTemperature = false,
                                                            .limits = {}}))
                  .find("is a level set"),
              std::string::npos);
    test::writeOpenVdb(folder() / "mixed.vdb", {surface, vectors, numbers});
    const std::string mixed = message(importGrid(folder() / "mixed.vdb"));
    EXPECT_NE(mixed.find("'ls_thing' (float, level set)"), std::string::npos) << mixed;
    EXPECT_NE(mixed.find("'density' (vec3s, fog volume)"), std::string::npos) << mixed;
    EXPECT_NE(mixed.find("'ids' (int32, fog volume)"), std::string::npos) << mixed;
    test::writeOpenVdb(folder() / "frustum.vdb", {frustum});
    EXPECT_NE(message(importGrid(folder() / "frustum.vdb")).find("frustum"), std::string::npos)
        << message(importGrid(folder() / "frustum.vdb"));
    test::writeOpenVdb(folder() / "two.vdb", {cloud("a"), cloud("b")});
    const std::string two = message(importGrid(folder() / "two.vdb"));
    EXPECT_NE(two.find("several grids that could be density, 'a' or 'b'; choose with --grid NAME"),
              std::string::npos)
        << two;
    EXPECT_NE(two.find("\"grid\": \"NAME\" in a scene file"), std::string::npos) << two;
    EXPECT_NE(
        message(
            importGrid(folder() / "two.vdb",
                       {.density = "c", .temperature = {}, .findTemperature = false, .limits = {}}))
            .find("has no grid 'c'; it has 'a'"),
        std::string::npos);
    test::writeOpenVdb(folder() / "none.vdb", {});
    EXPECT_NE(message(importGrid(folder() / "none.vdb")).find("no grids"), std::string::npos)
        << message(importGrid(folder() / "none.vdb"));
}

TEST(ImportGrid, RefusesLevelSetAndPointsOfTheSharedContent) {
    const std::string surface = message(importGrid(REQUIRE_CONTENT("vdb/sphere_levelset.vdb")));
    EXPECT_NE(surface.find("'ls_sphere'"), std::string::npos) << surface;
    EXPECT_NE(surface.find("level set"), std::string::npos) << surface;
    const std::string points = message(importGrid(REQUIRE_CONTENT("vdb/points_pointdata.vdb")));
    EXPECT_NE(points.find("'points'"), std::string::npos) << points;
    EXPECT_NE(points.find("holds points"), std::string::npos) << points;
}

TEST(ImportGrid, TemperatureOfTheSharedContentIsInKelvin) {
    const fs::path path = REQUIRE_CONTENT("vdb/derived_fire_multigrid.vdb");
    const Result<GridFile> file =
        importGrid(path, {.density = {}, .temperature = {}, .findTemperature = true, .limits = {}});
    ASSERT_TRUE(file.ok()) << file.message();
    EXPECT_EQ(file->densityName, "density");
    EXPECT_EQ(file->temperatureName, "temperature");
    EXPECT_NEAR(double(file->temperature->maximum), 2282, 1);
    expectSameVoxels(*file->temperature, VolumeOracle(path, "temperature"), 0);
}

TEST(ImportGrid, RefusesFilesThatAreNoVolumes) {
    std::ofstream(folder() / "text.vdb") << "This is no volume.";
    std::ofstream(folder() / "empty.vdb");
    EXPECT_NE(message(importGrid(folder() / "absent.vdb")).find("absent.vdb' does not exist"),
              std::string::npos);
    EXPECT_NE(message(importGrid(folder())).find("is not a file"), std::string::npos);
    EXPECT_NE(message(importGrid(folder() / "empty.vdb")).find("is empty"), std::string::npos);
    EXPECT_NE(
        message(importGrid(folder() / "text.vdb")).find("neither an OpenVDB nor a NanoVDB file"),
        std::string::npos);
}

TEST(ImportGrid, LimitsOfTimeAndSizeHold) {
    test::writeOpenVdb(folder() / "limits.vdb", {cloud()});
    GridRequest hurried;
    hurried.limits.seconds = 1e-4;
    EXPECT_NE(message(importGrid(folder() / "limits.vdb", hurried)).find("took more than"),
              std::string::npos);
    GridRequest small;
    small.limits.sampleBytes = 10000;
    EXPECT_NE(message(importGrid(folder() / "limits.vdb", small)).find("MiB allowed"),
              std::string::npos);
}

TEST(ImportGrid, AReaderThatIsMissingOrFoolishIsOneSentence) {
    test::writeOpenVdb(folder() / "fine.vdb", {cloud()});
    const auto withReader = [&](const std::string& reader) {
        ::setenv("TYNDALL_GRID_READER", reader.c_str(), 1);
        const std::string text = message(importGrid(folder() / "fine.vdb"));
        ::unsetenv("TYNDALL_GRID_READER");
        return text;
    };
    EXPECT_NE(withReader("/nowhere/reader").find("'/nowhere/reader', which is no program"),
              std::string::npos);
    EXPECT_NE(withReader("/bin/true").find("ended before it was done"), std::string::npos);
    const fs::path chatter = folder() / "chatter.sh";
    std::ofstream(chatter) << "#!/bin/sh\nyes nonsense >&0\n";
    fs::permissions(chatter, fs::perms::owner_all);
    EXPECT_NE(withReader(chatter.string()).find("lost its way"), std::string::npos);
    const fs::path killed = folder() / "killed.sh";
    std::ofstream(killed) << "#!/bin/sh\nkill -SEGV $$\n";
    fs::permissions(killed, fs::perms::owner_all);
    EXPECT_NE(withReader(killed.string()).find("reader crashed on it (signal 11)"),
              std::string::npos);
    EXPECT_EQ(message(importGrid(folder() / "fine.vdb")), "taken") << "and all is well again";
}

TEST(GridInfo, SaysWhatIsInAFile) {
    VolumeSpec spec = cloud("smoke"), vectors = cloud("v");
    spec.worldFromIndex = generalTransform();
    spec.type = VolumeSpec::Type::HalfStored;
    vectors.type = VolumeSpec::Type::Vector;
    vectors.gridClass = VolumeSpec::Class::Unknown;
    test::writeOpenVdb(folder() / "info.vdb", {spec, vectors});
    const Result<GridFileInfo> info = gridInfo(folder() / "info.vdb");
    ASSERT_TRUE(info.ok()) << info.message();
    EXPECT_EQ(info->format, "OpenVDB 224");
    ASSERT_EQ(info->grids.size(), 2u);
    const GridInfo& smoke = info->grids[0].name == "smoke" ? info->grids[0] : info->grids[1];
    EXPECT_EQ(smoke.type, "float (stored as half)");
    EXPECT_EQ(smoke.gridClass, "fog volume");
    EXPECT_EQ(smoke.activeVoxels, spec.voxels.size());
    EXPECT_EQ(smoke.first, ivec3(-10, -9, -10)); // 10² < 120 ≤ 11²
    EXPECT_EQ(smoke.last, ivec3(10, 9, 10));
    EXPECT_TRUE(smoke.affine && smoke.importable);
    for (int column = 0; column < 4; ++column)
        EXPECT_NEAR(glm::length(smoke.worldFromIndex[column] - spec.worldFromIndex[column]), 0,
                    1e-12);

    test::writeNanoVdb(folder() / "info.nvdb", spec, NanoType::FpN, NanoCodec::Zip);
    const Result<GridFileInfo> nano = gridInfo(folder() / "info.nvdb");
    ASSERT_TRUE(nano.ok()) << nano.message();
    EXPECT_EQ(nano->format, "NanoVDB 32.4.2");
    EXPECT_EQ(nano->grids.at(0).type, "FpN");
    EXPECT_EQ(nano->grids.at(0).activeVoxels, spec.voxels.size());
    EXPECT_EQ(nano->grids.at(0).last, ivec3(10, 9, 10));
}

TEST(GridInfo, ListsTheSharedContent) {
    const Result<GridFileInfo> fire = gridInfo(REQUIRE_CONTENT("vdb/derived_fire_multigrid.vdb"));
    ASSERT_TRUE(fire.ok());
    EXPECT_EQ(fire->grids.size(), 4u);
    const fs::path smokePath = REQUIRE_CONTENT("vdb/smoke1.vdb");
    const Result<GridFileInfo> smoke = gridInfo(smokePath);
    ASSERT_TRUE(smoke.ok());
    EXPECT_EQ(smoke->grids.at(0).activeVoxels, VolumeOracle(smokePath, "density").activeVoxels());
}

} // namespace
} // namespace tyndall
