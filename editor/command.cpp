#include "command.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "scene/scene_edit.h"

namespace tyndall::editor {
namespace {

std::string quotedName(const std::string& name, const char* otherwise) {
    return name.empty() ? otherwise : "'" + name + "'";
}

class ChangeVisibility final : public Command {
public:
    ChangeVisibility(const Scene& scene, int node, bool visible)
        : node_(node), before_(scene.nodes.at(size_t(node)).visible), after_(visible),
          what_(quotedName(scene.nodes[size_t(node)].name, "a node")) {}
    [[nodiscard]] std::string name() const override { return (after_ ? "show " : "hide ") + what_; }
    void apply(EditTarget target) const override { setNodeVisible(target.scene, node_, after_); }
    void revert(EditTarget target) const override { setNodeVisible(target.scene, node_, before_); }
    bool absorb(const Command&) override { return false; }

private:
    int node_;
    bool before_, after_;
    std::string what_;
};

/// The local transform as a node holds it.
struct Transform {
    dvec3 translation{0}, scale{1};
    dquat rotation{1, 0, 0, 0};
    std::optional<dmat4> matrix;
};

class ChangeTransform final : public Command {
public:
    ChangeTransform(const Scene& scene, int node, Transform after)
        : node_(node), after_(std::move(after)) {
        const Node& n = scene.nodes.at(size_t(node));
        before_ = {n.translation, n.scale, n.rotation, n.matrix};
        what_ = quotedName(n.name, "a node");
    }
    [[nodiscard]] std::string name() const override { return "move " + what_; }
    void apply(EditTarget target) const override { set(target.scene, after_); }
    void revert(EditTarget target) const override { set(target.scene, before_); }
    bool absorb(const Command& next) override {
        const auto* step = dynamic_cast<const ChangeTransform*>(&next);
        if (!step || step->node_ != node_) return false;
        after_ = step->after_;
        return true;
    }

private:
    void set(Scene& scene, const Transform& transform) const {
        setNodeTransform(scene, node_, transform.translation, transform.rotation, transform.scale);
        if (transform.matrix) setNodeMatrix(scene, node_, *transform.matrix);
    }
    int node_;
    Transform before_, after_;
    std::string what_;
};

/// A light or a medium, replaced as a whole.
template <typename T> class Replace final : public Command {
public:
    using Set = void (*)(Scene&, int, T);
    Replace(Set set, int index, T before, T after, const char* kind)
        : set_(set), index_(index), before_(std::move(before)), after_(std::move(after)),
          what_(fmt::format("change {}", quotedName(before_.name, kind))) {}
    [[nodiscard]] std::string name() const override { return what_; }
    void apply(EditTarget target) const override { set_(target.scene, index_, after_); }
    void revert(EditTarget target) const override { set_(target.scene, index_, before_); }
    bool absorb(const Command& next) override {
        const auto* step = dynamic_cast<const Replace*>(&next);
        if (!step || step->index_ != index_) return false;
        after_ = step->after_;
        return true;
    }

private:
    Set set_;
    int index_;
    T before_, after_;
    std::string what_;
};

class ChangeExposure final : public Command {
public:
    ChangeExposure(float before, float after) : before_(before), after_(after) {}
    [[nodiscard]] std::string name() const override { return "change the exposure"; }
    void apply(EditTarget target) const override { target.scene.ev100 = after_; }
    void revert(EditTarget target) const override { target.scene.ev100 = before_; }
    bool absorb(const Command& next) override {
        const auto* step = dynamic_cast<const ChangeExposure*>(&next);
        if (step) after_ = step->after_;
        return step != nullptr;
    }

private:
    float before_, after_; // EV100
};

class ChangeSettings final : public Command {
public:
    struct Change {
        std::string key, before, after;
    };
    ChangeSettings(std::string what, std::vector<Change> changes)
        : what_(std::move(what)), changes_(std::move(changes)) {}
    [[nodiscard]] std::string name() const override { return what_; }
    void apply(EditTarget target) const override {
        for (const Change& change : changes_) set(target.settings, change.key, change.after);
    }
    void revert(EditTarget target) const override {
        for (auto change = changes_.rbegin(); change != changes_.rend(); ++change)
            set(target.settings, change->key, change->before);
    }
    bool absorb(const Command& next) override {
        const auto* step = dynamic_cast<const ChangeSettings*>(&next);
        if (!step || changes_.size() != 1 || step->changes_.size() != 1 ||
            step->changes_[0].key != changes_[0].key)
            return false;
        changes_[0].after = step->changes_[0].after;
        return true;
    }
    [[nodiscard]] bool changesScene() const override { return false; }

private:
    static void set(SettingsRegistry& settings, const std::string& key, const std::string& text) {
        const Result<void> done = settings.set(key, text);
        CHECK(done.ok(), done.ok() ? std::string() : done.message());
    }
    std::string what_;
    std::vector<Change> changes_;
};

} // namespace

CommandPtr changeVisibility(const Scene& scene, int node, bool visible) {
    return std::make_unique<ChangeVisibility>(scene, node, visible);
}

CommandPtr changeTransform(const Scene& scene, int node, const dvec3& translation,
                           const dquat& rotation, const dvec3& scale) {
    return std::make_unique<ChangeTransform>(scene, node,
                                             Transform{translation, scale, rotation, std::nullopt});
}

CommandPtr changeLight(const Scene& scene, int light, Light after) {
    return std::make_unique<Replace<Light>>(&setLight, light, scene.lights.at(size_t(light)),
                                            std::move(after), "a light");
}

CommandPtr changeMedium(const Scene& scene, int medium, Medium after) {
    return std::make_unique<Replace<Medium>>(&setMedium, medium, scene.media.at(size_t(medium)),
                                             std::move(after), "a medium");
}

CommandPtr changeExposure(const Scene& scene, float ev100) {
    return std::make_unique<ChangeExposure>(scene.ev100, ev100);
}

CommandPtr changeSettings(const SettingsRegistry& settings, std::string what,
                          const std::vector<std::pair<std::string, std::string>>& assignments) {
    std::vector<ChangeSettings::Change> changes;
    for (const auto& [key, text] : assignments)
        changes.push_back({key, settings.get(key).value(), text});
    return std::make_unique<ChangeSettings>(std::move(what), std::move(changes));
}

void History::perform(CommandPtr command) {
    if (saved_ != kLost && saved_ > position_) saved_ = kLost;
    commands_.resize(position_);
    command->apply(target_);
    if (open_ && position_ > 0 && position_ != saved_ && commands_.back()->absorb(*command)) return;
    commands_.push_back(std::move(command));
    ++position_;
    open_ = true;
}

void History::undo() {
    if (position_ == 0) return;
    commands_[--position_]->revert(target_);
    open_ = false;
}

void History::redo() {
    if (position_ == commands_.size()) return;
    commands_[position_++]->apply(target_);
    open_ = false;
}

std::string History::undoName() const {
    return position_ > 0 ? commands_[position_ - 1]->name() : "";
}
std::string History::redoName() const {
    return position_ < commands_.size() ? commands_[position_]->name() : "";
}

bool History::hasUnsavedEdits() const {
    if (saved_ == kLost) return true;
    for (size_t i = std::min(saved_, position_); i < std::max(saved_, position_); ++i)
        if (commands_[i]->changesScene()) return true;
    return false;
}

} // namespace tyndall::editor
