// The arrows between rooms as ARCHITECTURE.md draws them: what a room's sources can include, and what CMake refuses.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/content.h"

namespace tyndall::test {
namespace {
namespace fs = std::filesystem;

/// Folder of a room → those whose public headers it sees, beside its own.
const std::map<std::string, std::set<std::string>> kArrows = {
    {"core", {}},
    {"media", {"core"}},
    {"scene", {"core", "media"}},
    {"transport", {"core"}},
    {"framegraph", {"core"}},
    {"gl", {"core"}},
    {"framegraph/gl", {"core", "framegraph", "gl"}},
    {"tracing", {"core", "media", "scene", "transport"}},
    {"reference", {"core", "media", "scene", "transport", "tracing"}},
    {"plugin", {"core", "transport", "framegraph"}},
    {"app",
     {"core", "media", "scene", "transport", "framegraph", "framegraph/gl", "gl", "plugin", "renderer",
      "tracing", "reference"}},
    {"renderer",
     {"core", "media", "scene", "transport", "framegraph", "framegraph/gl", "gl", "plugin"}},
};
/// A header of each that others include.
const std::map<std::string, std::string> kPublic = {
    {"core", "core/result.h"},
    {"media", "media/medium.h"},
    {"scene", "scene/scene.h"},
    {"transport", "transport/plan.h"},
    {"framegraph", "framegraph/frame_graph.h"},
    {"gl", "gl/context.h"},
    {"framegraph/gl", "framegraph/gl/executor.h"},
    {"tracing", "tracing/ray.h"},
    {"reference", "reference/render.h"},
    {"plugin", "plugin/plugin_api.h"},
    {"renderer", "renderer/renderer.h"},
    {"app", "app/render_session.h"},
};

/// Compiler and flags of a source file, up to the file itself.
std::string commandFor(const std::string& source) {
    std::ifstream file(binDir().parent_path() / "compile_commands.json");
    const nlohmann::json commands = nlohmann::json::parse(file);
    for (const auto& entry : commands) {
        if (entry.at("file") != (sourceDir() / source).string()) continue;
        std::istringstream words(entry.at("command").get<std::string>());
        std::string command = "cd " + entry.at("directory").get<std::string>() + " &&";
        for (std::string word; words >> word;) {
            if (word.ends_with("ccache")) continue;
            if (word == "-MD" || word == "-c" || word == source) continue;
            if (word == "-o" || word == "-MT" || word == "-MF" || word == "-c") {
                words >> word;
                continue;
            }
            if (word.ends_with(".cpp")) continue;
            command += " " + word;
        }
        return command;
    }
    throw std::runtime_error("no command compiles " + source);
}

/// Does a line that includes the header compile as part of that source's target?
bool compiles(const std::string& command, const std::string& header) {
    const std::string run = "echo '#include \"" + header + "\"' | (" + command +
                            " -fsyntax-only -x c++ -) >/dev/null 2>&1";
    return std::system(run.c_str()) == 0;
}

/// Folders of its -I and -isystem flags.
std::vector<fs::path> foldersOf(const std::string& command) {
    std::vector<fs::path> folders;
    std::istringstream words(command);
    for (std::string word; words >> word;)
        if (word.starts_with("-I")) folders.emplace_back(word.substr(2));
    return folders;
}

bool sees(const std::vector<fs::path>& folders, const std::string& header) {
    return std::any_of(folders.begin(), folders.end(),
                       [&](const fs::path& folder) { return fs::exists(folder / header); });
}

const std::map<std::string, std::string> kSources = {
    {"core", "engine/core/log.cpp"},
    {"media", "engine/media/blackbody.cpp"},
    {"scene", "engine/scene/scene.cpp"},
    {"transport", "engine/transport/plan.cpp"},
    {"framegraph", "engine/framegraph/access.cpp"},
    {"gl", "engine/gl/buffer.cpp"},
    {"framegraph/gl", "engine/framegraph/gl/executor.cpp"},
    {"tracing", "engine/tracing/bsdf.cpp"},
    {"reference", "engine/reference/film.cpp"},
    {"plugin", "engine/plugin/registry.cpp"},
    {"renderer", "engine/renderer/frame.cpp"},
    {"app", "engine/app/job.cpp"},
};

TEST(Rooms, EachSeesThePublicHeadersOfWhatItsArrowsLeadToAndNoOthers) {
    for (const auto& [room, friends] : kArrows) {
        const std::vector<fs::path> folders = foldersOf(commandFor(kSources.at(room)));
        for (const auto& [other, header] : kPublic)
            EXPECT_EQ(sees(folders, header), other == room || friends.count(other) > 0)
                << room << " and " << header;
    }
}

TEST(Rooms, PrivateHeadersAreForTheirRoomAlone) {
    const std::pair<std::string, std::string> kPrivate[] = {
        {"renderer", "renderer/renderer_impl.h"},
        {"core", "core/separable_filter.h"},
        {"scene", "scene/gltf_model.h"},
        {"gl", "gl/context_state.h"},
    };
    for (const auto& [room, header] : kPrivate)
        for (const auto& [other, source] : kSources)
            EXPECT_EQ(sees(foldersOf(commandFor(source)), header), other == room)
                << other << " and " << header;
}

TEST(Rooms, ASourceThatIncludesTheWrongWayDoesNotCompile) {
    const std::string core = commandFor("engine/core/log.cpp");
    EXPECT_TRUE(compiles(core, "core/result.h"));
    EXPECT_FALSE(compiles(core, "scene/scene.h"));
    const std::string technique = commandFor("plugins/volumetric_gi/plugin.cpp");
    EXPECT_TRUE(compiles(technique, "tracing/ray.h"));
    EXPECT_FALSE(compiles(technique, "reference/render.h")) << "no technique from its yardstick";
    EXPECT_FALSE(compiles(technique, "renderer/renderer.h"));
    EXPECT_FALSE(compiles(technique, "gl/context.h"));
}

/// Runs a line of CMake in which cmake/rooms.cmake is known; its exit status.
int configure(const std::string& line) {
    const fs::path script = fs::path(::testing::TempDir()) / "rooms_test.cmake";
    std::ofstream(script) << "cmake_minimum_required(VERSION 3.25)\ninclude(" << (sourceDir() / "cmake/rooms.cmake").string() << ")\n"
                          << line << "\n";
    return std::system(("cmake -P " + script.string() + " >/dev/null 2>&1").c_str());
}

TEST(Rooms, CMakeRefusesALinkAgainstTheArrows) {
    EXPECT_EQ(configure("tyndall_check_arrows(scene Tyndall::media fmt::fmt)"), 0);
    EXPECT_NE(configure("tyndall_check_arrows(media Tyndall::scene)"), 0);
    EXPECT_NE(configure("tyndall_check_arrows(core Tyndall::media)"), 0);
    EXPECT_NE(configure("tyndall_check_arrows(plugin_any Tyndall::reference)"), 0);
    EXPECT_NE(configure("tyndall_check_arrows(tracing Tyndall::reference)"), 0);
    EXPECT_NE(configure("tyndall_check_arrows(reference Tyndall::renderer)"), 0);
}

} // namespace
} // namespace tyndall::test
