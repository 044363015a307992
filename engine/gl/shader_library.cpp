#include "gl/shader_library.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "core/log.h"

namespace tyndall::gl {
namespace fs = std::filesystem;
namespace {

/// What tells one state of a source from another: a file's time and size, or the number of times that a text was added.
struct Stamp {
    int64_t time = 0;
    int64_t size = -1; // -1: there is no such file
    bool operator==(const Stamp&) const = default;
};

std::optional<std::string> readWholeFile(const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    if (!file) return std::nullopt;
    return std::string(std::istreambuf_iterator<char>(file), {});
}

/// A path that cannot leave the folder of shaders.
bool isInside(const std::string& path) {
    const fs::path relative(path);
    if (relative.is_absolute()) return false;
    for (const fs::path& part : relative)
        if (part == "..") return false;
    return true;
}

bool isFolder(const fs::path& path) {
    std::error_code error;
    return fs::is_directory(path, error);
}

fs::path folderFromEnvironment() {
    const char* folder = std::getenv("TYNDALL_SHADER_DIR");
    return folder != nullptr ? fs::path(folder) : fs::path();
}

/// Where sources come from: the folder, then what was added, then what is embedded.
class Sources {
public:
    Sources(std::span<const EmbeddedShader> embedded, fs::path folder)
        : folder_(std::move(folder)) {
        for (const EmbeddedShader& shader : embedded) embedded_[shader.path] = shader.text;
        if (!folder_.empty() && !isFolder(folder_))
            log::warningOnce(
                "shader folder " + folder_.string(),
                fmt::format("the shader folder '{}' does not exist: the built-in shaders are used",
                            folder_.string()));
    }

    [[nodiscard]] std::optional<std::string> read(const std::string& path) const {
        if (!isInside(path)) return std::nullopt;
        if (!folder_.empty())
            if (std::optional<std::string> text = readWholeFile(folder_ / path)) return text;
        if (const auto found = added_.find(path); found != added_.end()) return found->second.text;
        if (const auto found = embedded_.find(path); found != embedded_.end())
            return std::string(found->second);
        return std::nullopt;
    }

    [[nodiscard]] Stamp stamp(const std::string& path) const {
        if (!folder_.empty() && isInside(path)) {
            std::error_code error;
            const auto time = fs::last_write_time(folder_ / path, error);
            const auto size = error ? uintmax_t(0) : fs::file_size(folder_ / path, error);
            if (!error) return {time.time_since_epoch().count(), int64_t(size)};
        }
        if (const auto found = added_.find(path); found != added_.end())
            return {found->second.count, 0};
        return {0, embedded_.contains(path) ? 0 : -1};
    }

    void add(const std::string& path, std::string text) {
        Added& added = added_[path];
        added.text = std::move(text);
        ++added.count;
    }
    [[nodiscard]] bool wasAdded(const std::string& path) const { return added_.contains(path); }

private:
    struct Added {
        std::string text;
        int64_t count = 0;
    };
    fs::path folder_;
    std::map<std::string, Added> added_;
    std::map<std::string, const char*, std::less<>> embedded_;
};

} // namespace

struct ShaderLibrary::State {
    /// A program, the files that it was made from, and what went wrong with them last.
    struct Entry {
        ProgramRequest request;
        Program program; // the last good one
        PendingProgram pending;
        std::map<std::string, Stamp> files;
        std::string failure;
    };

    Sources sources;
    std::chrono::milliseconds pollInterval;
    std::chrono::steady_clock::time_point lastPoll{};
    std::map<std::string, Entry> entries; // by request.describe(); nodes stay where they are
    mutable std::optional<VariantList> variants;
    uint64_t generation = 0;

    State(std::span<const EmbeddedShader> embedded, fs::path folder,
          std::chrono::milliseconds interval)
        : sources(embedded, std::move(folder)), pollInterval(interval) {}

    /// Expands every stage, and notes files and times before they are read: a change in between is then seen as one.
    Result<std::vector<StageSource>> expand(Entry& entry) {
        std::vector<StageSource> stages;
        std::map<std::string, Stamp> files;
        const ReadShader read = [&](const std::string& path) {
            files.emplace(path, sources.stamp(path));
            return sources.read(path);
        };
        Result<std::vector<StageSource>> result = expandStages(entry.request, read);
        // After a failure the old files still count: the mistake may be mended where it was not made.
        if (!result) files.merge(entry.files);
        entry.files = std::move(files);
        return result;
    }

