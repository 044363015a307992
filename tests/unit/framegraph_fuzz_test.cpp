// Random sequences of frames, run twice: on simulated storage, where passes are skipped, cached, culled and share memory as the
// compiled graph says, and as pure functions of their inputs. Whatever a running pass reads must be what the functions say.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "framegraph/dump.h"
#include "framegraph/hash.h"
#include "framegraph/storage_place.h"
#include "framegraph_null_executor.h"
#include "support/content.h"

namespace tyndall::fg {
namespace {

constexpr uint64_t kNothing = 77;  // what absent and fresh resources hold
constexpr uint64_t kGarbage = 666; // what new storage holds
constexpr int kImports = 2, kPersistents = 2;
const TextureDesc kShapes[] = {texture2D(Format::R32F, 4, 4), texture2D(Format::RGBA16F, 8, 8)};

struct Data {
    int unused;
};

class Fuzz {
public:
    explicit Fuzz(uint64_t seed) : state_(seed) {}

    void frame() {
        executor_.beginFrame();
        ideal_.clear();
        drawScene();
        executor_.compile();
        ASSERT_TRUE(executor_.compiled.errors.empty()) << executor_.compiled.errors[0];
        simulate();
        executor_.persistent.commit(executor_.compiled);
    }
    void print() const { std::printf("%s", dump(executor_.compiled, DumpFormat::Text).c_str()); }
    int ran = 0, cached = 0, skipped = 0, culled = 0;

private:
    uint64_t random(uint64_t n) { return (state_ = mixHash(state_, 1)) % n; }
    FrameGraphImpl& graph() { return executor_.graph; }

    /// The structure follows from a few numbers that change now and then, as settings do.
    void drawScene() {
        if (random(6) == 0) shape_ = random(1000);
        for (uint64_t& key : keys_)
            if (random(8) == 0) key = random(3);
        for (uint64_t& version : importVersions_)
            if (random(5) == 0) version = random(4);
        if (random(25) == 0)
            executor_.persistent.resetHistory(), pastOfHistory_ = kNothing,
                                                 persistents_ = {kNothing, kNothing};
        Fuzz structure(shape_);
        available_.clear();
        overwritten_.clear();
        addOutside();
        const uint64_t passes = 3 + structure.random(12);
        for (uint64_t i = 0; i < passes; ++i) addPass(i, structure);
        if (structure.random(2) == 0) addHistoryPass();
        for (const TextureHandle handle : available_)
            if (!overwritten_.contains(handle.resource * 1000 + handle.version) && random(3) == 0)
                graph().markOutput(handle);
    }

    void addOutside() {
        for (uint32_t i = 0; i < kImports; ++i) {
            const TextureHandle handle = graph().importTexture("import", StaticTexture{i + 1},
                                                               kShapes[0], importVersions_[i]);
            ideal_[graph().versionOf(handle.resource, 0)] = mixHash(i, importVersions_[i]);
            statics_[i + 1] = mixHash(i, importVersions_[i]);
            available_.push_back(handle);
        }
        for (uint32_t i = 0; i < kPersistents; ++i) {
            const PersistentTexture p = graph().persistentTexture(i == 0 ? "p0" : "p1", kShapes[0]);
            EXPECT_EQ(p.wasReset, persistents_[i] == kNothing);
            ideal_[graph().versionOf(p.handle.resource, 0)] = persistents_[i];
            available_.push_back(p.handle);
        }
        history_ = graph().historyTexture("history", kShapes[0]);
        EXPECT_EQ(history_.wasReset, pastOfHistory_ == kNothing);
        ideal_[graph().versionOf(history_.previous.resource, 0)] = pastOfHistory_;
        ideal_[graph().versionOf(history_.current.resource, 0)] = pastOfHistory_;
        available_.push_back(history_.previous);
    }

    [[nodiscard]] bool isOutside(TextureHandle handle) {
        const ResourceOrigin origin = graph().resources()[handle.resource].origin;
        return origin == ResourceOrigin::Imported || origin == ResourceOrigin::HistoryPrevious;
    }
    uint64_t idealOf(TextureHandle handle) {
        const uint32_t version =
            graph().contentVersion(graph().versionOf(handle.resource, handle.version));
        return graph().versions()[version].absent ? kNothing : ideal_[version];
    }
    TextureHandle pick(Fuzz& structure) {
        TextureHandle handle;
        do handle = available_[structure.random(available_.size())];
        while (overwritten_.contains(handle.resource * 1000 + handle.version));
        return handle;
    }

