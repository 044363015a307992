#pragma once
// Edits as commands: each knows the state before and after, so undoing is as exact as doing.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/settings.h"
#include "scene/scene.h"

namespace tyndall::editor {

/// What commands change.
struct EditTarget {
    Scene& scene;
    SettingsRegistry& settings;
};

class Command {
public:
    virtual ~Command() = default;
    /// For the menu: "hide 'sun'".
    [[nodiscard]] virtual std::string name() const = 0;
    virtual void apply(EditTarget target) const = 0;
    virtual void revert(EditTarget target) const = 0;
    /// Takes over the end of `next` when both are steps of one drag. False: they are separate edits.
    virtual bool absorb(const Command& next) = 0;
    /// Does it change what a scene file holds?
    [[nodiscard]] virtual bool changesScene() const { return true; }
};

using CommandPtr = std::unique_ptr<Command>;

CommandPtr changeVisibility(const Scene& scene, int node, bool visible);
/// Replaces any matrix of the node.
CommandPtr changeTransform(const Scene& scene, int node, const dvec3& translation,
                           const dquat& rotation, const dvec3& scale);
CommandPtr changeLight(const Scene& scene, int light, Light after);
CommandPtr changeMedium(const Scene& scene, int medium, Medium after);
/// In stops.
CommandPtr changeExposure(const Scene& scene, float ev100);
/// Assignments KEY, TEXT that the registry accepts; `what` names the edit.
CommandPtr changeSettings(const SettingsRegistry& settings, std::string what,
                          const std::vector<std::pair<std::string, std::string>>& assignments);

/// Done and undone commands, in order.
class History {
public:
    explicit History(EditTarget target) : target_(target) {}

    /// Applies the command; what was undone is forgotten. Until seal(), steps of one kind on one thing become one edit.
    void perform(CommandPtr command);
    /// The mouse was released: the next command is an edit of its own.
    void seal() { open_ = false; }
    void undo();
    void redo();
    /// Name of what undo() and redo() would do; empty when there is nothing.
    [[nodiscard]] std::string undoName() const;
    [[nodiscard]] std::string redoName() const;
    /// The scene is in its file now.
    void markSaved() { saved_ = position_; }
    /// Does the scene differ from its file?
    [[nodiscard]] bool hasUnsavedEdits() const;

private:
    EditTarget target_;
    std::vector<CommandPtr> commands_;
    size_t position_ = 0; // commands before it are done
    size_t saved_ = 0;    // position at the last save; kLost where no undo leads back to it
    bool open_ = false;   // may the last command absorb the next?
    static constexpr size_t kLost = size_t(-1);
};

} // namespace tyndall::editor
