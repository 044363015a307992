#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include "panes/panes.h"
#include "widgets.h"

namespace tyndall::editor {
namespace {

void label(const char* name, const std::string& help) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    text(name);
    tooltip(help);
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-1);
    ImGui::PushID(name);
}

/// A table of names and values, in which the names take what they need.
bool beginFields(const char* id) {
    if (!ImGui::BeginTable(id, 2)) return false;
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed,
                            ImGui::CalcTextSize("Absorption ").x);
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
    return true;
}

/// Of a position, an angle or a scale: shown with so many decimals.
bool dragPoint(Session& session, const char* name, const std::string& help, dvec3& value,
               float speed, int decimals) {
    label(name, help);
    dvec3 shown = value;
    for (int axis = 0; axis < 3; ++axis) shown[axis] = withoutNegativeZero(value[axis], decimals);
    const dvec3 before = shown;
    const std::string format = fmt::format("%.{}f", decimals);
    const bool changed = dragNumbers(session.panes.typed, glm::value_ptr(shown), 3,
                                     {.speed = speed, .format = format.c_str()});
    for (int axis = 0; axis < 3; ++axis)
        if (shown[axis] != before[axis]) value[axis] = shown[axis];
    ImGui::PopID();
    return changed;
}

constexpr ImGuiSliderFlags kByRatio =
    ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat;

/// Dragged by ratio, since lights and media span decades.
bool dragNumber(Session& session, const char* name, const std::string& help, float& value,
                double least, double most, const char* format) {
    label(name, help);
    const float speed = std::max(std::abs(value), 1e-4f) / 100;
    const bool changed =
        dragNumbers(session.panes.typed, &value, 1, {speed, least, most, format, kByRatio});
    ImGui::PopID();
    return changed;
}

bool dragColor(Session& session, const char* name, const std::string& help, vec3& value,
               const char* format) {
    label(name, help);
    const float speed = std::max(maximumOf(value), 1e-3f) / 100;
    const bool changed = dragNumbers(session.panes.typed, glm::value_ptr(value), 3,
                                     {speed, 0, 1e9, format, kByRatio});
    ImGui::PopID();
    return changed;
}

void drawTransform(Session& session, int index) {
    const Node& node = session.scene().nodes[size_t(index)];
    if (node.matrix) {
        coloredText(kGrey, "Placed by a matrix");
        tooltip(
            "The file gives this node a matrix instead of translation, rotation and scale; it is kept as it is.");
        return;
    }
    if (!beginFields("transform")) return;
    dvec3 translation = node.translation, scale = node.scale;
    dvec3 turned = session.panes.angles.of(index, node.rotation);
    const double size =
        std::max({std::abs(translation.x), std::abs(translation.y), std::abs(translation.z), 1.0});
    bool changed = dragPoint(session, "Position", "Metres, in the space of the node above",
                             translation, float(size * 0.005), 3);
    dquat rotation = node.rotation;
    if (dragPoint(session, "Rotation", "Degrees about X, then Y, then Z", turned, 0.25f, 2)) {
        rotation = session.panes.angles.set(index, turned);
        changed = true;
    }
    changed |= dragPoint(session, "Scale", "Factor along each axis", scale, 0.005f, 3);
    if (changed)
        session.edit(changeTransform(session.scene(), index, translation, rotation, scale));
    ImGui::EndTable();
}

void drawLight(Session& session, int index) {
    static constexpr const char* kTypes[] = {"Directional light", "Point light", "Spot light",
                                             "Rect light"};
    Light light = session.scene().lights[size_t(index)];
    ImGui::Separator();
    text(kTypes[int(light.type)]);
    if (!beginFields("light")) return;
    bool changed = false;
    if (light.type == LightType::Rect) {
        changed |= dragColor(session, "Radiance", "Nits that leave it, red, green and blue",
                             light.radiance, "%.4g");
    } else {
        changed |=
            dragColor(session, "Colour", "Linear, multiplies the intensity", light.color, "%.3f");
        const bool sun = light.type == LightType::Directional;
        changed |=
            dragNumber(session, "Intensity", sun ? "Lux on a surface that faces it" : "Candela",
                       light.intensity, 0, 1e12f, sun ? "%.4g lx" : "%.4g cd");
        changed |= dragNumber(session, "Radius",
                              sun ? "Angular radius, for soft shadows"
                                  : "Of the glowing sphere, for soft shadows",
                              light.radius, 0, sun ? 1.5f : 1e6f, sun ? "%.4f rad" : "%.3f m");
    }
    label("Shadows", "Does it cast shadows?");
    changed |= ImGui::Checkbox("##value", &light.castsShadows);
    ImGui::PopID();
    ImGui::EndTable();
    if (changed) session.edit(changeLight(session.scene(), index, light));
}

void drawMedium(Session& session, int index) {
    static constexpr const char* kKinds[] = {"Medium everywhere",      "Medium in a box",
                                             "Medium in an ellipsoid", "Height fog",
                                             "Medium from a grid",     "Medium from particles"};
    Medium medium = session.scene().media[size_t(index)];
    ImGui::Separator();
    text(kKinds[int(medium.kind)]);
    if (!medium.file.empty())
        coloredText(kGrey, medium.file +
                               (medium.gridName.empty() ? "" : ", grid '" + medium.gridName + "'"));
    if (!beginFields("medium")) return;
    bool changed =
        dragColor(session, "Scattering", "Per metre, red, green and blue; a grid multiplies it",
                  medium.scattering, "%.4g");
    changed |=
        dragColor(session, "Absorption", "Per metre, red, green and blue; a grid multiplies it",
                  medium.absorption, "%.4g");
    label("Anisotropy",
          "Mean cosine of scattering: positive goes on forwards, negative is thrown back");
    const float before = medium.anisotropy;
    const bool slid = ImGui::SliderFloat("##value", &medium.anisotropy, -0.95f, 0.95f, "%.2f",
                                         ImGuiSliderFlags_AlwaysClamp);
    changed |= takeNumber(session.panes.typed, slid, before, medium.anisotropy);
    ImGui::PopID();
    changed |= dragColor(session, "Emission", "Nits per metre", medium.emission, "%.4g");
    ImGui::EndTable();
    if (changed) session.edit(changeMedium(session.scene(), index, medium));
}

} // namespace

void drawInspector(Session& session) {
    if (session.selected() == kNone)
        return coloredText(kGrey, "Click a node to see what it holds.");
    const Node& node = session.scene().nodes[size_t(session.selected())];
    text(node.name.empty() ? "(no name)" : node.name);
    ImGui::SameLine();
    if (ImGui::SmallButton("Frame")) session.frameSelection();
    tooltip("Bring it into the picture (F)");
    if (node.camera != kNone) {
        ImGui::SameLine();
        if (ImGui::SmallButton("Look through")) session.lookThrough(session.selected());
    }
    ImGui::PushID(session.selected());
    drawTransform(session, session.selected());
    if (node.light != kNone) drawLight(session, node.light);
    if (node.medium != kNone) drawMedium(session, node.medium);
    if (!node.meshes.empty()) {
        size_t triangles = 0;
        for (const int mesh : node.meshes)
            triangles += session.scene().meshes[size_t(mesh)].indices.size() / 3;
        coloredText(kGrey, fmt::format("{} mesh{}, {} triangles", node.meshes.size(),
                                       node.meshes.size() == 1 ? "" : "es", triangles));
    }
    ImGui::PopID();
}

} // namespace tyndall::editor