    /// A pass that reads up to two textures, creates one or writes over one, and may be cached or skipped.
    void addPass(uint64_t index, Fuzz& structure) {
        const std::string name = "pass" + std::to_string(index);
        const bool cacheable = structure.random(2) == 0, sideEffect = structure.random(8) == 0,
                   creates = structure.random(3) != 0;
        const TextureDesc shape = kShapes[structure.random(2)];
        const uint64_t reads = structure.random(3);
        const bool skip = (keys_[index % 4] + index) % 5 == 0;
        TextureHandle out, over;
        uint64_t content = mixHash(hashName(name), cacheable ? keys_[index % 4] : random(1u << 30));
        graph().addPass<Data>(
            name.c_str(),
            [&](Builder& b, Data&) {
                std::vector<TextureHandle> in;
                for (uint64_t i = 0; i < reads; ++i) in.push_back(pick(structure));
                for (const TextureHandle handle : in)
                    content = mixHash(content, idealOf(b.read(handle)));
                if (!creates) over = pick(structure);
                if (!creates && isOutside(over)) over = {};
                // A cached pass may not depend on old content from outside the frame that it does not read.
                if (over &&
                    graph().versions()[graph().versionOf(over.resource, over.version)].writer ==
                        kNoIndex &&
                    cacheable)
                    content = mixHash(content, 5);
                else if (over)
                    content = mixHash(content, idealOf(over));
                out = over ? b.write(over) : b.create((name + ".out").c_str(), shape);
                if (cacheable) b.cacheBy(keys_[index % 4]);
                if (sideEffect) b.sideEffect();
                if (skip) b.skip("drawn so");
            },
            [](const Data&, PassContext&) {});
        const uint32_t version = graph().versionOf(out.resource, out.version);
        if (!skip) ideal_[version] = content;
        if (over) overwritten_.insert(over.resource * 1000 + over.version);
        available_.push_back(out);
    }

    void addHistoryPass() {
        TextureHandle out;
        const bool skip = random(4) == 0;
        graph().addPass<Data>(
            "history.update",
            [&](Builder& b, Data&) {
                b.read(history_.previous);
                out = b.write(history_.current);
                if (skip) b.skip("drawn so");
                b.sideEffect();
            },
            [](const Data&, PassContext&) {});
        if (!skip)
            ideal_[graph().versionOf(out.resource, out.version)] = mixHash(pastOfHistory_, 1);
        available_.push_back(out);
    }

    uint64_t& storageAt(StoragePlace place) {
        const PersistentEntry* entry = place.kind == PlaceKind::Persistent
                                           ? &executor_.persistent.entry(place.index / 2)
                                           : nullptr;
        if (place.kind == PlaceKind::Slot) return slots_[place.index];
        if (place.kind == PlaceKind::Static) return statics_[place.index];
        return persistentStorage_
            .try_emplace({place.index, entry ? entry->generation : 0}, kGarbage)
            .first->second;
    }
    uint64_t contentOf(uint32_t resource, uint32_t number) {
        const StoragePlace place = placeOf(graph(), executor_.compiled, resource, number);
        return place.kind == PlaceKind::Absent ? kNothing : storageAt(place);
    }

    void simulate() {
        const CompiledGraph& compiled = executor_.compiled;
        slots_.assign(compiled.slots.size(), kGarbage);
        for (const uint32_t index : compiled.list(compiled.untouchedOutputs))
            storageAt(placeOf(compiled, index)) = kNothing;
        for (uint32_t i = 0; i < compiled.passes.size(); ++i) {
            const CompiledPass& pass = compiled.passes[i];
            ran += pass.status == PassStatus::Ran;
            cached += pass.status == PassStatus::Cached;
            skipped += pass.status == PassStatus::Skipped;
            culled += pass.status == PassStatus::Culled;
            if (pass.status == PassStatus::Ran) simulatePass(pass);
        }
        for (const uint32_t output : graph().outputs()) expectIdeal(output, "an output");
        for (uint32_t i = 1; i < compiled.resources.size(); ++i) {
            const CompiledResource& resource = compiled.resources[i];
            if (!resource.written) continue;
            uint64_t& past = resource.name == "p0"   ? persistents_[0]
                             : resource.name == "p1" ? persistents_[1]
                                                     : pastOfHistory_;
            if (resource.origin == ResourceOrigin::Persistent ||
                resource.origin == ResourceOrigin::HistoryCurrent)
                past = storageAt(placeOf(compiled, i));
        }
    }