    static Result<std::vector<StageSource>> expandStages(const ProgramRequest& request,
                                                         const ReadShader& read) {
        std::vector<StageSource> stages;
        for (const std::string& file : request.files) {
            const Result<GLenum> stage = stageOfFile(file);
            if (!stage) return stage.error();
            Result<ExpandedShader> shader = expandShader(file, request.defines, read);
            if (!shader) return shader.error();
            stages.push_back({*stage, std::move(*shader)});
        }
        return stages;
    }

    void start(Entry& entry) {
        entry.failure.clear();
        const Result<std::vector<StageSource>> stages = expand(entry);
        if (stages)
            entry.pending = PendingProgram(entry.request.describe(), *stages);
        else
            entry.failure = stages.message();
    }

    /// True when the entry got a new program.
    bool finish(Entry& entry) {
        if (!entry.failure.empty()) return false;
        Result<Program> built = entry.pending.finish();
        if (!built) {
            entry.failure = built.message();
            return false;
        }
        entry.program = std::move(*built);
        if (!entry.program.warnings().empty())
            log::debug(
                fmt::format("shader '{}':\n{}", entry.program.name(), entry.program.warnings()));
        return true;
    }

    Entry& find(const ProgramRequest& request) {
        CHECK(!request.files.empty(), "a program needs a shader");
        const auto [at, isNew] = entries.try_emplace(request.describe());
        if (isNew) {
            at->second.request = request;
            start(at->second);
        }
        return at->second;
    }

    [[nodiscard]] bool changed(const Entry& entry) const {
        for (const auto& [path, stamp] : entry.files) {
            const Stamp now = sources.stamp(path);
            // Editors save by moving a new file into place: a file that is gone for a moment has not changed.
            if (now != stamp && now.size >= 0) return true;
        }
        return false;
    }

    /// True when the program was replaced.
    bool rebuild(const std::string& name, Entry& entry) {
        start(entry);
        if (finish(entry)) {
            ++generation;
            log::info(fmt::format("shader '{}' was made anew", name));
            return true;
        }
        log::warning(entry.program ? fmt::format("{}\nthe last good program stays", entry.failure)
                                   : entry.failure);
        return false;
    }
};

ShaderLibrary::ShaderLibrary(ShaderLibraryOptions options)
    : state_(std::make_unique<State>(options.embedded,
                                     options.folder.empty() ? folderFromEnvironment()
                                                            : std::move(options.folder),
                                     options.pollInterval)) {}
ShaderLibrary::~ShaderLibrary() = default;
ShaderLibrary::ShaderLibrary(ShaderLibrary&&) noexcept = default;
ShaderLibrary& ShaderLibrary::operator=(ShaderLibrary&&) noexcept = default;

void ShaderLibrary::addSource(const std::string& path, std::string text) {
    state_->sources.add(path, std::move(text));
}

Result<const Program*> ShaderLibrary::program(const ProgramRequest& request) {
    State::Entry& entry = state_->find(request);
    if (!entry.program && entry.failure.empty()) state_->finish(entry);
    if (!entry.program) return Error{entry.failure};
    return static_cast<const Program*>(&entry.program);
}

Result<const Program*> ShaderLibrary::compute(const std::string& path,
                                              std::vector<ShaderDefine> defines) {
    return program({{path}, std::move(defines)});
}

Result<const Program*> ShaderLibrary::raster(const std::string& vertex, const std::string& fragment,
                                             std::vector<ShaderDefine> defines) {
    return program({{vertex, fragment}, std::move(defines)});
}

bool ShaderLibrary::isListed(const ProgramRequest& request) const {
    for (const std::string& file : request.files)
        if (state_->sources.wasAdded(file)) return true;
    return variants().contains(request);
}

const VariantList& ShaderLibrary::variants() const {
    if (!state_->variants) {
        const std::optional<std::string> text = state_->sources.read("variants.txt");
        Result<VariantList> list = VariantList::parse(text.value_or(""), "variants.txt");
        CHECK(list.ok(), list.ok() ? "" : list.message());
        state_->variants = std::move(*list);
    }
    return *state_->variants;
}

int ShaderLibrary::pollChanges() {
    const auto now = std::chrono::steady_clock::now();
    if (now - state_->lastPoll < state_->pollInterval) return 0;
    state_->lastPoll = now;
    int replaced = 0;
    for (auto& [name, entry] : state_->entries)
        if (state_->changed(entry) && state_->rebuild(name, entry)) ++replaced;
    return replaced;
}

uint64_t ShaderLibrary::generation() const { return state_->generation; }

std::vector<std::string> ShaderLibrary::failures() const {
    std::vector<std::string> messages;
    for (const auto& [name, entry] : state_->entries)
        if (!entry.failure.empty()) messages.push_back(entry.failure);
    return messages;
}

size_t ShaderLibrary::programCount() const { return state_->entries.size(); }

} // namespace tyndall::gl