    void simulatePass(const CompiledPass& pass) {
        const CompiledGraph& compiled = executor_.compiled;
        for (const uint32_t index : compiled.list(pass.acquires)) {
            const uint32_t held = compiled.resources[index].aliasOf != kNoIndex
                                      ? compiled.resources[index].aliasOf
                                      : index;
            const bool fresh = compiled.resources[held].origin == ResourceOrigin::Transient;
            if (fresh) storageAt(placeOf(compiled, held)) = kGarbage;
            if (compiled.resources[held].clearFirst) storageAt(placeOf(compiled, held)) = kNothing;
        }
        const auto& uses = graph().uses();
        for (uint32_t k = pass.uses.first; k < pass.uses.first + pass.uses.count; ++k) {
            const VersionRecord& version = graph().versions()[uses[k].version];
            if (!isWrite(uses[k].access))
                expectIdeal(uses[k].version, pass.name);
            else if (version.previous != kNoIndex &&
                     graph().resources()[version.resource].origin != ResourceOrigin::HistoryCurrent)
                expectOldContent(version, pass.name);
        }
        for (uint32_t k = pass.uses.first; k < pass.uses.first + pass.uses.count; ++k)
            if (isWrite(uses[k].access))
                storageAt(placeOf(compiled, graph().versions()[uses[k].version].resource)) =
                    ideal_[uses[k].version];
    }

    void expectIdeal(uint32_t version, std::string_view who) {
        const VersionRecord& record = graph().versions()[version];
        const std::string_view name = graph().resources()[record.resource].name;
        EXPECT_EQ(contentOf(record.resource, record.number),
                  idealOf({record.resource, record.number}))
            << who << " reads version " << record.number << " of " << name;
    }
    /// What shows through a write: the version before, or nothing where that was absent.
    void expectOldContent(const VersionRecord& version, std::string_view who) {
        const VersionRecord& before = graph().versions()[version.previous];
        EXPECT_EQ(storageAt(placeOf(executor_.compiled, version.resource)),
                  idealOf({before.resource, before.number}))
            << who << " writes over version " << before.number << " of "
            << graph().resources()[before.resource].name;
    }

    NullExecutor executor_;
    uint64_t state_, shape_ = 1;
    std::array<uint64_t, 4> keys_{};
    std::array<uint64_t, kImports> importVersions_{};
    std::array<uint64_t, kPersistents> persistents_{kNothing, kNothing};
    uint64_t pastOfHistory_ = kNothing;
    TextureHistory history_{};
    std::vector<TextureHandle> available_;
    std::set<uint32_t> overwritten_;     // resource · 1000 + version
    std::map<uint32_t, uint64_t> ideal_; // by version index
    std::vector<uint64_t> slots_;
    std::map<uint32_t, uint64_t> statics_;
    std::map<std::pair<uint32_t, uint32_t>, uint64_t> persistentStorage_;
};

TEST(FrameGraphFuzz, RunningPassesReadWhatPureFunctionsSay) {
    int ran = 0, cached = 0, skipped = 0, culled = 0;
    for (uint64_t trial = 0; trial < 40; ++trial) {
        const uint64_t seed = mixHash(test::seed(), trial);
        Fuzz fuzz(seed);
        for (int frame = 0; frame < 60; ++frame) {
            SCOPED_TRACE("TYNDALL_SEED=" + std::to_string(test::seed()) + ", trial " +
                         std::to_string(trial) + ", frame " + std::to_string(frame));
            fuzz.frame();
            if (::testing::Test::HasFailure()) return fuzz.print();
        }
        ran += fuzz.ran, cached += fuzz.cached, skipped += fuzz.skipped, culled += fuzz.culled;
    }
    std::printf("%d passes ran, %d were cached, %d skipped, %d culled\n", ran, cached, skipped,
                culled);
    for (const int count : {ran, cached, skipped, culled})
        EXPECT_GT(count, 500) << "every status must occur often";
}

} // namespace
} // namespace tyndall::fg
